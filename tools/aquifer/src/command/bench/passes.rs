//! `aquifer bench passes GRAPH …`

use crate::{
    failure::Failure,
    source::{AdapterArgs, GraphArgs, SceneArgs, ShaderArgs},
    ui::Ui,
    value,
};
use aquifer_graph::Transport;
use aquifer_lab::{
    bench::passes::{PassesReport, measure},
    compare::subject::Stage,
};
use std::sync::Arc;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in graphs (see `aquifer graphs`) or .toml files
    #[arg(required = true, value_name = "GRAPH")]
    graphs: Vec<String>,
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    shaders: ShaderArgs,
    /// Set a value of all graphs; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = value::setting)]
    settings: Vec<String>,
    /// Which light paths, for all graphs
    #[arg(long, value_name = "PATHS", value_parser = value::transport)]
    transport: Option<Transport>,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = value::size)]
    size: [u32; 2],
    /// Rounds in which every graph has its turn, a frame after its warm-up
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args, ui: &Ui) -> Result<(), Failure> {
    let scene = Arc::new(args.scene.load(ui)?);
    let context = args.adapter.open()?;
    let graphs = args.graphs.iter().map(|graph| {
        let source =
            GraphArgs { graph: graph.clone(), settings: args.settings.clone(), transport: args.transport, shaders: args.shaders.clone() };
        Ok((graph.clone(), source.choosing(&context, &scene)?.document()?))
    });
    let graphs = graphs.collect::<Result<Vec<_>, Failure>>()?;
    let registry = args.shaders.registry(Some(&scene))?;
    let stage = Stage { context, registry, scene, camera: None, time: 0.0, step: 0.0, size: args.size, centred: false };
    let reports = measure(&stage, &graphs, args.rounds)?;
    if args.json { ui.json(&reports) } else { ui.print(&reports.iter().map(table).collect::<Vec<_>>().join("\n")) }
}

fn table(report: &PassesReport) -> String {
    let row = |name: &str, ms: &aquifer_lab::bench::turns::Middle| {
        format!("  {name:24} {:>10.2} {:>10.2} – {:>8.2}\n", ms.median, ms.low, ms.high)
    };
    let head = format!("{}, medians of {} rounds\n  {:24} {:>10} {:>21}\n", report.graph, report.rounds, "pass", "ms", "quartiles");
    let passes: String = report.passes.iter().map(|(name, ms)| row(name, ms)).collect();
    head + &passes + &row("frame", &report.frame)
}
