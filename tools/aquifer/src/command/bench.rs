//! `aquifer bench trace | passes | load`

mod load;
mod passes;
mod trace;

use crate::{failure::Failure, ui::Ui};
use clap::Subcommand;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Rays a second of each ray tracer on this adapter, beside obvhs on the CPU, on the same rays
    Trace(trace::Args),
    /// Milliseconds of each pass of graphs
    Passes(passes::Args),
    /// How long a scene takes to load, to build and to upload
    Load(load::Args),
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    match args.action {
        Action::Trace(args) => trace::run(&args, ui),
        Action::Passes(args) => passes::run(&args, ui),
        Action::Load(args) => load::run(&args, ui),
    }
}
