//! What every pass is: its kind, its slots, its contract.

use super::Checker;
use crate::{Cause, Contract, ContractError, Entry, Fault, Slots, Span, Spanned, nearest::cure};
use std::{collections::BTreeMap, ops::Range};

/// One pass of the document with what is known of it.
pub(super) struct Pass<'a> {
    pub name: &'a Spanned<String>,
    pub entry: &'a Entry,
    pub kind: &'a Spanned<String>,
    pub slots: Slots,
    /// Where each of `slots` was said.
    pub slot_spans: BTreeMap<String, Span>,
    /// `None` when it has a fault.
    pub contract: Option<Contract>,
    /// Its nodes: one for each round; none without a contract.
    pub nodes: Range<usize>,
}

impl Pass<'_> {
    /// The node that wires of other passes mean.
    pub fn last_node(&self) -> Option<usize> {
        self.nodes.clone().next_back()
    }

    /// How many rounds it runs.
    pub fn rounds(&self) -> u32 {
        self.entry.repeat.map_or(1, |repeat| repeat.value)
    }
}

impl<'a> Checker<'a> {
    pub(super) fn passes(&mut self) -> Vec<Pass<'a>> {
        let document = self.document;
        let mut passes: Vec<Pass<'a>> = document.pass.iter().map(|(name, entry)| self.pass(name, entry)).collect();
        let mut next = 0;
        for pass in passes.iter_mut().filter(|pass| pass.contract.is_some()) {
            let first = next;
            next += pass.rounds() as usize;
            pass.nodes = first..next;
        }
        self.check_slots(&passes);
        passes
    }

    fn pass(&mut self, name: &'a Spanned<String>, entry: &'a Entry) -> Pass<'a> {
        let kind = entry.kind.as_ref().unwrap_or(name);
        let (slots, slot_spans) = self.slots_of(entry);
        let mut pass = Pass { name, entry, kind, slots, slot_spans, contract: None, nodes: 0..0 };
        match self.contracts.contract(&kind.value, &pass.slots) {
            Ok(contract) => pass.contract = Some(contract),
            Err(error) => {
                let fault = contract_fault(&pass, error);
                self.faults.push(fault);
            }
        }
        pass
    }

    /// The graph's slots with the pass's own laid over them.
    fn slots_of(&self, entry: &Entry) -> (Slots, BTreeMap<String, Span>) {
        let (mut slots, mut spans) = (Slots::new(), BTreeMap::new());
        for (slot, filling) in self.document.slots.iter().chain(&entry.slots) {
            if let Some(module) = &filling.value {
                slots.insert(slot.value.clone(), module.clone());
                spans.insert(slot.value.clone(), filling.span);
            }
        }
        (slots, spans)
    }

    /// Every slot that is filled exists, and somebody asks for it.
    fn check_slots(&mut self, passes: &[Pass<'_>]) {
        let known = self.contracts.slots();
        for (slot, filling) in &self.document.slots {
            if !self.filling_exists(slot, filling, &known) {
                continue;
            }
            let asked = |pass: &Pass<'_>| match &pass.contract {
                Some(contract) => contract.slots.contains(&slot.value) && pass.slot_spans.get(&slot.value) == Some(&filling.span),
                None => true,
            };
            if !passes.iter().any(asked) {
                let cause = Cause::UnusedSlot { slot: slot.value.clone(), by: None };
                self.faults.push(Fault::at(slot.span, "", cause).help(format!("take the line out, or write `{} = false`", slot.value)));
            }
        }
        for pass in passes {
            self.check_slots_of(pass, &known);
        }
    }

    fn check_slots_of(&mut self, pass: &Pass<'_>, known: &BTreeMap<String, Vec<String>>) {
        for (slot, filling) in &pass.entry.slots {
            if !self.filling_exists(slot, filling, known) {
                continue;
            }
            let Some(contract) = &pass.contract else { continue };
            if !contract.slots.contains(&slot.value) {
                let cause = Cause::UnusedSlot { slot: slot.value.clone(), by: Some(pass.name.value.clone()) };
                let help = cure(&slot.value, &format!("slots of `{}`", pass.name.value), contract.slots.iter().map(String::as_str));
                self.faults.push(Fault::at(slot.span, "", cause).help(help));
            }
        }
    }

    /// The slot is filled, exists, and has this module.
    fn filling_exists(&mut self, slot: &Spanned<String>, filling: &Spanned<Option<String>>, known: &BTreeMap<String, Vec<String>>) -> bool {
        let Some(module) = &filling.value else { return false };
        let fault = match known.get(&slot.value) {
            None => {
                let fault = Fault::at(slot.span, "", Cause::UnknownSlot { slot: slot.value.clone() });
                fault.help(cure(&slot.value, "slots", known.keys().map(String::as_str)))
            }
            Some(modules) if !modules.contains(module) => unknown_filling(filling.span, &slot.value, module, modules),
            Some(_) => return true,
        };
        self.faults.push(fault);
        false
    }
}

fn contract_fault(pass: &Pass<'_>, error: ContractError) -> Fault {
    let name = &pass.name.value;
    match error {
        ContractError::UnknownKind { kind, known } => {
            let help = cure(&kind, "kinds", known.iter().map(String::as_str));
            let label = if pass.entry.kind.is_some() { "" } else { "a pass without `kind` is of the kind that it is named after" };
            Fault::at(pass.kind.span, label, Cause::UnknownKind { kind }).help(help)
        }
        ContractError::UnknownFilling { slot, filling, known } => {
            unknown_filling(pass.slot_spans.get(&slot).copied().unwrap_or(pass.name.span), &slot, &filling, &known)
        }
        ContractError::UnfilledSlot { slot, known, .. } => {
            let modules = if known.is_empty() { String::new() } else { format!("; modules: {}", crate::nearest::list(&known)) };
            let help = format!("write `slots.{slot} = \"…\"` in the pass, or `{slot} = \"…\"` under `[slots]` for all{modules}");
            Fault::at(pass.name.span, "", Cause::UnfilledSlot { slot, pass: name.clone() }).help(help)
        }
        ContractError::Shader(message) => Fault::at(pass.kind.span, "", Cause::Shader { pass: name.clone(), message }),
    }
}

fn unknown_filling(span: Span, slot: &str, filling: &str, known: &[String]) -> Fault {
    let help = cure(filling, &format!("modules for `{slot}`"), known.iter().map(String::as_str));
    Fault::at(span, "", Cause::UnknownFilling { slot: slot.to_owned(), filling: filling.to_owned() }).help(help)
}
