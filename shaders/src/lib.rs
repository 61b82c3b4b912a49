//! The WGSL tree, embedded: [`modules`] gives each file's module path and text.

use include_dir::{Dir, include_dir};

static TREE: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR");

/// Every shader: (module path such as `base/math`, text), in order of path.
pub fn modules() -> Vec<(String, &'static str)> {
    let mut found = Vec::new();
    collect(&TREE, &mut found);
    found.sort();
    found
}

fn collect(folder: &'static Dir<'static>, found: &mut Vec<(String, &'static str)>) {
    for file in folder.files() {
        let path = file.path().with_extension("");
        if let (Some("wgsl"), Some(text)) = (file.path().extension().and_then(|e| e.to_str()), file.contents_utf8()) {
            found.push((path.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/"), text));
        }
    }
    folder.dirs().for_each(|inner| collect(inner, found));
}
