//! What to run, in order, on which memory.

use crate::{Contract, Extent, Slots, Transport, Value, WireType};
use serde::Serialize;
use std::collections::BTreeMap;

/// A checked graph, ordered, culled, with the life of every resource known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Title of the graph file.
    pub title: String,
    /// Which light paths the output holds.
    pub transport: Transport,
    /// In order of execution.
    pub steps: Vec<Step>,
    /// Everything that steps read and write.
    pub resources: Vec<Resource>,
    /// The resource shown and saved.
    pub output: usize,
    /// What was asked to be kept for reading back, in the order asked.
    pub kept: Vec<Kept>,
    /// Passes that do not run, and ports that passes do without, with the reasons.
    pub left_out: Vec<LeftOut>,
}

/// One pass of the plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// The node's name: that of the pass in the graph file, or `spatial.1`, `spatial.2` … for the rounds of `repeat = 2`.
    pub node: String,
    /// The pass's name in the graph file; the rounds of a `repeat` share it.
    pub pass: String,
    /// Which kind of pass.
    pub kind: String,
    /// The graph's slots with the pass's own laid over them.
    pub slots: Slots,
    /// Every parameter, defaults filled in.
    pub params: BTreeMap<String, Value>,
    /// One for every port of the contract, in its order.
    pub bindings: Vec<Binding>,
    /// The contract that was checked.
    pub contract: Contract,
}

/// What one port of a step is joined to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Binding {
    /// The port.
    pub port: String,
    /// The resource; `None` reads zeros, and only ports that are never written have it.
    pub resource: Option<ResourceHalf>,
}

/// A resource, or last frame's half of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct ResourceHalf {
    /// Index into [`Plan::resources`].
    pub resource: usize,
    /// Which half.
    pub when: When,
}

/// This frame's or last frame's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum When {
    /// This frame's.
    This,
    /// `@prev`: last frame's.
    Previous,
}

/// Memory that steps share.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Resource {
    /// `node.port` of the first writer.
    pub name: String,
    /// What it holds.
    pub ty: WireType,
    /// How long it must be kept.
    pub life: Life,
    /// Must be cleared to zeros before its first step, every frame: an in-out port with nothing wired starts from the empty value.
    pub clear: bool,
}

/// How long a resource must be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Life {
    /// From step `first` to step `last` of one frame; may share memory with others.
    Transient {
        /// Index of the first step that touches it.
        first: usize,
        /// Index of the last.
        last: usize,
    },
    /// A pair whose halves swap every frame, because something reads `@prev`. This frame's half can be read when the frame is done.
    History,
    /// Read back when the frame is done.
    Output,
}

/// A resource kept for reading back.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Kept {
    /// As asked: `node.port`.
    pub name: String,
    /// Where it is; `None` when its pass was left out and zeros stand in.
    pub resource: Option<ResourceHalf>,
}

/// A pass that does not run, or a port that a pass does without.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// The node.
    pub node: String,
    /// The port; `None` for the whole pass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub port: Option<String>,
    /// In words.
    pub reason: String,
}

impl Plan {
    /// The steps of one pass of the graph file: one, or the rounds of its `repeat`.
    pub fn steps_of<'a>(&'a self, pass: &'a str) -> impl Iterator<Item = &'a Step> {
        self.steps.iter().filter(move |step| step.pass == pass)
    }

    /// Plain data, for other programs.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::to_value(self).expect("every key of a plan is text")
    }
}

impl Step {
    /// The resource of a port, by name.
    pub fn resource(&self, port: &str) -> Option<ResourceHalf> {
        self.bindings.iter().find(|binding| binding.port == port)?.resource
    }
}

impl Resource {
    /// Bytes of one half for an image of `size` pixels.
    pub fn bytes(&self, size: [u32; 2]) -> u64 {
        self.ty.extent.elements(size) * u64::from(self.ty.stride)
    }

    /// How many elements.
    pub fn extent(&self) -> &Extent {
        &self.ty.extent
    }
}
