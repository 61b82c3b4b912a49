//! What a file holds, with the buffers and images of a scene that lie in files of their own.
//!
//! They are found as the scene's reader finds them: in the scene's folder and nowhere else. One that is missing counts too: once it is there, the
//! scene is another.

use serde::Deserialize;
use std::{
    fs::{self, File},
    io,
    path::{Component, Path, PathBuf},
};

/// Stands for a file that cannot be read.
const MISSING: [u8; 32] = [0; 32];

/// The part of a glTF document that names files.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Document {
    buffers: Vec<Part>,
    images: Vec<Part>,
}

#[derive(Deserialize)]
struct Part {
    uri: Option<String>,
}

/// Of a file's bytes and of all files that it names; where it names none, of its bytes alone.
pub fn hash(path: &Path) -> io::Result<blake3::Hash> {
    let bytes = fs::read(path)?;
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut hash = blake3::Hasher::new();
    hash.update(&bytes);
    for uri in named(&bytes) {
        let of_file = find(folder, &uri).and_then(|path| file_hash(&path).ok());
        hash.update(&of_file.map_or(MISSING, Into::into));
    }
    Ok(hash.finalize())
}

/// Every file that a `.gltf` or `.glb` names; data URIs name none.
fn named(bytes: &[u8]) -> Vec<String> {
    let Document { buffers, images } = serde_json::from_slice(json(bytes)).unwrap_or_default();
    let uris = buffers.into_iter().chain(images).filter_map(|part| part.uri);
    uris.filter(|uri| !uri.starts_with("data:")).collect()
}

/// The first chunk of a `.glb` (glTF 2.0, chapter 4), or all of any other file.
fn json(bytes: &[u8]) -> &[u8] {
    if !bytes.starts_with(b"glTF") {
        return bytes;
    }
    let length = bytes.get(12..16).and_then(|word| word.try_into().ok()).map_or(0, u32::from_le_bytes);
    bytes.get(20..).and_then(|chunk| chunk.get(..length as usize)).unwrap_or_default()
}

/// A plain file in the folder or below it.
fn find(folder: &Path, uri: &str) -> Option<PathBuf> {
    let relative = PathBuf::from(urlencoding::decode(uri).ok()?.into_owned());
    let stays = relative.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    let (folder, path) = (folder.canonicalize().ok()?, folder.join(&relative).canonicalize().ok()?);
    (stays && path.starts_with(&folder) && path.is_file()).then_some(path)
}

fn file_hash(path: &Path) -> io::Result<blake3::Hash> {
    let mut hash = blake3::Hasher::new();
    hash.update_reader(File::open(path)?)?;
    Ok(hash.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scene that names a buffer, an image and nothing that lies outside.
    const SCENE: &str = r#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 3, "uri": "data:;base64,AQID"}, {"byteLength": 1, "uri": "a.bin"}],
"images": [{"uri": "maps/100%25%20wood.png"}, {"bufferView": 0}, {"uri": "../outside.png"}, {"uri": "/dev/zero"}, {"uri": "%"}]}"#;

    #[test]
    fn every_file_that_a_scene_names_counts() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("scene");
        let write = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).unwrap();
        fs::create_dir_all(folder.join("maps")).unwrap();
        let length = (SCENE.len() as u32).to_le_bytes();
        let glb = [b"glTF\x02\0\0\0\0\0\0\0", &length[..], b"JSON", SCENE.as_bytes()].concat();
        for (name, bytes) in [("a.gltf", SCENE.as_bytes()), ("a.glb", &glb)] {
            let hash = || hash(&folder.join(name)).unwrap();
            write(name, bytes);
            let mut seen = vec![hash()];
            for (file, bytes) in [("a.bin", b"1"), ("a.bin", b"2"), ("maps/100% wood.png", b"1"), ("maps/100% wood.png", b"2")] {
                write(file, bytes);
                let now = hash();
                assert!(!seen.contains(&now), "{file} of {name}");
                assert_eq!(now, hash());
                seen.push(now);
            }
            fs::write(outer.path().join("outside.png"), name).unwrap();
            assert_eq!(seen.last(), Some(&hash()), "{name}");
            fs::remove_file(folder.join("a.bin")).and_then(|()| fs::remove_file(folder.join("maps/100% wood.png"))).unwrap();
            assert_eq!(seen.first(), Some(&hash()), "{name}");
        }
    }

    #[test]
    fn a_file_that_names_none_is_its_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gltf");
        for bytes in [
            &b"{}"[..],
            b"glTF",
            b"glTF\x02\0\0\0\0\0\0\0\xff\xff\xff\xffJSON{}",
            b"\xff",
            br#"{"images": 3}"#,
            br#"{"images": [{"uri": "data:,"}]}"#,
        ] {
            fs::write(&path, bytes).unwrap();
            assert_eq!(hash(&path).unwrap(), blake3::hash(bytes));
        }
        assert!(hash(&folder.path().join("missing.gltf")).is_err());
    }
}
