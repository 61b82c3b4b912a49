//! All manual pages as one Markdown page: docs/passes.md.

use super::{default_of, extent, way};
use crate::failure::Failure;
use aquifer_graph::{Contract, Contracts as _, Param, Port, Slots};
use aquifer_render::Registry;

const HEAD: &str = "# Passes

Every kind of pass and every filling of a slot, from the heads of their shaders. Made by `aquifer passes --markdown > docs/passes.md`; a test compares.
Ports are listed for the default fillings of slots; a slot without one shows its first.
";

/// The whole page.
pub fn book(registry: &Registry, slots: &Slots) -> Result<String, Failure> {
    let mut text = HEAD.to_owned();
    for kind in registry.kinds() {
        let known = registry.known(&kind, slots)?;
        text += &format!("\n## {kind}\n\n{}\n", known.composed.interface.manual.trim());
        text += &facts(&known.contract);
    }
    text += "\n# Fillings of slots\n";
    for (slot, fillings) in registry.slots() {
        text += &format!("\n## {slot}\n");
        for filling in fillings {
            let manual = registry.library().manual(&format!("{slot}/{filling}")).unwrap_or_default();
            let default = if slots.get(&slot) == Some(&filling) { " (default)" } else { "" };
            text += &format!("\n### {filling}{default}\n\n{}\n", manual.trim());
            text.extend(registry.library().bias(&format!("{slot}/{filling}")).iter().map(|line| format!("\n{line}\n")));
        }
    }
    Ok(text)
}

fn facts(contract: &Contract) -> String {
    let mut text = String::new();
    table(&mut text, "| port | | holds | |\n|---|---|---|---|", contract.ports.iter().map(port));
    table(&mut text, "| parameter | default | values | |\n|---|---|---|---|", contract.params.iter().map(param));
    if !contract.slots.is_empty() {
        text += &format!("\nSlots: {}.\n", contract.slots.join(", "));
    }
    for bias in &contract.bias {
        let unless = match (&bias.param, &bias.unless) {
            (Some(param), Some(unless)) => format!("unless `{param}` is {unless}: "),
            _ => String::new(),
        };
        text += &format!("\nBiased, {unless}{}.\n", bias.why);
    }
    text
}

fn table(text: &mut String, head: &str, rows: impl Iterator<Item = String>) {
    let rows: Vec<String> = rows.collect();
    if !rows.is_empty() {
        *text += &format!("\n{head}\n{}\n", rows.join("\n"));
    }
}

fn port(port: &Port) -> String {
    format!("| `{}` | {} | {}, {} | {} |", port.name, way(port), port.ty.element, extent(&port.ty.extent), cell(&port.doc))
}

fn param(param: &Param) -> String {
    let range = param.range.map(|(low, high)| format!("{low} to {high}"));
    let values = if param.choices.is_empty() { range.unwrap_or_default() } else { param.choices.join(", ") };
    let live = if param.live { "" } else { "baked; " };
    format!("| `{}` | {} | {live}{values} | {} |", param.name, default_of(param), cell(&param.doc))
}

/// Text within a table, where a bar would end the cell.
fn cell(text: &str) -> String {
    text.replace('|', r"\|")
}
