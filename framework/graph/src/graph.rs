//! A graph whose every name, type and value has been checked.

use crate::{Contract, Direction, Place, Port, Slots, Sources, Span, Transport, Value, When};
use std::collections::{BTreeMap, BTreeSet};

/// A checked graph: passes with their contracts, every wire joined to a port that exists and fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Graph {
    pub(crate) sources: Sources,
    pub(crate) title: String,
    pub(crate) about: String,
    pub(crate) transport: Transport,
    pub(crate) nodes: Vec<Node>,
    pub(crate) output: PortId,
    pub(crate) knob: Option<Knob>,
}

/// One pass, or one round of a repeated pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The pass's name, or `spatial.1`, `spatial.2` … for the rounds of a repeated pass.
    pub name: String,
    /// The pass's name in the graph file.
    pub pass: String,
    /// Which kind of pass.
    pub kind: String,
    /// The graph's slots with the pass's own laid over them.
    pub slots: Slots,
    /// Every parameter, defaults filled in.
    pub params: BTreeMap<String, Value>,
    /// What the kind offers.
    pub contract: Contract,
    /// What feeds each port, in the order of the contract's ports; `None` for outputs and unwired inputs.
    pub wires: Vec<Option<Wire>>,
    pub(crate) spans: NodeSpans,
}

/// Where the parts of a node were written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NodeSpans {
    pub name: Span,
    pub params: BTreeMap<String, Span>,
    pub slots: BTreeMap<String, Span>,
    /// Slots that the pass fills itself.
    pub own_slots: BTreeSet<String>,
    pub wires: Vec<Option<Span>>,
}

/// One port of one node, as indices into [`Graph::nodes`] and the ports of its contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PortId {
    /// Index of the node.
    pub node: usize,
    /// Index of the port.
    pub port: usize,
}

/// Where an input's content comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Wire {
    /// The output that it is joined to.
    pub from: PortId,
    /// This frame's content or last frame's.
    pub when: When,
}

/// The parameter that spends spare time.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Knob {
    /// The pass.
    pub pass: String,
    /// Its parameter: a number.
    pub param: String,
}

impl Graph {
    /// One line; the file's name where it says none.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// A few sentences; may be empty.
    pub fn about(&self) -> &str {
        &self.about
    }

    /// Which light paths the output holds.
    pub fn transport(&self) -> Transport {
        self.transport
    }

    /// Passes in the order of the file, rounds unrolled.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The port that is shown and saved.
    pub fn output(&self) -> PortId {
        self.output
    }

    /// The parameter that spends spare time, where the graph names one.
    pub fn knob(&self) -> Option<&Knob> {
        self.knob.as_ref()
    }

    /// The texts that the graph was read from.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Where a node's pass is declared.
    pub fn place(&self, node: &Node) -> Place {
        self.sources.place(node.spans.name)
    }

    /// Whether what a port reads or leaves behind depends on earlier frames: then frames are not independent of each other, and their
    /// spread tells nothing about the error of their mean.
    pub fn has_history(&self, port: PortId) -> bool {
        let mut seen = vec![false; self.nodes.len()];
        let is_input = self.nodes[port.node].port(port.port).direction == Direction::In;
        let mut open: Vec<Wire> = if is_input { self.nodes[port.node].wires[port.port].into_iter().collect() } else { Vec::new() };
        if !is_input {
            open.push(Wire { from: port, when: When::This });
        }
        while let Some(wire) = open.pop() {
            if wire.when == When::Previous {
                return true;
            }
            if !std::mem::replace(&mut seen[wire.from.node], true) {
                open.extend(self.nodes[wire.from.node].wires.iter().flatten());
            }
        }
        false
    }

    /// `node.port`
    pub fn port_name(&self, port: PortId) -> String {
        port_name(&self.nodes, port)
    }
}

impl Node {
    /// A port by index.
    ///
    /// # Panics
    /// When the contract has fewer ports.
    pub fn port(&self, index: usize) -> &Port {
        &self.contract.ports[index]
    }

    /// The index of a port.
    pub fn port_index(&self, name: &str) -> Option<usize> {
        self.contract.ports.iter().position(|port| port.name == name)
    }
}

pub(crate) fn port_name(nodes: &[Node], port: PortId) -> String {
    let node = &nodes[port.node];
    format!("{}.{}", node.name, node.port(port.port).name)
}

/// `node.port`, with `@prev` for last frame's.
pub(crate) fn wire_name(nodes: &[Node], wire: Wire) -> String {
    let mark = if wire.when == When::Previous { "@prev" } else { "" };
    format!("{}{mark}", port_name(nodes, wire.from))
}
