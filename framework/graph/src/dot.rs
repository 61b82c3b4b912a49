//! A graph as Graphviz text.

use crate::{
    Direction, Graph, Node, PortId, When, Wire,
    flow::{home_of_wire, wires},
};
use std::fmt::Write;

impl Graph {
    /// Graphviz text: a box for every pass, an arrow for every wire. Dashed arrows bring last frame's content, bold ones are rewritten in
    /// place, and passes that the output does not need are grey.
    pub fn to_dot(&self) -> String {
        let needed = self.needed();
        let font = "fontname=\"sans-serif\"";
        let mut text = String::from("digraph {\n  rankdir=LR;\n");
        let _ = writeln!(text, "  node [shape=box, style=rounded, {font}];\n  edge [{font}, fontsize=10];");
        let _ = writeln!(text, "  label={}; labelloc=t; {font};", quoted(&format!("{}\n{}", self.title, self.transport)));
        for (index, node) in self.nodes.iter().enumerate() {
            let grey = if needed.contains(&index) { "" } else { ", color=gray, fontcolor=gray" };
            let _ = writeln!(text, "  n{index} [label={}{grey}];", quoted(&node_label(node)));
        }
        for (user, wire) in wires(&self.nodes) {
            let _ = writeln!(text, "  {}", self.arrow(user, wire));
        }
        let _ = writeln!(text, "  output [shape=plaintext];");
        let _ = writeln!(
            text,
            "  n{} -> output [label={}];",
            self.output.node,
            quoted(&self.nodes[self.output.node].port(self.output.port).name)
        );
        text.push_str("}\n");
        text
    }

    fn arrow(&self, user: PortId, wire: Wire) -> String {
        let (from, to) = (self.nodes[wire.from.node].port(wire.from.port), self.nodes[user.node].port(user.port));
        let ends = if from.name == to.name { to.name.clone() } else { format!("{} → {}", from.name, to.name) };
        let mut style = Vec::new();
        if home_of_wire(&self.nodes, wire).is_ok_and(|home| home.half == When::Previous) {
            style.push("dashed");
        }
        if to.direction == Direction::InOut {
            style.push("bold");
        }
        // History runs against the grain of the frame: it must not turn the drawing round.
        let free = if wire.when == When::Previous { ", constraint=false" } else { "" };
        let label = quoted(&format!("{ends}\n{}", to.ty.element));
        format!("n{} -> n{} [label={label}, style={}{free}];", wire.from.node, user.node, quoted(&style.join(",")))
    }
}

fn node_label(node: &Node) -> String {
    let slots: Vec<String> = node.contract.slots.iter().filter_map(|slot| Some(format!("{slot} = {}", node.slots.get(slot)?))).collect();
    let kind = if node.kind == node.pass { Vec::new() } else { vec![format!("kind {}", node.kind)] };
    [vec![node.name.clone()], kind, slots].concat().join("\n")
}

/// A Graphviz string.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n"))
}
