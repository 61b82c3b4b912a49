//! What is kept beside the pictures: numbers of the whole image, and the hash of its bits on each adapter.

use crate::{
    atomic::{self, WriteError},
    stats::Moments,
};
use serde::{Deserialize, Serialize};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// A mean over seeds with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scalar {
    /// The mean.
    pub mean: f64,
    /// Of the mean.
    pub standard_error: f64,
}

impl From<&Moments> for Scalar {
    fn from(moments: &Moments) -> Self {
        Scalar { mean: moments.mean(), standard_error: moments.standard_error() }
    }
}

/// Numbers of one picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// Mean luminance.
    pub level: Scalar,
    /// Mean distance of one render from the mean of all, as a share of that.
    pub noise: Scalar,
}

/// Why the numbers cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is damaged.
    #[error("`{}` holds no numbers of pictures: {source}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// Where.
        source: serde_json::Error,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// The file `pictures.json` of a folder of pictures.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Store {
    /// By name of the picture.
    pub pictures: BTreeMap<String, Kept>,
    /// Hashes by name of the adapter, then by name of the picture.
    pub bits: BTreeMap<String, BTreeMap<String, String>>,
}

impl Store {
    const NAME: &str = "pictures.json";

    /// That of a folder; empty where there is none.
    pub fn read(folder: &Path) -> Result<Store, StoreError> {
        let path = folder.join(Self::NAME);
        match std::fs::read(&path) {
            Ok(bytes) => serde_json::from_slice(&bytes).map_err(|source| StoreError::Json { path, source }),
            Err(source) if source.kind() == std::io::ErrorKind::NotFound => Ok(Store::default()),
            Err(source) => Err(StoreError::Read { path, source }),
        }
    }

    /// Writes it.
    pub fn write(&self, folder: &Path) -> Result<(), StoreError> {
        let text = serde_json::to_string_pretty(self).expect("every key is text");
        Ok(atomic::write(&folder.join(Self::NAME), format!("{text}\n").as_bytes())?)
    }

    /// The hash that was kept of a picture on an adapter.
    pub fn bits(&self, adapter: &str, picture: &str) -> Option<&str> {
        self.bits.get(adapter)?.get(picture).map(String::as_str)
    }

    /// Keeps a picture's numbers and its bits on one adapter. Those of other adapters are of another picture now.
    pub fn keep(&mut self, adapter: &str, picture: &str, numbers: Kept, bits: String) {
        if self.bits(adapter, picture) != Some(&bits) {
            self.bits.values_mut().for_each(|pictures| {
                pictures.remove(picture);
            });
        }
        self.bits.entry(adapter.to_owned()).or_default().insert(picture.to_owned(), bits);
        self.pictures.insert(picture.to_owned(), numbers);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_is_read_and_what_is_old_goes() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Store::read(folder.path()).unwrap(), Store::default());
        let scalar = Scalar { mean: 0.25, standard_error: 0.0078125 };
        let numbers = Kept { level: scalar, noise: scalar };
        let mut store = Store::default();
        store.keep("one", "a", numbers, "11".into());
        store.keep("two", "a", numbers, "22".into());
        assert_eq!((store.bits("one", "a"), store.bits("two", "a")), (None, Some("22")));
        store.keep("two", "a", numbers, "22".into());
        store.write(folder.path()).unwrap();
        assert_eq!(Store::read(folder.path()).unwrap(), store);
        std::fs::write(folder.path().join("pictures.json"), "{").unwrap();
        assert!(matches!(Store::read(folder.path()), Err(StoreError::Json { .. })));
    }
}
