//! Why a file is no scene.

use crate::SceneError;
use std::{io, path::PathBuf};

/// Why a file could not be loaded. `pointer` is a JSON pointer (RFC 6901) into the glTF document.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// More than a stated limit, such as [`crate::MAX_TRIANGLES`].
    #[error("{what}: {size} is more than the limit of {limit}")]
    TooLarge {
        /// What there is too much of.
        what: String,
        /// How much.
        size: u64,
        /// The most there may be.
        limit: u64,
    },
    /// The GLB container is broken.
    #[error("not a whole GLB file: {0}")]
    Container(&'static str),
    /// The JSON is broken, or has no glTF in it.
    #[error("not glTF JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// Not glTF 2.
    #[error("/asset/version: glTF {0} is not supported, only 2.x")]
    Version(String),
    /// The file cannot be shown without an extension that Aquifer does not know.
    #[error("/extensionsRequired: `{0}` is not supported")]
    Extension(String),
    /// An index points past the end of what it indexes.
    #[error("{pointer}: index {index} is out of range, there are {count}")]
    Index {
        /// Where the index stands.
        pointer: String,
        /// Its value.
        index: u64,
        /// How many things there are.
        count: usize,
    },
    /// A byte range ends after what it is cut from.
    #[error("{pointer}: reaches byte {needed} of {available}")]
    Overrun {
        /// The view or accessor.
        pointer: String,
        /// End of the range.
        needed: u64,
        /// Bytes that there are.
        available: u64,
    },
    /// An accessor holds elements of another type than its use needs.
    #[error("{pointer}: holds {found} where {expected} is needed")]
    ElementType {
        /// The accessor.
        pointer: String,
        /// What its use needs.
        expected: String,
        /// What it holds.
        found: String,
    },
    /// A number is NaN or infinite, or too large for 32 bits.
    #[error("{pointer}: not a finite 32-bit number")]
    NotFinite {
        /// Which number, or the accessor that holds it.
        pointer: String,
    },
    /// A node is its own ancestor, or has two parents.
    #[error("{pointer}: a node may be reached in one way only")]
    Hierarchy {
        /// The node reached twice.
        pointer: String,
    },
    /// Another rule of glTF is broken.
    #[error("{pointer}: {why}")]
    Invalid {
        /// Where.
        pointer: String,
        /// Which rule.
        why: String,
    },
    /// A URI leads nowhere that may be read.
    #[error("{pointer}: `{uri}`: {why}")]
    Location {
        /// Where the URI stands.
        pointer: String,
        /// Its beginning.
        uri: String,
        /// Why not.
        why: &'static str,
    },
    /// An image cannot be decoded.
    #[error("{at}: {why}")]
    Image {
        /// JSON pointer, or the path of an environment map.
        at: String,
        /// What the decoder says.
        why: String,
    },
    /// A decoder panicked: a fault of Aquifer, reported instead of ending the program.
    #[error("the file broke a decoder, which is a fault of Aquifer's: {why}")]
    Panicked {
        /// The panic's message.
        why: String,
    },
    /// The arrays that came out are not sound.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

impl LoadError {
    pub(super) fn invalid(pointer: impl Into<String>, why: impl Into<String>) -> Self {
        LoadError::Invalid { pointer: pointer.into(), why: why.into() }
    }
}
