//! Order: something can run first, nothing is rewritten by two, nothing is read after it was rewritten.

use super::Checker;
use crate::{
    Cause, Fault, Node, PortId, Span, Spanned, When, Wire,
    flow::{Flow, Hazard, Homeless, Link, Why},
    graph::{port_name, wire_name},
};

impl Checker<'_> {
    pub(super) fn order(&mut self, nodes: &[Node], output: Option<Spanned<PortId>>) {
        let all = |_| true;
        let flow = Flow::new(nodes, &all);
        self.faults.extend(flow.hazards().iter().map(|hazard| fault(nodes, hazard)));
        if let Some(output) = output
            && let Some(writer) = flow.rewriter(Wire { from: output.value, when: When::This })
        {
            let resource = port_name(nodes, output.value);
            let cause = Cause::StaleRead { resource, reader: "output".to_owned(), writer: nodes[writer.node].name.clone() };
            let fault = Fault::at(output.span, "", cause).and(wire_span(nodes, writer), "it is rewritten here");
            self.faults.push(fault.help(format!("write `output = \"{}\"`", public_name(nodes, writer))));
        }
    }
}

fn fault(nodes: &[Node], hazard: &Hazard) -> Fault {
    match hazard {
        Hazard::Homeless { user, lost } => homeless(nodes, *user, *lost),
        Hazard::TwoWriters { version, first, second } => two_writers(nodes, *version, *first, *second),
        Hazard::StaleHistory { reader, writer } => stale_history(nodes, *reader, *writer),
        Hazard::SharedPorts { one, other } => shared_ports(nodes, *one, *other),
        Hazard::Cycle(links) => cycle(nodes, links),
    }
}

fn homeless(nodes: &[Node], user: PortId, lost: Homeless) -> Fault {
    let span = wire_span(nodes, user);
    match lost {
        Homeless::TwoFramesBack(port) => {
            let from = nodes[port.node].wires[port.port].map(|wire| wire_name(nodes, wire)).unwrap_or_default();
            let fault = Fault::at(span, "", Cause::TwoFramesBack { port: port_name(nodes, port) });
            fault.and(wire_span(nodes, port), format!("it rewrites `{from}` in place"))
        }
        Homeless::NoOrigin(port) => {
            let fault = Fault::at(span, "an in-out port", Cause::NoOrigin { port: port_name(nodes, port) });
            fault.help("wire it from an output; a pass that remembers reads last frame's through one port and writes another")
        }
    }
}

fn two_writers(nodes: &[Node], version: Wire, first: PortId, second: PortId) -> Fault {
    let name = |port: PortId| nodes[port.node].name.clone();
    let cause = Cause::TwoWriters { resource: wire_name(nodes, version), first: name(first), second: name(second) };
    let fault = Fault::at(wire_span(nodes, second), format!("`{}` rewrites it in place", name(second)), cause);
    let fault = fault.and(wire_span(nodes, first), format!("`{}` rewrites it in place", name(first)));
    fault.help(format!("let one follow the other: wire `{}` from `{}`", public_name(nodes, second), public_name(nodes, first)))
}

fn stale_history(nodes: &[Node], reader: PortId, writer: PortId) -> Fault {
    let wire = nodes[reader.node].wires[reader.port].map(|wire| wire_name(nodes, wire)).unwrap_or_default();
    let cause = Cause::StaleRead { resource: wire, reader: nodes[reader.node].name.clone(), writer: nodes[writer.node].name.clone() };
    let fault = Fault::at(wire_span(nodes, reader), "", cause).and(wire_span(nodes, writer), "it is rewritten here, before the frame ends");
    fault.help(format!("read `{}@prev`", public_name(nodes, writer)))
}

fn shared_ports(nodes: &[Node], one: PortId, other: PortId) -> Fault {
    let resource = nodes[one.node].wires[one.port].map_or_else(|| port_name(nodes, one), |wire| wire_name(nodes, wire));
    let fault = Fault::at(wire_span(nodes, other), "", Cause::SharedPorts { pass: nodes[one.node].pass.clone(), resource });
    fault.and(wire_span(nodes, one), "the same memory")
}

/// A circle that closes only because something is rewritten in place is told as what it is: a read that comes too late.
fn cycle(nodes: &[Node], links: &[Link]) -> Fault {
    match links.iter().find(|link| matches!(link.why, Why::Rewrites { .. })) {
        Some(link) => stale_read(nodes, links, *link),
        None => circle(nodes, links),
    }
}

fn stale_read(nodes: &[Node], links: &[Link], late: Link) -> Fault {
    let Why::Rewrites { port } = late.why else { return circle(nodes, links) };
    let (reader, writer) = (&nodes[late.first], PortId { node: late.then, port });
    let version = nodes[writer.node].wires[port];
    let resource = version.map(|wire| wire_name(nodes, wire)).unwrap_or_default();
    let read = reader.wires.iter().position(|wire| *wire == version);
    let span = read.and_then(|port| reader.spans.wires[port]).unwrap_or(reader.spans.name);
    let cause = Cause::StaleRead { resource, reader: reader.name.clone(), writer: nodes[writer.node].name.clone() };
    let mut fault = Fault::at(span, "", cause).and(wire_span(nodes, writer), "it is rewritten here");
    for link in links.iter().filter(|link| **link != late) {
        let (span, text) = link_label(nodes, link);
        fault = fault.and(span, text);
    }
    fault.help(format!("read `{}` instead", public_name(nodes, writer)))
}

fn circle(nodes: &[Node], links: &[Link]) -> Fault {
    let mut chain: Vec<String> = links.iter().map(|link| nodes[link.first].name.clone()).collect();
    chain.extend(chain.first().cloned());
    let mut labels = links.iter().map(|link| link_label(nodes, link));
    let (span, text) = labels.next().unwrap_or((nodes[0].spans.name, String::new()));
    let fault = labels.fold(Fault::at(span, text, Cause::Cycle { chain }), |fault, (span, text)| fault.and(span, text));
    fault.help(if links.iter().any(|link| matches!(link.why, Why::ReadsRewritten { .. })) {
        "last frame's half is rewritten before all of its readers, so its rewriter cannot wait for one of them"
    } else {
        "one of these wires must read last frame's: add `@prev`"
    })
}

fn link_label(nodes: &[Node], link: &Link) -> (Span, String) {
    let (first, then) = (&nodes[link.first].name, &nodes[link.then].name);
    match link.why {
        Why::Reads { port } => (wire_span(nodes, PortId { node: link.then, port }), format!("`{then}` waits for `{first}`")),
        Why::Rewrites { port } => (wire_span(nodes, PortId { node: link.then, port }), format!("`{then}` rewrites what `{first}` reads")),
        Why::ReadsRewritten { port } => {
            (wire_span(nodes, PortId { node: link.then, port }), format!("`{then}` waits for `{first}`, which rewrites last frame's"))
        }
    }
}

/// Where the wire into a port is written.
fn wire_span(nodes: &[Node], port: PortId) -> Span {
    let node = &nodes[port.node];
    node.spans.wires[port.port].unwrap_or(node.spans.name)
}

/// A port as a wire of the file would name it.
fn public_name(nodes: &[Node], port: PortId) -> String {
    let node = &nodes[port.node];
    format!("{}.{}", node.pass, node.port(port.port).name)
}
