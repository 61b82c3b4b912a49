//! Nodes with their parameters: every value that is set suits the parameter that it names.

use super::{Checker, Pass};
use crate::{Cause, Contract, Fault, Node, Param, RESERVED_PARAMS, Transport, Value, graph::NodeSpans, nearest::cure, params::reserved};
use std::collections::BTreeMap;

/// A number that a graph file may turn.
pub(super) fn is_knob(param: &Param) -> bool {
    param.default.as_f64().is_some() && param.choices.is_empty() && !RESERVED_PARAMS.contains(&param.name.as_str())
}

impl Checker<'_> {
    /// The nodes of every pass that has a contract, not yet wired.
    pub(super) fn nodes(&mut self, passes: &[Pass<'_>], transport: Transport) -> Vec<Node> {
        let mut nodes = Vec::new();
        for pass in passes {
            self.check_rounds(pass);
            let Some(contract) = &pass.contract else { continue };
            let params = self.params(pass, contract);
            let params = filled(contract, &params, transport);
            nodes.extend(pass.nodes.clone().map(|index| node(pass, contract, index, params.clone())));
        }
        nodes
    }

    fn check_rounds(&mut self, pass: &Pass<'_>) {
        let name = pass.name.value.clone();
        let feed = pass.entry.feed.iter().find(|(_, fed)| fed.value.is_some());
        match (pass.entry.repeat, feed) {
            (Some(repeat), None) if repeat.value > 1 => {
                let fault = Fault::at(repeat.span, "every round would compute the same", Cause::RepeatWithoutFeed { pass: name });
                self.faults.push(fault.help("say which input takes which output of the round before: `feed.current = \"reservoir\"`"));
            }
            (None, Some((port, _))) => {
                let fault = Fault::at(port.span, "", Cause::FeedWithoutRepeat { pass: name });
                self.faults.push(fault.help("write `repeat = 2`, or take `feed` out"));
            }
            _ => {}
        }
    }

    /// What the file sets, in the types of the parameters.
    fn params(&mut self, pass: &Pass<'_>, contract: &Contract) -> BTreeMap<String, Value> {
        let mut params = BTreeMap::new();
        for (key, literal) in &pass.entry.set {
            let name = key.value.as_str();
            let Some(param) = contract.params.iter().find(|param| param.name == name) else {
                self.unknown_param(pass, contract, key);
                continue;
            };
            if RESERVED_PARAMS.contains(&name) {
                let fault = Fault::at(key.span, "", Cause::ReservedParam { param: name.to_owned() });
                self.faults.push(fault.help("set the graph's `transport` instead"));
                continue;
            }
            match param.value(&literal.value) {
                Ok(value) => {
                    params.insert(name.to_owned(), value);
                }
                Err(error) => self.faults.push(Fault { help: error.help, ..Fault::at(literal.span, "", *error.cause) }),
            }
        }
        params
    }

    fn unknown_param(&mut self, pass: &Pass<'_>, contract: &Contract, key: &crate::Spanned<String>) {
        let name = &pass.name.value;
        let cause = Cause::UnknownParam { pass: name.clone(), param: key.value.clone() };
        let help = if contract.ports.iter().any(|port| port.name == key.value) {
            format!("`{0}` is a port: wires are written `in.{0} = \"pass.port\"`", key.value)
        } else {
            let settable = contract.params.iter().map(|param| param.name.as_str()).filter(|param| !RESERVED_PARAMS.contains(param));
            cure(&key.value, &format!("parameters of `{name}`"), settable)
        };
        self.faults.push(Fault::at(key.span, "", cause).help(help));
    }
}

/// Every parameter of the contract: as set, as the graph fills it, or the default.
fn filled(contract: &Contract, set: &BTreeMap<String, Value>, transport: Transport) -> BTreeMap<String, Value> {
    let value = |param: &Param| reserved(param, transport).or_else(|| set.get(&param.name).copied()).unwrap_or(param.default);
    contract.params.iter().map(|param| (param.name.clone(), value(param))).collect()
}

fn node(pass: &Pass<'_>, contract: &Contract, index: usize, params: BTreeMap<String, Value>) -> Node {
    let name = pass.name.value.clone();
    let round = index - pass.nodes.start + 1;
    Node {
        name: if pass.rounds() > 1 { format!("{name}.{round}") } else { name.clone() },
        pass: name,
        kind: pass.kind.value.clone(),
        slots: pass.slots.clone(),
        params,
        contract: contract.clone(),
        wires: vec![None; contract.ports.len()],
        spans: NodeSpans {
            name: pass.name.span,
            params: pass.entry.set.iter().map(|(key, literal)| (key.value.clone(), key.span.to(literal.span))).collect(),
            slots: pass.slot_spans.clone(),
            own_slots: pass.entry.slots.iter().filter(|(_, filling)| filling.value.is_some()).map(|(slot, _)| slot.value.clone()).collect(),
            wires: vec![None; contract.ports.len()],
        },
    }
}
