//! Wires: both ends exist, hold the same thing, and nothing that must be wired is left open.

use super::{Checker, Pass};
use crate::{
    Cause, Direction, Extent, Fault, Node, Port, PortId, Span, Spanned, When, Wire, WireType,
    graph::port_name,
    nearest::{cure, list},
};

/// The ports that wires can begin at.
pub(super) fn outputs(node: &Node) -> impl Iterator<Item = &Port> {
    node.contract.ports.iter().filter(|port| port.direction != Direction::In)
}

/// The ports that wires can end at.
fn inputs(node: &Node) -> impl Iterator<Item = &Port> {
    node.contract.ports.iter().filter(|port| port.direction != Direction::Out)
}

/// The outputs of a pass, as a cure.
pub(super) fn outputs_help(node: &Node) -> String {
    cure("", &format!("outputs of `{}`", node.pass), outputs(node).map(|port| port.name.as_str()))
}

impl Checker<'_> {
    /// Joins the ports of all nodes.
    pub(super) fn wire(&mut self, passes: &[Pass<'_>], nodes: &mut [Node]) {
        for pass in passes.iter().filter(|pass| !pass.nodes.is_empty()) {
            for (port, text) in &pass.entry.inputs {
                let Some(index) = self.input_port(&nodes[pass.nodes.start], port) else { continue };
                let Some(from) = &text.value else { continue };
                let wire = self.resolve(from, text.span, passes, nodes);
                for node in pass.nodes.clone() {
                    nodes[node].wires[index] = wire;
                    nodes[node].spans.wires[index] = Some(text.span);
                }
            }
            self.feed(pass, nodes);
        }
        self.check_types(nodes);
        self.check_unwired(passes, nodes);
    }

    fn input_port(&mut self, node: &Node, port: &Spanned<String>) -> Option<usize> {
        let (pass, name) = (node.pass.clone(), port.value.clone());
        match node.port_index(&name) {
            Some(index) if node.port(index).direction != Direction::Out => return Some(index),
            Some(_) => {
                let names: Vec<&str> = inputs(node).map(|port| port.name.as_str()).collect();
                let help =
                    if names.is_empty() { format!("`{pass}` has no inputs") } else { format!("inputs of `{pass}`: {}", list(&names)) };
                self.faults.push(Fault::at(port.span, "", Cause::NotAnInput { pass, port: name }).help(help));
            }
            None => {
                let help = if node.params.contains_key(&name) {
                    format!("`{name}` is a parameter: it is written `set.{name} = …`")
                } else {
                    cure(&name, &format!("inputs of `{pass}`"), inputs(node).map(|port| port.name.as_str()))
                };
                self.faults.push(Fault::at(port.span, "", Cause::UnknownPort { pass, port: name, what: "input" }).help(help));
            }
        }
        None
    }

    /// Every round but the first reads the one before it.
    fn feed(&mut self, pass: &Pass<'_>, nodes: &mut [Node]) {
        for (port, text) in &pass.entry.feed {
            let Some(from) = &text.value else { continue };
            let first = &nodes[pass.nodes.start];
            let input = self.input_port(first, port);
            let output = self.fed_port(first, from, text.span);
            let (Some(input), Some(output)) = (input, output) else { continue };
            for node in pass.nodes.clone().skip(1) {
                nodes[node].wires[input] = Some(Wire { from: PortId { node: node - 1, port: output }, when: When::This });
                nodes[node].spans.wires[input] = Some(text.span);
            }
        }
    }

    fn fed_port(&mut self, node: &Node, name: &str, span: Span) -> Option<usize> {
        let index = node.port_index(name).filter(|&index| node.port(index).direction != Direction::In);
        if index.is_none() {
            let cause = Cause::UnknownPort { pass: node.pass.clone(), port: name.to_owned(), what: "output" };
            let help = cure(name, &format!("outputs of `{}`", node.pass), outputs(node).map(|port| port.name.as_str()));
            self.faults.push(Fault::at(span, "a feed names a port of the pass itself", cause).help(help));
        }
        index
    }

    fn check_types(&mut self, nodes: &[Node]) {
        for node in nodes {
            for (index, wire) in node.wires.iter().enumerate() {
                if let (Some(wire), Some(span)) = (wire, node.spans.wires[index]) {
                    self.check_type(nodes, node, index, wire.from, span);
                }
            }
        }
    }

    fn check_type(&mut self, nodes: &[Node], node: &Node, index: usize, from: PortId, span: Span) {
        let source = &nodes[from.node];
        let (given, taken) = (&source.port(from.port).ty, &node.port(index).ty);
        let Some((given_text, taken_text, same_element)) = difference(given, taken) else { return };
        let (from_name, to) =
            (format!("{}.{}", source.pass, source.port(from.port).name), format!("{}.{}", node.pass, node.port(index).name));
        let labels = (format!("`{}` writes {given_text}", source.pass), format!("`{}` takes {taken_text}", node.pass));
        let cause = if same_element {
            Cause::ExtentMismatch { from: from_name, to, given: given_text, taken: taken_text }
        } else {
            Cause::TypeMismatch { from: from_name, to, given: given_text, taken: taken_text }
        };
        let mut fault = Fault::at(span, "this wire", cause).and(source.spans.name, labels.0);
        if source.pass != node.pass {
            fault = fault.and(node.spans.name, labels.1);
        }
        fault.help = type_help(source, node, taken, nodes);
        self.faults.push(fault);
    }

    fn check_unwired(&mut self, passes: &[Pass<'_>], nodes: &[Node]) {
        for pass in passes {
            let Some(first) = nodes.get(pass.nodes.clone()).and_then(<[Node]>::first) else { continue };
            for (index, port) in first.contract.ports.iter().enumerate() {
                if port.direction == Direction::Out || port.optional || first.spans.wires[index].is_some() {
                    continue;
                }
                let cut = pass.entry.inputs.get(port.name.as_str()).map(|cut| cut.span);
                let cause = Cause::UnwiredInput { pass: pass.name.value.clone(), port: port.name.clone() };
                let fault = Fault::at(cut.unwrap_or(pass.name.span), format!("takes {}", element_and_extent(&port.ty)), cause);
                self.faults.push(fault.help(unwired_help(port, &suppliers(nodes, &port.ty, &pass.name.value))));
            }
        }
    }
}

/// What differs between two ends of a wire, in words, and whether only their numbers of elements do.
fn difference(given: &WireType, taken: &WireType) -> Option<(String, String, bool)> {
    if given.element != taken.element {
        return Some((element(given), element(taken), false));
    }
    if given.layout != taken.layout {
        let layout = |ty: &WireType| format!("{} laid out as {}", element(ty), ty.layout);
        return Some((layout(given), layout(taken), false));
    }
    if given.stride != taken.stride {
        let stride = |ty: &WireType| format!("{} every {} bytes", element(ty), ty.stride);
        return Some((stride(given), stride(taken), false));
    }
    let extent = |ty: &WireType| format!("{} {}", element(ty), extent_text(&ty.extent));
    (given.extent != taken.extent).then(|| (extent(given), extent(taken), true))
}

fn element(ty: &WireType) -> String {
    format!("`{}`", ty.element)
}

/// The element, and how many of it unless one a pixel.
fn element_and_extent(ty: &WireType) -> String {
    if ty.extent == Extent::Pixels { element(ty) } else { format!("{} {}", element(ty), extent_text(&ty.extent)) }
}

fn extent_text(extent: &Extent) -> String {
    match extent {
        Extent::Pixels => "per pixel".to_owned(),
        Extent::Tiles(width, height) => format!("per tile of {width}×{height}"),
        Extent::Fixed(1) => "alone".to_owned(),
        Extent::Fixed(count) => format!("{count} times"),
    }
}

/// Slots that differ are the usual reason; else outputs that would suit are named.
fn type_help(source: &Node, node: &Node, taken: &WireType, nodes: &[Node]) -> Option<String> {
    let differs = |slot: &&String| node.contract.slots.contains(slot) && node.slots.get(*slot) != source.slots.get(*slot);
    if let Some(slot) = source.contract.slots.iter().find(differs) {
        let filling = |node: &Node| node.slots.get(slot).cloned().unwrap_or_default();
        return Some(format!(
            "slot `{slot}` is `{}` in `{}` and `{}` in `{}`: fill both alike",
            filling(source),
            source.pass,
            filling(node),
            node.pass
        ));
    }
    let fitting = suppliers(nodes, taken, &node.pass);
    (!fitting.is_empty()).then(|| format!("outputs that fit: {}", list(&fitting)))
}

/// Outputs of other passes that hold what an input takes.
fn suppliers(nodes: &[Node], taken: &WireType, but: &str) -> Vec<String> {
    let mut names = Vec::new();
    for (index, node) in nodes.iter().enumerate().filter(|(_, node)| node.pass != but) {
        let last = nodes.get(index + 1).is_none_or(|next| next.pass != node.pass);
        let fits = |port: &Port| port.direction != Direction::In && difference(&port.ty, taken).is_none();
        let fitting = node.contract.ports.iter().enumerate().filter(|(_, port)| last && fits(port));
        names.extend(fitting.map(|(port, _)| port_name(nodes, PortId { node: index, port }).replace(&node.name, &node.pass)));
    }
    names
}

fn unwired_help(port: &Port, fitting: &[String]) -> String {
    match fitting {
        [] => format!("write `in.{} = \"pass.port\"`; no pass of this graph writes {} yet", port.name, element_and_extent(&port.ty)),
        [only] => format!("write `in.{} = \"{only}\"`", port.name),
        many => format!("write `in.{} = \"pass.port\"`; outputs that fit: {}", port.name, list(many)),
    }
}
