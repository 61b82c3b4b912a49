//! `aquifer completions SHELL`

use crate::{cli::Cli, failure::Failure, ui::Ui};
use clap::CommandFactory as _;
use clap_complete::Shell;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// For which shell
    shell: Shell,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "aquifer", &mut script);
    ui.print(&String::from_utf8_lossy(&script))
}
