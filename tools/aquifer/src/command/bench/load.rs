//! `aquifer bench load`

use crate::{
    failure::Failure,
    source::{AdapterArgs, load_scene},
    ui::Ui,
};
use aquifer_lab::bench::loading::{LoadReport, measure};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A built-in scene (see `aquifer scenes list`) or a .glb or .gltf file
    #[arg(long, value_name = "SCENE", default_value = "million")]
    scene: String,
    /// Rounds in which every step has its turn
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args, ui: &Ui) -> Result<(), Failure> {
    let context = args.adapter.open()?;
    let report = measure(&context, args.rounds, || load_scene(&args.scene, None))?;
    if args.json { ui.json(&report) } else { ui.print(&table(&args.scene, &report)) }
}

fn table(scene: &str, report: &LoadReport) -> String {
    let LoadReport { triangles, instances, rounds, device_bytes, .. } = report;
    let head = format!(
        "{scene}: {triangles} triangles, {instances} instances, {} MB on the device; medians of {rounds} rounds\n{:30} {:>9} {:>18}\n",
        device_bytes / 1_000_000,
        "step",
        "ms",
        "of default build"
    );
    let row = |step: &aquifer_lab::bench::loading::StepReport| {
        format!("{:30} {:>9.1} {:>18.2}\n", step.name, step.seconds.median * 1e3, step.of_default_build.median)
    };
    head + &report.steps.iter().map(row).collect::<String>()
}
