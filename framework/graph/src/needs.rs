//! What a scene makes superfluous: the word of those who know it, and what then stands in.

use crate::Node;
use std::collections::BTreeMap;

/// Says which passes must run; implemented by the room that knows passes and scenes.
pub trait Needs {
    /// The verdict on one node.
    fn verdict(&self, node: &Node) -> Verdict;
}

/// Whether a pass runs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Verdict {
    /// It runs.
    #[default]
    Run,
    /// It does not.
    LeaveOut {
        /// In words, e.g. "the scene has no environment".
        reason: String,
        /// What readers of each out port see instead; ports that are not named give zeros. In-out ports hand on what they are wired to.
        stand_in: BTreeMap<String, StandIn>,
    },
}

/// What stands in for an out port of a pass that does not run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StandIn {
    /// All-zero bytes: the empty value of every type.
    Zeros,
    /// What this input port of the same pass is wired to.
    Input(String),
}

/// Every pass runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct NeedsAll;

impl Needs for NeedsAll {
    fn verdict(&self, _: &Node) -> Verdict {
        Verdict::Run
    }
}
