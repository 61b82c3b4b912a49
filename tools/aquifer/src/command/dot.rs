//! `aquifer dot GRAPH`

use crate::{failure::Failure, source::GraphArgs, ui::Ui};

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    graph: GraphArgs,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let (graph, _) = args.graph.check(None)?;
    ui.print(&graph.to_dot())
}
