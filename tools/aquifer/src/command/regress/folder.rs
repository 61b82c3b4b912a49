//! The folder of pictures that are wanted, and the one that differences go to.

use crate::failure::Failure;
use aquifer_lab::{
    atomic,
    film::Film,
    regress::{Kept, Picture, Shown, Store, difference},
};
use std::path::{Path, PathBuf};

/// Pictures by name, and numbers of them.
pub struct Folder {
    path: PathBuf,
    pub store: Store,
}

impl Folder {
    pub fn open(path: &Path) -> Result<Folder, Failure> {
        let store = Store::read(path).map_err(|error| Failure::Failed(error.into()))?;
        Ok(Folder { path: path.to_owned(), store })
    }

    /// Names of all pictures.
    pub fn names(&self) -> Result<Vec<String>, Failure> {
        let names: Vec<String> = self.store.pictures.keys().cloned().collect();
        if names.is_empty() {
            return Err(Failure::new(format!("`{}` holds no pictures: name graphs and --bless", self.path.display())));
        }
        Ok(names)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(format!("{name}.exr"))
    }

    /// A picture with its numbers; `None` where it may be missing and is.
    pub fn picture(&self, name: &str, may_be_missing: bool) -> Result<Option<(Film, Kept)>, Failure> {
        match self.store.pictures.get(name) {
            Some(kept) => Ok(Some((Film::read(&self.file(name))?, *kept))),
            None if may_be_missing => Ok(None),
            None => Err(Failure::new(format!("`{}` holds no picture `{name}`; --bless keeps one", self.path.display()))),
        }
    }

    pub fn keep(&mut self, adapter: &str, name: &str, got: &Picture) -> Result<(), Failure> {
        make(&self.path)?;
        got.film.write(&self.file(name))?;
        self.store.keep(adapter, name, got.scalars, got.bits.clone());
        Ok(())
    }

    pub fn write(&self) -> Result<(), Failure> {
        self.store.write(&self.path).map_err(|error| Failure::Failed(error.into()))
    }
}

/// Got, want and difference of each.
pub fn write_images(shown: &[Shown<'_>], folder: &Path) -> Result<(), Failure> {
    make(folder)?;
    for Shown { name, got, want, .. } in shown {
        let path = |what: &str| folder.join(format!("{name}.{what}.exr"));
        atomic::check_writable(&path("got"))?;
        got.film.write(&path("got"))?;
        want.write(&path("want"))?;
        difference(&got.film, want).write(&path("difference"))?;
    }
    Ok(())
}

fn make(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::new(format!("cannot make `{}`: {error}", folder.display())))
}

pub fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
