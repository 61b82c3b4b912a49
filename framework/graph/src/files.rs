//! Where graph files come from: the seam between this crate and the disk.

use crate::{Source, nearest};
use std::{
    collections::BTreeMap,
    fs::File,
    io::Read,
    path::{Component, Path, PathBuf},
};

/// Gives the text of a graph file by its path.
pub trait Files {
    /// Reads `path`, which is relative to the file named `from` where one is given.
    ///
    /// The [`Source::name`] of the answer names the file from anywhere, and two paths to one file give one name: loops are found by it.
    fn read(&self, path: &str, from: Option<&str>) -> Result<Source, ReadError>;
}

/// Why a file has no text.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
pub enum ReadError {
    /// It is not there.
    #[error("there is no `{path}`")]
    NotFound {
        /// Where it was looked for.
        path: String,
        /// The most likely name, where names are known.
        near: Option<String>,
    },
    /// It is there, and cannot be read.
    #[error("`{path}` cannot be read: {reason}")]
    Unreadable {
        /// Which file.
        path: String,
        /// The system's words.
        reason: String,
    },
    /// More than [`MAX_FILE_BYTES`].
    #[error("`{path}` has more than {MAX_FILE_BYTES} bytes, so it is no graph file")]
    TooBig {
        /// Which file.
        path: String,
    },
    /// Not UTF-8.
    #[error("`{path}` is no UTF-8 text")]
    NotText {
        /// Which file.
        path: String,
    },
}

/// The longest file that is read: endless devices and mistaken names of large files are refused at once.
pub const MAX_FILE_BYTES: u64 = 4 << 20;

/// Files on disk; `extends` is relative to the folder of the file that says it.
#[derive(Clone, Copy, Debug, Default)]
pub struct FsFiles;

impl Files for FsFiles {
    fn read(&self, path: &str, from: Option<&str>) -> Result<Source, ReadError> {
        let folder = from.and_then(|from| Path::new(from).parent()).unwrap_or(Path::new(""));
        let full = tidy(&folder.join(path));
        let name = full.to_string_lossy().into_owned();
        let text = read_text(&full, &name)?;
        Ok(Source { name, text })
    }
}

fn read_text(path: &Path, name: &str) -> Result<String, ReadError> {
    let unreadable = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => ReadError::NotFound { path: name.to_owned(), near: neighbour(path) },
        _ => ReadError::Unreadable { path: name.to_owned(), reason: error.to_string() },
    };
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(ReadError::TooBig { path: name.to_owned() });
    }
    String::from_utf8(bytes).map_err(|_| ReadError::NotText { path: name.to_owned() })
}

/// The file of the same folder whose name is most like that of `path`.
fn neighbour(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).ok()?;
    let names: Vec<String> = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect();
    let wanted = path.file_name()?.to_str()?;
    nearest(wanted, names.iter().map(String::as_str)).map(str::to_owned)
}

/// The path without `.` and without `folder/..`, so that one file has one name.
fn tidy(path: &Path) -> PathBuf {
    let mut tidy = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(tidy.components().next_back(), Some(Component::Normal(_))) => {
                tidy.pop();
            }
            other => tidy.push(other),
        }
    }
    tidy
}

/// Texts in memory under one mark: the built-in graphs, or those of a test. The file `a.toml` on the shelf `built-in` is named
/// `built-in:a.toml`; on a shelf without a mark it is `a.toml`.
#[derive(Clone, Debug, Default)]
pub struct Shelf {
    mark: String,
    texts: BTreeMap<String, String>,
}

impl Shelf {
    /// A shelf with a mark and its files as (path, text).
    pub fn new(mark: impl Into<String>, files: impl IntoIterator<Item = (impl Into<String>, impl Into<String>)>) -> Self {
        let texts = files.into_iter().map(|(path, text)| (path.into(), text.into())).collect();
        Shelf { mark: mark.into(), texts }
    }

    /// Every path, in order.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.texts.keys().map(String::as_str)
    }

    /// The path on this shelf of a source's name, if it stands here.
    fn path_of<'a>(&self, name: &'a str) -> Option<&'a str> {
        if self.mark.is_empty() { Some(name) } else { name.strip_prefix(&self.mark)?.strip_prefix(':') }
    }

    fn name_of(&self, path: &str) -> String {
        if self.mark.is_empty() { path.to_owned() } else { format!("{}:{path}", self.mark) }
    }
}

impl Files for Shelf {
    fn read(&self, path: &str, from: Option<&str>) -> Result<Source, ReadError> {
        let folder = from.and_then(|from| self.path_of(from)).and_then(|from| Path::new(from).parent()).unwrap_or(Path::new(""));
        let full = tidy(&folder.join(self.path_of(path).unwrap_or(path)));
        let full = full.to_string_lossy();
        let missing = || ReadError::NotFound { path: full.clone().into_owned(), near: nearest(&full, self.paths()).map(str::to_owned) };
        let text = self.texts.get(full.as_ref()).ok_or_else(missing)?;
        Ok(Source::new(self.name_of(&full), text.clone()))
    }
}

/// Files of the upper place where they exist there, else those of the shelf below. A file on the shelf sees only the shelf.
#[derive(Clone, Debug, Default)]
pub struct Layered<F> {
    /// Asked first.
    pub upper: F,
    /// Asked next.
    pub lower: Shelf,
}

impl<F: Files> Files for Layered<F> {
    fn read(&self, path: &str, from: Option<&str>) -> Result<Source, ReadError> {
        if self.lower.path_of(path).is_some() || from.is_some_and(|from| self.lower.path_of(from).is_some()) {
            return self.lower.read(path, from);
        }
        match self.upper.read(path, from) {
            Err(ReadError::NotFound { path: tried, near }) => self.lower.read(path, None).map_err(|error| match error {
                ReadError::NotFound { near: shelved, .. } => ReadError::NotFound { path: tried, near: near.or(shelved) },
                other => other,
            }),
            answer => answer,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shelf() -> Shelf {
        Shelf::new("built-in", [("a.toml", "a"), ("gi/b.toml", "b")])
    }

    #[test]
    fn a_shelf_resolves_within_itself() {
        let from_b = shelf().read("../a.toml", Some("built-in:gi/b.toml")).unwrap();
        assert_eq!(from_b, Source::new("built-in:a.toml", "a"));
        let missing = shelf().read("aa.toml", None).unwrap_err();
        assert_eq!(missing, ReadError::NotFound { path: "aa.toml".into(), near: Some("a.toml".into()) });
    }

    #[test]
    fn disk_comes_before_the_shelf_and_one_file_has_one_name() {
        let folder = tempfile::tempdir().unwrap();
        let main = folder.path().join("main.toml").to_string_lossy().into_owned();
        std::fs::write(folder.path().join("a.toml"), "mine").unwrap();
        let files = Layered { upper: FsFiles, lower: shelf() };
        let mine = files.read("a.toml", Some(&main)).unwrap();
        assert_eq!(mine.text, "mine");
        assert_eq!(files.read("./x/../a.toml", Some(&main)).unwrap().name, mine.name);
        assert_eq!(files.read("gi/b.toml", Some(&main)).unwrap().name, "built-in:gi/b.toml");
        assert_eq!(files.read("a.toml", Some("built-in:gi/b.toml")).unwrap_err().to_string(), "there is no `gi/a.toml`");
        assert_eq!(files.read("../a.toml", Some("built-in:gi/b.toml")).unwrap().text, "a");
    }

    #[test]
    fn strange_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        std::fs::write(path("bytes.toml"), [0xff, 0xfe]).unwrap();
        assert!(matches!(FsFiles.read(&path("bytes.toml"), None), Err(ReadError::NotText { .. })));
        assert!(matches!(FsFiles.read(&path(""), None), Err(ReadError::Unreadable { .. })));
        std::fs::write(path("long.toml"), vec![b' '; MAX_FILE_BYTES as usize + 1]).unwrap();
        assert!(matches!(FsFiles.read(&path("long.toml"), None), Err(ReadError::TooBig { .. })));
        let missing = FsFiles.read(&path("byte.toml"), None).unwrap_err();
        assert!(matches!(missing, ReadError::NotFound { near: Some(near), .. } if near == "bytes.toml"));
    }
}
