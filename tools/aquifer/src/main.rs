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
mod watch;

use clap::Parser as _;
use std::process::ExitCode;

/// The Vulkan loader complains on every start when this variable is unset: a folder of ours stands in.
#[expect(unsafe_code, reason = "the first thing in main: no other thread can be reading the environment")]
fn set_runtime_folder() {
    const NAME: &str = "XDG_RUNTIME_DIR";
    if cfg!(target_os = "linux") && std::env::var_os(NAME).is_none() {
        let user = std::env::var("USER").unwrap_or_default();
        let folder = std::env::temp_dir().join(format!("aquifer-runtime-{user}"));
        if std::fs::create_dir_all(&folder).is_ok() {
            // SAFETY: the process has one thread yet.
            unsafe { std::env::set_var(NAME, folder) };
        }
    }
}

fn main() -> ExitCode {
    set_runtime_folder();
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
