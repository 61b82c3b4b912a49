//! Why a comparison cannot go on.

use crate::{atomic::WriteError, capture::CaptureError, film::FilmError, stats::SizesDiffer};
use aquifer_graph::{Faults, PlanError};
use std::path::PathBuf;

/// Why a comparison cannot go on. What was measured before stays on disk.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// A graph is faulty on this scene, or with this value of its knob.
    #[error("{0}")]
    Graph(Box<Faults>),
    /// A graph cannot run.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The device or a pass failed.
    #[error(transparent)]
    Render(#[from] aquifer_render::Error),
    /// No film could be taken.
    #[error(transparent)]
    Capture(#[from] CaptureError),
    /// A film could not be read or written.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Images of different sizes.
    #[error(transparent)]
    Sizes(#[from] SizesDiffer),
    /// A folder could not be made, or a file not read.
    #[error("`{}`: {source}", path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Two parts of a reference do not belong together.
    #[error("the reference in the cache cannot be extended: {0}")]
    Merge(#[from] crate::film::MergeError),
    /// The user asked to stop.
    #[error("interrupted: the same command goes on from here")]
    Interrupted,
}

impl From<Faults> for CompareError {
    fn from(faults: Faults) -> Self {
        Self::Graph(Box::new(faults))
    }
}
