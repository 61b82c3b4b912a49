//! `aquifer diff IMAGE REFERENCE`

use crate::{failure::Failure, ui::Ui};
use aquifer_lab::{
    film::{Film, luminance},
    stats::{
        BlockTest, Blocks, Verdict,
        blocks::Quantity,
        compare_blocks,
        error::{SquareError, mse, rel_mse},
    },
};
use serde::Serialize;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// The image to judge (.exr or .png)
    image: PathBuf,
    /// What it should be (.exr or .png)
    reference: PathBuf,
    /// Fail unless both agree: means within 0.5 %, blocks of 8×8 pixels within 2 % where they are resolved
    #[arg(long)]
    agree: bool,
    /// Print numbers as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    /// Mean luminance of the image over the reference's, less one.
    mean_difference: f64,
    /// The reference's variance taken out.
    mse: f64,
    /// The reference's variance taken out.
    rel_mse: f64,
    /// The reference's variance, which was taken out.
    reference_variance: f64,
    /// `passed`, `failed` or `not resolved`.
    agreement: String,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let (image, reference) = (Film::read(&args.image)?, Film::read(&args.reference)?);
    let (absolute, relative) = (mse(&image, &reference)?, rel_mse(&image, &reference)?);
    let blocks = |film| Blocks::of_film(film, 8, Quantity::Luminance);
    let agreement =
        compare_blocks(&blocks(&image), &blocks(&reference), &BlockTest::default()).map_err(|error| Failure::Failed(error.into()))?;
    let report = Report {
        mean_difference: mean(&image) / mean(&reference) - 1.0,
        mse: absolute.value(),
        rel_mse: relative.value(),
        reference_variance: absolute.reference,
        agreement: agreement.verdict.to_string(),
    };
    if args.json {
        ui.json(&report)?;
    } else {
        ui.print(&sentences(&report, absolute, relative, &agreement.to_string()))?;
    }
    match agreement.verdict {
        Verdict::Passed => Ok(()),
        verdict if args.agree => Err(Failure::new(format!("agreement: {verdict}"))),
        _ => Ok(()),
    }
}

fn sentences(report: &Report, absolute: SquareError, relative: SquareError, agreement: &str) -> String {
    let noise = |error: SquareError| match error.reference {
        0.0 => "the reference taken as exact".to_owned(),
        noise => format!("{:.4e} less the reference's variance {noise:.4e}", error.raw),
    };
    format!(
        "mean       {:+.3} %\nMSE        {:.4e}  ({})\nrelMSE     {:.4e}  ({})\nagreement  {agreement}",
        100.0 * report.mean_difference,
        report.mse,
        noise(absolute),
        report.rel_mse,
        noise(relative),
    )
}

fn mean(film: &Film) -> f64 {
    film.color.iter().map(|color| luminance(color.map(f64::from))).sum::<f64>() / film.pixels() as f64
}
