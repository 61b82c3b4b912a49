//! `aquifer merge A B -o OUT`

use crate::{failure::Failure, ui::Ui, value};
use aquifer_lab::{
    atomic,
    film::{self, Film, Format},
};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Renders of the same thing with other frames or seeds: .exr files as `aquifer render` writes them
    #[arg(required = true, num_args = 2.., value_name = "FILE")]
    inputs: Vec<PathBuf>,
    /// Where to write the merged render (.exr)
    #[arg(short, long, value_name = "FILE", value_parser = value::image)]
    output: PathBuf,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    if Format::of(&args.output)? != Format::Exr {
        return Err(Failure::new("merged renders are radiance: the output must be an .exr file"));
    }
    atomic::check_writable(&args.output)?;
    let mut merged = Film::read(&args.inputs[0])?;
    for path in &args.inputs[1..] {
        let next = Film::read(path)?;
        merged = film::merge(&merged, &next).map_err(|error| Failure::new(format!("cannot merge `{}`: {error}", path.display())))?;
    }
    merged.write(&args.output)?;
    let samples = merged.facts.map_or(0, |facts| facts.samples_per_pixel);
    ui.note(&format!("wrote {}: {samples} samples per pixel", args.output.display()));
    Ok(())
}
