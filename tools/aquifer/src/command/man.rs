//! `aquifer man`

use crate::{cli::Cli, failure::Failure, ui::Ui};
use clap::CommandFactory as _;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Write a page for every command into this folder, instead of the main page to stdout
    #[arg(long, value_name = "DIR")]
    folder: Option<PathBuf>,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let command = Cli::command();
    if let Some(folder) = args.folder {
        let failed = |error: std::io::Error| Failure::new(format!("cannot write into `{}`: {error}", folder.display()));
        return clap_mangen::generate_to(command, &folder).map_err(failed);
    }
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page).map_err(|error| Failure::Failed(error.into()))?;
    ui.print(&String::from_utf8_lossy(&page))
}
