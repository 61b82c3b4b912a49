//! `aquifer explain GRAPH --scene S`

use crate::{
    failure::Failure,
    source::{AdapterArgs, GraphArgs, SceneArgs},
    ui::Ui,
    value,
};
use aquifer_lab::explain::{Explanation, Missing, Request, Ways, explain};
use std::{collections::BTreeMap, sync::Arc};

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    graph: GraphArgs,
    #[command(flatten)]
    scene: SceneArgs,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "256x144", value_parser = value::size)]
    size: [u32; 2],
    /// Frames that are timed each way, in turns; 0 measures no time
    #[arg(long, value_name = "N", default_value_t = 15)]
    rounds: u32,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print it as JSON, every piece of every shader included
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let scene = Arc::new(args.scene.load(ui)?);
    let document = args.graph.document()?;
    let context = args.adapter.open()?;
    let request = Request {
        context: &context,
        scene: &scene,
        document: &document,
        folders: &args.graph.shaders.folders,
        size: args.size,
        rounds: args.rounds,
    };
    let found = explain(&request)?;
    if args.json { ui.json(&found) } else { ui.print(&told(&found, &args.scene.scene)) }
}

fn told(found: &Explanation, scene: &str) -> String {
    let [width, height] = found.size;
    let facts: Vec<&str> = found.facts.iter().copied().collect();
    let mut lines = vec![
        format!("{} on {scene}, {width}x{height}, {}", found.graph, found.adapter),
        format!("  the scene has {}", if facts.is_empty() { "nothing special".to_owned() } else { facts.join(", ") }),
        format!("  runs {}", found.runs.join(", ")),
        String::new(),
    ];
    lines.extend(found.left_out.iter().chain(&found.arrays).map(missing));
    lines.extend(pieces(found));
    if lines.last().is_some_and(String::is_empty) {
        lines.push("nothing is left out".to_owned());
    }
    lines.push(String::new());
    let Ways { needed, all } = found.bytes;
    lines.push(format!("memory {needed} bytes, with everything kept {all}: {} saved", all.saturating_sub(needed)));
    if let (Some(Ways { needed, all }), Some(ratio)) = (found.frame_ms, found.slowdown) {
        lines.push(format!(
            "frame {:.2} ms, with everything kept {:.2} ms: {:.3} times as long (quartiles {:.3} to {:.3})",
            needed.median, all.median, ratio.median, ratio.low, ratio.high
        ));
    }
    lines.join("\n")
}

fn missing(missing: &Missing) -> String {
    let Missing { name, because, what, bytes } = missing;
    format!("{what:8} {name}: {because} ({bytes} bytes)")
}

/// How many pieces of shaders each condition left out, and of which modules.
fn pieces(found: &Explanation) -> Vec<String> {
    let mut by_condition: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for piece in &found.pieces {
        by_condition.entry(&piece.condition).or_default().push(piece.place.split(".wgsl").next().unwrap_or_default());
    }
    let line = |(condition, mut modules): (&str, Vec<&str>)| {
        let count = modules.len();
        modules.dedup();
        format!("shaders  {count} pieces that need {condition}: in {}", modules.join(", "))
    };
    by_condition.into_iter().map(line).collect()
}
