//! From a [`Document`] to a [`Graph`]: names, slots, values, wires and order, with every fault found on the way.

mod order;
mod passes;
mod paths;
mod values;
mod wires;

use crate::{
    Cause, Contracts, Document, Fault, Faults, Graph, Knob, Node, PortId, Source, Span, Spanned, Transport, When, Wire,
    nearest::{cure, list},
    wire::{GRAMMAR, WireText},
};
use passes::Pass;

impl Graph {
    /// Checks everything that can be checked without a device; all faults come at once.
    pub fn check(document: &Document, contracts: &dyn Contracts) -> Result<Graph, Faults> {
        Graph::check_with(document.clone(), [], contracts)
    }

    /// [Lays settings over](Document::apply) the document, and checks the outcome. A setting with a fault hides no fault of the rest.
    pub fn check_with(mut document: Document, edits: impl IntoIterator<Item = Source>, contracts: &dyn Contracts) -> Result<Graph, Faults> {
        let faults = document.lay_edits(edits);
        let mut checker = Checker { document: &document, contracts, faults };
        let graph = checker.graph();
        let mut faults = checker.faults;
        drop_repetitions(&mut faults);
        Faults::unless_empty(&document.sources, faults)?;
        Ok(graph.expect("a graph without faults has an output and a transport"))
    }
}

/// The rounds of one pass have the same faults on the same lines.
fn drop_repetitions(faults: &mut Vec<Fault>) {
    let mut seen: Vec<Fault> = Vec::new();
    faults.retain(|fault| {
        let new = !seen.contains(fault);
        if new {
            seen.push(fault.clone());
        }
        new
    });
}

struct Checker<'a> {
    document: &'a Document,
    contracts: &'a dyn Contracts,
    faults: Vec<Fault>,
}

impl Checker<'_> {
    fn graph(&mut self) -> Option<Graph> {
        let transport = self.transport();
        let passes = self.passes();
        // Values are checked under any transport, so that its fault hides no other.
        let mut nodes = self.nodes(&passes, transport.unwrap_or(Transport::Direct));
        self.wire(&passes, &mut nodes);
        let output = self.output(&passes, &nodes);
        self.order(&nodes, output);
        let knob = self.knob(&passes);
        let document = self.document;
        let text = |text: &Option<Spanned<String>>| text.as_ref().map(|text| text.value.clone());
        let graph = Graph {
            sources: document.sources.clone(),
            title: text(&document.title).or_else(|| document.sources.iter().next().map(|first| first.name.clone())).unwrap_or_default(),
            about: text(&document.about).unwrap_or_default(),
            transport: transport?,
            nodes,
            output: output?.value,
            knob,
        };
        self.paths(&graph);
        Some(graph)
    }

    fn transport(&mut self) -> Option<Transport> {
        let Some(text) = &self.document.transport else {
            let fault = Fault::placeless(Cause::MissingKey { key: "transport" });
            self.faults.push(self.in_file(fault).help("say which light paths the output holds: `transport = \"full:4\"`"));
            return None;
        };
        text.value.parse().map_err(|error| self.faults.push(Fault::at(text.span, "", Cause::BadTransport(error)))).ok()
    }

    fn output(&mut self, passes: &[Pass], nodes: &[Node]) -> Option<Spanned<PortId>> {
        let Some(text) = &self.document.output else {
            let fault = Fault::placeless(Cause::MissingKey { key: "output" });
            self.faults.push(self.in_file(fault).help("name what is shown and saved: `output = \"tonemap.image\"`"));
            return None;
        };
        let wire = self.resolve(text.value.as_str(), text.span, passes, nodes)?;
        if wire.when == When::Previous {
            let port = text.value.trim_end_matches("@prev").to_owned();
            let fault = Fault::at(text.span, "", Cause::OutputOfLastFrame { port: port.clone() });
            self.faults.push(fault.help(format!("write `output = \"{port}\"`")));
            return None;
        }
        Some(Spanned::new(wire.from, text.span))
    }

    /// A fault of the whole file points at its first line.
    fn in_file(&self, fault: Fault) -> Fault {
        match self.document.sources.iter().next() {
            Some(first) => {
                let line = first.text.lines().next().unwrap_or_default().len();
                fault.and(Span::new(0, 0..line), "in this file")
            }
            None => fault,
        }
    }

    /// The output port that a wire's text names.
    fn resolve(&mut self, text: &str, span: Span, passes: &[Pass], nodes: &[Node]) -> Option<Wire> {
        let Some(parts) = WireText::parse(text) else {
            self.faults.push(Fault::at(span, "", Cause::BadWire { text: text.to_owned() }).help(GRAMMAR));
            return None;
        };
        let Some(pass) = passes.iter().find(|pass| pass.name.value == parts.pass) else {
            let fault = self.unknown_pass(parts.pass, span);
            self.faults.push(fault);
            return None;
        };
        // Without a contract the pass has a fault already.
        let node = pass.last_node()?;
        let port = self.output_port(&nodes[node], parts, span, nodes)?;
        Some(Wire { from: PortId { node, port }, when: parts.when })
    }

    fn output_port(&mut self, node: &Node, parts: WireText<'_>, span: Span, nodes: &[Node]) -> Option<usize> {
        let pass = parts.pass.to_owned();
        match node.port_index(parts.port) {
            Some(index) if node.port(index).direction != crate::Direction::In => return Some(index),
            Some(index) => {
                let cause = Cause::NotAnOutput { pass, port: parts.port.to_owned() };
                let help = match node.wires[index] {
                    Some(wire) => format!("wire from where it comes from: `{}`", crate::graph::wire_name(nodes, wire)),
                    None => wires::outputs_help(node),
                };
                self.faults.push(Fault::at(span, "", cause).help(help));
            }
            None => {
                let what = format!("outputs of `{}`", parts.pass);
                let help = cure(parts.port, &what, wires::outputs(node).map(|port| port.name.as_str()));
                self.faults.push(Fault::at(span, "", Cause::UnknownPort { pass, port: parts.port.to_owned(), what: "output" }).help(help));
            }
        }
        None
    }

    fn unknown_pass(&self, name: &str, span: Span) -> Fault {
        let fault = Fault::at(span, "", Cause::UnknownPass { pass: name.to_owned() });
        if let Some((removed, ())) = self.document.removed.get_key_value(name) {
            return fault.and(removed.span, "it is removed here").help("wire it to another pass, or write `false` to leave it unwired");
        }
        fault.help(cure(name, "passes", self.document.pass.keys().map(|key| key.value.as_str())))
    }

    fn knob(&mut self, passes: &[Pass]) -> Option<Knob> {
        let Spanned { value: Some(knob), span } = self.document.knob.as_ref()? else { return None };
        match find_knob(knob, passes) {
            Ok(found) => found,
            Err((reason, help)) => {
                self.faults.push(Fault::at(*span, "", Cause::BadKnob { knob: knob.clone(), reason }).help(help));
                None
            }
        }
    }
}

/// The parameter that a knob names; `Ok(None)` when its pass has a fault already.
fn find_knob(knob: &str, passes: &[Pass]) -> Result<Option<Knob>, (String, String)> {
    let grammar = || ("it must be written `pass.parameter`".to_owned(), "for example `knob = \"initial.candidates\"`".to_owned());
    let (name, param) = knob.split_once('.').ok_or_else(grammar)?;
    let Some(pass) = passes.iter().find(|pass| pass.name.value == name) else {
        return Err((format!("there is no pass `{name}`"), cure(name, "passes", passes.iter().map(|pass| pass.name.value.as_str()))));
    };
    let Some(contract) = &pass.contract else { return Ok(None) };
    let numbers: Vec<&str> = contract.params.iter().filter(|param| values::is_knob(param)).map(|param| param.name.as_str()).collect();
    match contract.params.iter().find(|known| known.name == param) {
        Some(known) if values::is_knob(known) => Ok(Some(Knob { pass: name.to_owned(), param: param.to_owned() })),
        Some(_) if numbers.is_empty() => Err((format!("`{param}` is not a number to turn"), format!("`{name}` has none"))),
        Some(_) => Err((format!("`{param}` is not a number to turn"), format!("numbers of `{name}`: {}", list(&numbers)))),
        None => Err((format!("pass `{name}` has no parameter `{param}`"), cure(param, &format!("numbers of `{name}`"), numbers))),
    }
}
