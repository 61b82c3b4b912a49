//! Tells when the files of an experiment change.
//!
//! Editors write a new file and rename it over the old one, in several steps: folders are watched rather than files, and changes count once they
//! have been quiet for `QUIET`.

use notify::{RecommendedWatcher, RecursiveMode};
use notify_debouncer_full::{DebounceEventResult, Debouncer, RecommendedCache, new_debouncer};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::mpsc::{Receiver, RecvTimeoutError, channel},
    time::{Duration, Instant},
};

/// How long files must rest before a change counts.
const QUIET: Duration = Duration::from_millis(150);

/// Why files cannot be watched.
#[derive(Debug, thiserror::Error)]
pub enum WatchError {
    /// The system offers no way to watch anything.
    #[error("files cannot be watched here: {0}")]
    Unavailable(#[source] notify::Error),
    /// One folder cannot be watched.
    #[error("`{}` cannot be watched: {source}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the system says.
        source: notify::Error,
    },
}

/// Files, and folders with all that is below them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Watched {
    /// Files; they need not exist yet.
    pub files: Vec<PathBuf>,
    /// Folders.
    pub folders: Vec<PathBuf>,
}

/// Watches files.
pub struct Watch {
    debouncer: Debouncer<RecommendedWatcher, RecommendedCache>,
    events: Receiver<DebounceEventResult>,
    files: BTreeSet<PathBuf>,
    folders: BTreeSet<PathBuf>,
    /// What the system watches for us.
    roots: BTreeMap<PathBuf, RecursiveMode>,
}

impl Watch {
    /// Watches nothing yet.
    ///
    /// # Errors
    /// [`WatchError::Unavailable`].
    pub fn new() -> Result<Self, WatchError> {
        let (sender, events) = channel();
        let debouncer = new_debouncer(QUIET, None, sender).map_err(WatchError::Unavailable)?;
        Ok(Self { debouncer, events, files: BTreeSet::new(), folders: BTreeSet::new(), roots: BTreeMap::new() })
    }

    /// Watches these from now on, in place of what it watched before.
    ///
    /// # Errors
    /// [`WatchError::Folder`] names the folder that cannot be watched.
    pub fn follow(&mut self, watched: &Watched) -> Result<(), WatchError> {
        self.files = watched.files.iter().map(|file| absolute(file)).collect();
        self.folders = watched.folders.iter().map(|folder| absolute(folder)).collect();
        let mut roots: BTreeMap<PathBuf, RecursiveMode> = BTreeMap::new();
        for file in &self.files {
            roots.insert(file.parent().unwrap_or(Path::new("/")).to_owned(), RecursiveMode::NonRecursive);
        }
        roots.extend(self.folders.iter().map(|folder| (folder.clone(), RecursiveMode::Recursive)));
        for old in self.roots.keys().filter(|old| roots.get(*old) != self.roots.get(*old)) {
            // A folder that is gone needs no unwatching.
            let _ = self.debouncer.unwatch(old);
        }
        for (root, mode) in roots.iter().filter(|(root, mode)| self.roots.get(*root) != Some(mode)) {
            self.debouncer.watch(root, *mode).map_err(|source| WatchError::Folder { folder: root.clone(), source })?;
        }
        self.roots = roots;
        Ok(())
    }

    /// Has anything changed since this was last asked?
    pub fn changed(&self) -> bool {
        // All that is there is taken, so that one edit counts once.
        self.events.try_iter().filter(|event| self.concerns(event)).count() > 0
    }

    /// Waits for a change, at most so long.
    pub fn wait(&self, most: Duration) -> bool {
        let end = Instant::now() + most;
        loop {
            match self.events.recv_timeout(end.saturating_duration_since(Instant::now())) {
                Ok(event) if self.concerns(&event) => return true,
                Ok(_) => {}
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return false,
            }
        }
    }

    fn concerns(&self, event: &DebounceEventResult) -> bool {
        let ours = |path: &PathBuf| self.files.contains(path) || self.folders.iter().any(|folder| path.starts_with(folder));
        match event {
            Ok(events) => events.iter().filter(|event| !event.kind.is_access()).flat_map(|event| &event.paths).any(ours),
            // Something may have been missed.
            Err(_) => true,
        }
    }
}

/// As the system names it in events; the file itself may be a link, or not be there.
fn absolute(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { return path };
    folder.canonicalize().map_or_else(|_| path.clone(), |folder| folder.join(name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Longer than any debouncing on a busy machine; only waited for in full when the test fails.
    const LONG: Duration = Duration::from_secs(20);
    /// Longer than [`QUIET`]: time for an event that must not come.
    const SHORT: Duration = Duration::from_millis(600);

    #[test]
    fn changes_of_what_is_followed_are_told_and_others_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("shaders")).unwrap();
        fs::write(at("graph.toml"), "one").unwrap();
        let mut watch = Watch::new().unwrap();
        watch.follow(&Watched { files: vec![at("graph.toml")], folders: vec![at("shaders")] }).unwrap();
        assert!(!watch.wait(SHORT) && !watch.changed());
        fs::write(at("graph.toml"), "two").unwrap();
        assert!(watch.wait(LONG), "a write");
        fs::write(at("new.tmp"), "three").unwrap();
        assert!(!watch.wait(SHORT), "a neighbour is none of ours");
        fs::rename(at("new.tmp"), at("graph.toml")).unwrap();
        assert!(watch.wait(LONG), "a rename over it");
        fs::create_dir(at("shaders/pass")).unwrap();
        assert!(watch.wait(LONG), "a folder");
        fs::write(at("shaders/pass/mine.wgsl"), "//!").unwrap();
        assert!(watch.wait(LONG), "a file in a folder that is new");
        watch.follow(&Watched { files: vec![at("other.toml")], folders: vec![] }).unwrap();
        while watch.wait(SHORT) {}
        fs::write(at("graph.toml"), "four").unwrap();
        fs::write(at("shaders/pass/mine.wgsl"), "//!!").unwrap();
        assert!(!watch.wait(SHORT), "it follows these no longer");
        fs::write(at("other.toml"), "a file that was not there").unwrap();
        assert!(watch.wait(LONG));
    }

    #[test]
    fn a_folder_that_is_not_there_is_named() {
        let mut watch = Watch::new().unwrap();
        let error = watch.follow(&Watched { files: vec![], folders: vec!["/no/such/folder".into()] }).unwrap_err();
        assert!(error.to_string().starts_with("`/no/such/folder` cannot be watched"), "{error}");
    }
}
