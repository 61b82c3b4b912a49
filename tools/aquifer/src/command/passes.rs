//! `aquifer passes [NAME]`

mod book;

use crate::{failure::Failure, source::ShaderArgs, ui::Ui};
use aquifer_graph::{Contract, ContractError, Contracts, Direction, Extent, Param, Port, Slots, Value, nearest};
use aquifer_render::Registry;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Show this kind's manual page: what it does, its ports, parameters and slots
    name: Option<String>,
    #[command(flatten)]
    shaders: ShaderArgs,
    /// Print all manual pages as one Markdown page
    #[arg(long, conflicts_with = "name")]
    markdown: bool,
    /// Print ports and parameters as JSON
    #[arg(long, requires = "name")]
    json: bool,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let registry = args.shaders.registry(None)?;
    let slots = fillings(&registry);
    if args.markdown {
        return ui.print(&book::book(&registry, &slots)?);
    }
    let Some(name) = args.name else { return ui.print(&list(&registry, &slots)) };
    let known = registry.known(&name, &slots).map_err(|error| refused(&name, error))?;
    if args.json {
        return ui.json(&known.contract);
    }
    ui.print(&page(&name, &known.composed.interface.manual, &known.contract))
}

/// What fills each slot when nothing is said; where nothing does, the first that could.
fn fillings(registry: &Registry) -> Slots {
    let known = registry.slots().into_iter().filter_map(|(slot, fillings)| Some((slot, fillings.into_iter().next()?)));
    known.chain(registry.library().default_slots()).collect()
}

fn refused(name: &str, error: ContractError) -> Failure {
    match &error {
        ContractError::UnknownKind { known, .. } => {
            let near = nearest(name, known.iter().map(String::as_str));
            let cure = near.map_or_else(|| "`aquifer passes` lists them".to_owned(), |near| format!("did you mean `{near}`?"));
            Failure::new(format!("{error}; {cure}"))
        }
        _ => error.into(),
    }
}

/// Name and first sentence of each kind; a shader that does not compose says why.
fn list(registry: &Registry, slots: &Slots) -> String {
    let line = |kind: &String| {
        let about = match registry.known(kind, slots) {
            Ok(known) => known.contract.about.clone(),
            Err(ContractError::UnfilledSlot { slot, .. }) => format!("(slot `{slot}` has no default filling)"),
            Err(error) => format!("(broken: {})", error.to_string().lines().next().unwrap_or_default()),
        };
        format!("{kind:24} {about}")
    };
    registry.kinds().iter().map(line).collect::<Vec<_>>().join("\n")
}

fn page(name: &str, manual: &str, contract: &Contract) -> String {
    let mut sections = vec![format!("{name}\n\n{}", manual.trim())];
    let ports = contract.ports.iter().map(port).collect::<Vec<_>>();
    let params = contract.params.iter().map(param).collect::<Vec<_>>();
    let bias = contract.bias.iter().map(|bias| format!("  {}", bias.why)).collect::<Vec<_>>();
    let slots = contract.slots.iter().map(|slot| format!("  {slot}")).collect::<Vec<_>>();
    for (title, lines) in [("Ports", ports), ("Parameters", params), ("Slots", slots), ("Bias", bias)] {
        if !lines.is_empty() {
            sections.push(format!("{title}\n{}", lines.join("\n")));
        }
    }
    sections.join("\n\n")
}

fn port(port: &Port) -> String {
    format!("  {} ({}): {}, {}{}", port.name, way(port), port.ty.element, extent(&port.ty.extent), doc(&port.doc))
}

fn way(port: &Port) -> &'static str {
    match port.direction {
        Direction::In if port.optional => "in, optional",
        Direction::In => "in",
        Direction::Out => "out",
        Direction::InOut => "in and out",
    }
}

fn extent(extent: &Extent) -> String {
    match extent {
        Extent::Pixels => "one a pixel".to_owned(),
        Extent::Tiles(w, h) => format!("one a tile of {w}×{h} pixels"),
        Extent::Fixed(n) => format!("{n} in all"),
    }
}

fn param(param: &Param) -> String {
    let mut facts = vec![default_of(param)];
    facts.extend(param.range.map(|(low, high)| format!("{low} to {high}")));
    if !param.choices.is_empty() {
        facts.push(format!("one of {}", param.choices.join(", ")));
    }
    if param.live {
        facts.push("live".to_owned());
    }
    format!("  {} = {}{}", param.name, facts.join(", "), doc(&param.doc))
}

/// The default as a graph file writes it.
fn default_of(param: &Param) -> String {
    match param.default {
        Value::U32(n) => param.choices.get(n as usize).map_or_else(|| n.to_string(), |choice| format!("\"{choice}\"")),
        Value::Bool(value) => value.to_string(),
        Value::I32(value) => value.to_string(),
        Value::F32(value) => format!("{value:?}"),
    }
}

fn doc(text: &str) -> String {
    text.lines().map(|line| format!("\n      {}", line.trim())).collect()
}
