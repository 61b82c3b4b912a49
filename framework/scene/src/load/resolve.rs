//! Bytes by URI: data URIs, and files that lie in the scene's folder. Nothing else is ever opened.

use super::{
    LoadError, MAX_FILE_BYTES,
    limits::{spend, within},
};
use gltf::Document;
use std::{
    borrow::Cow,
    cell::Cell,
    fs,
    path::{Component, Path, PathBuf},
};

/// A file of acceptable size. Only plain files: pipes and devices may never end.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, LoadError> {
    let failed = |source| LoadError::Read { path: path.to_owned(), source };
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(failed(std::io::Error::other("not a plain file")));
    }
    within(metadata.len(), MAX_FILE_BYTES, &path.display().to_string())?;
    fs::read(path).map_err(failed)
}

pub(super) fn canonical(folder: &Path) -> Result<PathBuf, LoadError> {
    folder.canonicalize().map_err(|source| LoadError::Read { path: folder.to_owned(), source })
}

/// The bytes of every buffer, cut to its `byteLength`.
pub(super) fn buffers<'a>(document: &Document, bin: Option<&'a [u8]>, folder: Option<&Path>) -> Result<Vec<Cow<'a, [u8]>>, LoadError> {
    let total = Cell::new(0);
    let mut buffers = Vec::new();
    for (index, buffer) in document.as_json().buffers.iter().enumerate() {
        let pointer = format!("/buffers/{index}");
        let bytes = match (&buffer.uri, bin) {
            (Some(uri), _) => Cow::Owned(resolve(uri, folder, &format!("{pointer}/uri"))?),
            (None, Some(bin)) if index == 0 => Cow::Borrowed(bin),
            (None, _) => return Err(LoadError::invalid(pointer, "has neither a URI nor a binary chunk")),
        };
        spend(&total, bytes.len() as u64, MAX_FILE_BYTES, "bytes of all buffers")?;
        let (needed, available) = (buffer.byte_length.0, bytes.len() as u64);
        if needed > available {
            return Err(LoadError::Overrun { pointer: format!("{pointer}/byteLength"), needed, available });
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// The bytes behind a URI.
pub(super) fn resolve(uri: &str, folder: Option<&Path>, pointer: &str) -> Result<Vec<u8>, LoadError> {
    let refused = |why| LoadError::Location { pointer: pointer.to_owned(), uri: uri.chars().take(80).collect(), why };
    if let Some(data) = uri.strip_prefix("data:") {
        return decode(data).map_err(refused);
    }
    let folder = folder.ok_or_else(|| refused("the scene has no folder to read files from"))?;
    let relative = relative(uri).map_err(refused)?;
    let path = folder.join(&relative).canonicalize().map_err(|source| LoadError::Read { path: relative, source })?;
    if !path.starts_with(folder) {
        return Err(refused("leads out of the scene's folder"));
    }
    read_file(&path)
}

/// The part of a data URI after `data:`.
fn decode(data: &str) -> Result<Vec<u8>, &'static str> {
    let (kind, payload) = data.split_once(',').ok_or("a data URI needs a comma")?;
    if !kind.ends_with(";base64") {
        return Err("only base64 data URIs are read");
    }
    base64::decode(payload).map_err(|_| "not base64")
}

/// A path with nothing in it that could lead out of a folder, links aside.
fn relative(uri: &str) -> Result<PathBuf, &'static str> {
    if has_scheme(uri) {
        return Err("only data URIs and files in the scene's folder are read");
    }
    let decoded = urlencoding::decode(uri).map_err(|_| "not UTF-8")?;
    if decoded.is_empty() || decoded.contains(['\0', '\\']) {
        return Err("not a relative path");
    }
    let path = PathBuf::from(decoded.as_ref());
    let stays = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    if path.components().all(stays) { Ok(path) } else { Err("leads out of the scene's folder") }
}

/// RFC 3986, 3.1. Also catches drive letters.
fn has_scheme(uri: &str) -> bool {
    let scheme = uri.split_once(':').map(|(scheme, _)| scheme);
    scheme.is_some_and(|scheme| {
        scheme.starts_with(|c: char| c.is_ascii_alphabetic()) && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_uris_decode() {
        assert_eq!(resolve("data:application/octet-stream;base64,AQID", None, "").unwrap(), [1, 2, 3]);
        for wrong in ["data:", "data:,abc", "data:;base64", "data:;base64,%%%"] {
            assert!(matches!(resolve(wrong, None, ""), Err(LoadError::Location { .. })), "{wrong}");
        }
    }

    #[test]
    fn files_stay_in_their_folder() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("scene");
        fs::create_dir_all(folder.join("maps")).unwrap();
        fs::write(outer.path().join("secret"), b"secret").unwrap();
        fs::write(folder.join("maps/a b.bin"), b"open").unwrap();
        let folder = canonical(&folder).unwrap();
        assert_eq!(resolve("maps/a%20b.bin", Some(&folder), "").unwrap(), b"open");
        assert_eq!(resolve("./maps/a b.bin", Some(&folder), "").unwrap(), b"open");
        let absolute = outer.path().join("secret").display().to_string();
        let outside = [
            "../secret",
            "maps/../../secret",
            "%2e%2e/secret",
            "..%2fsecret",
            "..\\secret",
            &absolute,
            &format!("file://{absolute}"),
            "http://example.org/a.bin",
            "C:/secret",
            "maps/a%00b",
            "",
        ];
        for uri in outside {
            assert!(matches!(resolve(uri, Some(&folder), "/p"), Err(LoadError::Location { .. })), "{uri}");
        }
        assert!(matches!(resolve("maps/a%20b.bin", None, ""), Err(LoadError::Location { .. })));
        assert!(matches!(resolve("missing.bin", Some(&folder), ""), Err(LoadError::Read { .. })));
        assert!(matches!(resolve("maps", Some(&folder), ""), Err(LoadError::Read { .. })), "a folder is no file");
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_lead_out() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("scene");
        fs::create_dir(&folder).unwrap();
        fs::write(outer.path().join("secret"), b"secret").unwrap();
        std::os::unix::fs::symlink(outer.path().join("secret"), folder.join("link")).unwrap();
        let folder = canonical(&folder).unwrap();
        assert!(matches!(resolve("link", Some(&folder), ""), Err(LoadError::Location { .. })));
    }
}
