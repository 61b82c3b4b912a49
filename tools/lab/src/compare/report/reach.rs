//! Equal error: how long each graph takes to reach it.

use super::Ratio;
use serde::{Deserialize, Serialize};

/// Time to one error.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EqualError {
    /// The mean square error to be reached.
    pub mse: f64,
    /// One for every graph that has a curve.
    pub reaches: Vec<Reach>,
}

/// When a graph reaches the error.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reach {
    /// Index into [`super::SceneResult::cells`]: whose curve it is.
    pub cell: usize,
    /// Milliseconds; `None` where its largest budget does not get there.
    pub time_ms: Option<f64>,
    /// 95 % interval of `time_ms`; `None` where an end lies beyond what was measured.
    pub interval: Option<[f64; 2]>,
    /// Its first frame is there already: `time_ms`, that of this frame, is more than it needs.
    pub at_once: bool,
    /// The baseline's time over this graph's: above 1 this graph is faster. `None` for the baseline, and where one of them has no time.
    pub speed_up: Option<Ratio>,
    /// The result in words.
    pub sentence: String,
}
