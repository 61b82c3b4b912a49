//! What each biased switch of a graph does by itself.

use serde::{Deserialize, Serialize};

/// A graph with its biased switches turned one by one, each graph as it is written: one frame after the warm-up, whatever budgets there are.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Explained {
    /// Index into [`super::Report::graphs`].
    pub graph: usize,
    /// Independent seeds of every variant.
    pub seeds: u64,
    /// As written.
    pub all_on: Share,
    /// With every switch turned off that can be; `None` where none can.
    pub all_off: Option<Share>,
    /// One by one.
    pub switches: Vec<SwitchShare>,
}

/// The bias of one variant.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Mean luminance over the reference's, less one.
    pub mean_difference: f64,
    /// Its standard error.
    pub mean_error: f64,
    /// Squared bias; may come out below zero by chance.
    pub bias_squared: f64,
    /// 95 % interval of `bias_squared`.
    pub bias_squared_interval: Option<[f64; 2]>,
}

/// What one switch does.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SwitchShare {
    /// What stands in the graph and why that biases, as `aquifer check` prints it.
    pub what: String,
    /// The setting that turns it off; `None`: nothing does, and it is on in every variant.
    pub setting: Option<String>,
    /// This switch on, all others off.
    pub alone: Option<Share>,
    /// This switch off, all others on.
    pub without: Option<Share>,
}
