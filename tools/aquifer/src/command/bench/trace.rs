//! `aquifer bench trace`

use crate::{
    failure::Failure,
    source::{AdapterArgs, SceneArgs, ShaderArgs},
    ui::Ui,
    value,
};
use aquifer_lab::bench::tracing::{KindReport, TraceOptions, TraceReport, measure};
use std::sync::Arc;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    shaders: ShaderArgs,
    /// A filling of slot `trace`; repeatable [default: all]
    #[arg(long = "tracer", value_name = "NAME")]
    tracers: Vec<String>,
    /// Pixels across and down: one ray of each kind for every pixel
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = value::size)]
    size: [u32; 2],
    /// Rounds in which every contestant has its turn
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
    /// Times that the device traces all rays in a round; more for fast adapters, where submitting would count
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    repeats: u32,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args, ui: &Ui) -> Result<(), Failure> {
    let scene = Arc::new(args.scene.load(ui)?);
    let context = args.adapter.open()?;
    let options = TraceOptions {
        tracers: args.tracers.clone(),
        size: args.size,
        rounds: args.rounds,
        repeats: args.repeats,
        shaders: args.shaders.folders.clone(),
    };
    let report = measure(&context, &scene, &options)?;
    if args.json { ui.json(&report) } else { ui.print(&table(&args.scene.scene, &report)) }
}

fn table(scene: &str, report: &TraceReport) -> String {
    let TraceReport { adapter, triangles, instances, rounds, .. } = report;
    let head = format!("{scene}: {triangles} triangles, {instances} instances; {adapter}; medians of {rounds} rounds\n");
    let columns =
        format!("{:8} {:>9} {:18} {:>9} {:>9} {:>17} {:>9}\n", "rays", "count", "tracer", "Mrays/s", "of obvhs", "quartiles", "differing");
    head + &columns + &report.kinds.iter().map(rows).collect::<String>()
}

fn rows(kind: &KindReport) -> String {
    let row = |tracer: &aquifer_lab::bench::tracing::TracerReport| {
        let differing = tracer.differing.map_or_else(|| "-".to_owned(), |share| format!("{:.4} %", share * 100.0));
        let (speed, share) = (&tracer.mrays_per_second, &tracer.of_obvhs);
        format!(
            "{:8} {:>9} {:18} {:>9.3} {:>7.1} % {:>7.1} % – {:>5.1} % {differing:>9}\n",
            format!("{:?}", kind.kind).to_lowercase(),
            kind.rays,
            tracer.name,
            speed.median,
            share.median * 100.0,
            share.low * 100.0,
            share.high * 100.0
        )
    };
    kind.tracers.iter().map(row).collect()
}
