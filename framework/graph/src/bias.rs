//! Whether a graph is unbiased, and if not, which lines make it so.

use crate::{Bias, Graph, Literal, Node, Param, Place};
use serde::Serialize;

/// One reason why a graph's output is biased.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BiasFinding {
    /// The pass.
    pub pass: String,
    /// The line that brings it in: a parameter, a slot's filling, or the pass itself.
    pub place: Place,
    /// What stands there, in words: "`boiling` = 4.0", "slot `mis` is `constant`", "kind `validate`".
    pub what: String,
    /// Why that biases.
    pub why: String,
    /// The fact that a scene must have for it; `None` where nothing more is asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub given: Option<String>,
    /// A setting that turns it off and leaves the rest alone: `slots.mis=contribution`; `None` where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub without: Option<String>,
}

impl Graph {
    /// Everything that biases the result; empty when the graph is unbiased. Passes that the output does not need are not asked.
    pub fn bias(&self) -> Vec<BiasFinding> {
        self.findings(|bias| bias.given.is_none())
    }

    /// What would bias the result of other scenes, by facts that the scene has not; without a scene, by all such facts.
    pub fn bias_elsewhere(&self) -> Vec<BiasFinding> {
        self.findings(|bias| bias.given.is_some())
    }

    fn findings(&self, asked: impl Fn(&Bias) -> bool) -> Vec<BiasFinding> {
        let needed = self.needed();
        let mut findings: Vec<BiasFinding> = Vec::new();
        for node in needed.into_iter().map(|node| &self.nodes[node]) {
            for bias in node.contract.bias.iter().filter(|bias| asked(bias) && applies(node, bias)) {
                let finding = self.finding(node, bias);
                if !findings.contains(&finding) {
                    findings.push(finding);
                }
            }
        }
        findings
    }

    fn finding(&self, node: &Node, bias: &Bias) -> BiasFinding {
        let name = bias.param.as_deref();
        let slot = bias.slot.as_ref().and_then(|slot| Some((slot, node.slots.get(slot)?)));
        let param = name.and_then(|name| node.contract.params.iter().find(|param| param.name == name));
        let span = match (name, slot) {
            (Some(name), _) => node.spans.params.get(name),
            (None, Some((slot, _))) => node.spans.slots.get(slot),
            (None, None) => None,
        };
        let what = match (param, slot) {
            (Some(param), _) => {
                format!("`{}` = {}", param.name, param.literal(node.params.get(&param.name).copied().unwrap_or(param.default)))
            }
            (None, Some((slot, filling))) => format!("slot `{slot}` is `{filling}`"),
            (None, None) => format!("kind `{}`", node.kind),
        };
        let place = self.sources.place(span.copied().unwrap_or(node.spans.name));
        let (why, given, without) = (bias.why.clone(), bias.given.clone(), without(node, bias));
        BiasFinding { pass: node.pass.clone(), place, what, why, given, without }
    }
}

/// The setting that turns a bias off, for the pass alone where its slot is its own.
fn without(node: &Node, bias: &Bias) -> Option<String> {
    if let (Some(param), Some(value)) = (&bias.param, &bias.unless) {
        return Some(format!("{}.{param}={value}", node.pass));
    }
    let (slot, filling) = bias.without.as_ref()?;
    let own = if node.spans.own_slots.contains(slot) { format!("{}.", node.pass) } else { String::new() };
    Some(format!("{own}slots.{slot}={filling}"))
}

/// The part biases with the values that the node has.
fn applies(node: &Node, bias: &Bias) -> bool {
    if bias.unless_slot.as_ref().is_some_and(|(slot, filling)| node.slots.get(slot) == Some(filling)) {
        return false;
    }
    let Some(name) = &bias.param else { return true };
    let Some(param) = node.contract.params.iter().find(|param| param.name == *name) else { return true };
    let unbiased = bias.unless.as_ref().and_then(|text| value_of(param, text));
    unbiased.is_none() || node.params.get(name).copied() != unbiased
}

/// The value that a text of a graph file gives a parameter, quoted or not.
fn value_of(param: &Param, text: &str) -> Option<crate::Value> {
    let literal = match crate::tree::parse_value(0, text) {
        Some(crate::tree::Tree::Leaf(literal)) => literal,
        _ => Literal::Text(text.to_owned()),
    };
    param.value(&literal).ok()
}
