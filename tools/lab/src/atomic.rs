//! Files that are either complete or not there: written beside their target, flushed to disk, then renamed.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// Why a file could not be written. The target is untouched in every case.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The folder that should hold the file is missing.
    #[error("cannot write `{}`: there is no folder `{}`", path.display(), folder.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The missing folder.
        folder: PathBuf,
    },
    /// Something that is no regular file (a folder, a device) has this name.
    #[error("cannot write `{}`: it exists and is not a file", path.display())]
    NotAFile {
        /// The file.
        path: PathBuf,
    },
    /// The operating system refused.
    #[error("cannot write `{}`: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

/// Tells, before hours are spent on its contents, whether `path` could be written now. Leaves nothing behind.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    Target::find(path)?.temporary().map(drop)
}

/// Writes `bytes` to `path`, all or nothing.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let target = Target::find(path)?;
    let mut file = target.temporary()?;
    file.write_all(bytes).map_err(|source| target.failed(source))?;
    target.replace(file)
}

/// Where a file goes, symbolic links followed.
struct Target {
    path: PathBuf,
    folder: PathBuf,
}

impl Target {
    fn find(path: &Path) -> Result<Self, WriteError> {
        let fail = |source| WriteError::Io { path: path.to_owned(), source };
        let path = match fs::metadata(path) {
            Ok(existing) if existing.is_file() => fs::canonicalize(path).map_err(fail)?,
            Ok(_) => return Err(WriteError::NotAFile { path: path.to_owned() }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => path.to_owned(),
            Err(error) => return Err(fail(error)),
        };
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        match folder.is_dir() {
            true => Ok(Self { path, folder }),
            false => Err(WriteError::NoFolder { path, folder }),
        }
    }

    fn temporary(&self) -> Result<NamedTempFile, WriteError> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".aquifer-").suffix(".tmp");
        // Temporary files are private by default; the result should have the rights of any other new file.
        #[cfg(unix)]
        let builder = builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        builder.tempfile_in(&self.folder).map_err(|source| self.failed(source))
    }

    fn replace(&self, file: NamedTempFile) -> Result<(), WriteError> {
        file.as_file().sync_all().map_err(|source| self.failed(source))?;
        file.persist(&self.path).map_err(|error| self.failed(error.error))?;
        self.sync_folder();
        Ok(())
    }

    /// Makes the rename itself durable. Some file systems cannot do this to folders, and the file is whole either way.
    fn sync_folder(&self) {
        if let Err(error) = fs::File::open(&self.folder).and_then(|folder| folder.sync_all()) {
            tracing::debug!("folder `{}` not flushed: {error}", self.folder.display());
        }
    }

    fn failed(&self, source: io::Error) -> WriteError {
        // The name of the temporary file that `tempfile` adds to its messages would only confuse.
        let source = io::Error::from(source.kind());
        WriteError::Io { path: self.path.clone(), source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn replaces_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write(&path, b"one").unwrap();
        write(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_refusing_folder_is_named() {
        // A folder of /proc refuses new files just as a read-only disk does.
        let error = write(Path::new("/proc/self/a.txt"), b"x").unwrap_err();
        assert!(error.to_string().starts_with("cannot write `/proc/self/a.txt`: "), "{error}");
    }

    #[test]
    fn impossible_targets_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("no/a.txt");
        assert!(matches!(check_writable(&missing), Err(WriteError::NoFolder { .. })));
        assert!(matches!(check_writable(folder.path()), Err(WriteError::NotAFile { .. })));
        let below_a_file = folder.path().join("f");
        write(&below_a_file, b"").unwrap();
        assert!(check_writable(&below_a_file.join("a.txt")).is_err());
        check_writable(&folder.path().join("fine.txt")).unwrap();
        assert_eq!(names(folder.path()), ["f"]);
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_not_replaced() {
        assert!(matches!(write(Path::new("/dev/null"), b"x"), Err(WriteError::NotAFile { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_rights_are_ordinary() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real"), folder.path().join("link"));
        write(&real, b"one").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write(&link, b"two").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&real).unwrap(), b"two");
        let ordinary = folder.path().join("ordinary");
        fs::write(&ordinary, b"").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&real), mode(&ordinary));
    }
}
