//! The built-in graph files, embedded.

use include_dir::{Dir, include_dir};

static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR");

/// Every graph file: (name with `.toml`, text), in order of name.
pub fn files() -> Vec<(&'static str, &'static str)> {
    let readable = FILES.files().filter_map(|file| Some((file.path().to_str()?, file.contents_utf8()?)));
    let mut found: Vec<_> = readable.filter(|(name, _)| name.ends_with(".toml") && *name != "Cargo.toml").collect();
    found.sort_unstable();
    found
}
