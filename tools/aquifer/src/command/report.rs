//! `aquifer report FOLDER`

use crate::{failure::Failure, ui::Ui};
use aquifer_lab::{
    compare::report::{Report, SCHEMA},
    page,
};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A folder that `aquifer compare` wrote, or its report.json
    path: PathBuf,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let json = if args.path.is_dir() { args.path.join("report.json") } else { args.path };
    let folder = json.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
    page::write(&read(&json)?, &folder)?;
    ui.note(&format!("wrote {}", folder.join("report.html").display()));
    Ok(())
}

fn read(path: &Path) -> Result<Report, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::new(format!("cannot read `{}`: {error}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| failed(&error))?;
    let report: Report = serde_json::from_str(&text).map_err(|error| failed(&error))?;
    match report.schema {
        SCHEMA => Ok(report),
        other => Err(failed(&format!("it has schema {other}, this program reads {SCHEMA}"))),
    }
}
