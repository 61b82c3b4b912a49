//! `aquifer adapters`

use crate::{failure::Failure, ui::Ui};
use aquifer_render::{AdapterReport, adapters};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print everything known as JSON, limits included
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let found = adapters();
    if found.is_empty() {
        return Err(aquifer_render::Error::NoAdapter.into());
    }
    if args.json { ui.json(&found) } else { ui.print(&found.iter().map(line).collect::<Vec<_>>().join("\n")) }
}

fn line(adapter: &AdapterReport) -> String {
    let clock = if adapter.timestamps { "" } else { ", no timestamps" };
    format!("{}\n    {} {}, driver {}{clock}", adapter.name, adapter.backend, adapter.kind, adapter.driver)
}
