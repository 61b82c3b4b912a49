//! The aquifer command line.
//!
//! A thin face of the framework: every subcommand is a file in `command/` with an `Args` and a `run`. Data goes to stdout, messages go to
//! stderr. Exit codes: 0 done, 1 failed, 2 used wrongly, 75 failed for now (device lost, out of memory: trying again may help).

mod cli;
mod command;
mod failure;
mod faults;
mod interrupt;
mod progress;
mod source;
mod ui;
mod value;

use clap::Parser as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = cli::Cli::parse();
    let ui = ui::Ui::new(cli.global.color, cli.global.verbose);
    match cli.command.run(&ui) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report(&ui);
            failure.exit_code()
        }
    }
}
