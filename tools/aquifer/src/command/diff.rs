//! `aquifer diff IMAGE REFERENCE`

mod table;

use crate::{failure::Failure, ui::Ui, value};
use aquifer_lab::{
    film::{Area, Film, Region},
    metrics::{Measured, Metric, Pair, heat},
    stats::{BlockTest, Blocks, Verdict, blocks::Quantity, compare_blocks},
};
use serde::Serialize;
use std::{collections::BTreeMap, path::PathBuf};

const HELP: &str = "Metrics: mse, rel_mse, mape, smape, psnr, flip_ldr, flip_hdr. Errors of MSE and relMSE are without the reference's own variance, where its file knows it.
A limit fails (exit code 1) when any area exceeds it; psnr must not fall below its limit.";

#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// The image to judge (.exr or .png)
    image: PathBuf,
    /// What it should be (.exr or .png)
    reference: PathBuf,
    /// Measure this part too; may be given several times
    #[arg(long, value_name = "[NAME=]X,Y,WxH", value_parser = region)]
    region: Vec<(String, Region)>,
    /// Only pixels that are white in this image count
    #[arg(long, value_name = "IMAGE")]
    mask: Option<PathBuf>,
    /// Write the difference as a picture
    #[arg(long, value_name = "FILE", value_parser = value::image)]
    heat: Option<PathBuf>,
    /// Which difference the picture shows
    #[arg(long, value_name = "WHAT", default_value = "flip-hdr", requires = "heat")]
    heat_of: HeatOf,
    /// Fail when a metric is worse than this; may be given several times
    #[arg(long, value_name = "METRIC=VALUE", value_parser = limit)]
    limit: Vec<(Metric, f64)>,
    /// Fail unless both agree: means within 0.5 %, blocks of 8×8 pixels within 2 % where they are resolved
    #[arg(long)]
    agree: bool,
    /// Print numbers as JSON
    #[arg(long)]
    json: bool,
}

/// What a heat map shows.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum HeatOf {
    /// FLIP over exposures, from black to pale yellow
    FlipHdr,
    /// FLIP of what a screen shows
    FlipLdr,
    /// Relative difference of luminance: blue too dark, red too bright
    Difference,
}

/// `[NAME=]X,Y,WxH`; a region without a name is called by its numbers.
fn region(text: &str) -> Result<(String, Region), String> {
    let (name, numbers) = text.split_once('=').unwrap_or((text, text));
    Ok((name.to_owned(), numbers.parse::<Region>().map_err(|error| error.to_string())?))
}

/// `METRIC=VALUE`
fn limit(text: &str) -> Result<(Metric, f64), String> {
    let (metric, value) = text.split_once('=').ok_or("write METRIC=VALUE, e.g. rel_mse=0.01")?;
    let metric = metric.parse::<Metric>().map_err(|error| error.to_string())?;
    let value = value.parse().ok().filter(|value: &f64| value.is_finite());
    Ok((metric, value.ok_or_else(|| format!("`{text}` has no number after `=`"))?))
}

/// All that was measured.
#[derive(Serialize)]
struct Report {
    /// The whole image first, then the regions.
    areas: Vec<AreaReport>,
    /// `passed`, `failed` or `not resolved`, over the whole image.
    agreement: String,
    /// Limits that were exceeded, in words.
    exceeded: Vec<String>,
}

/// One area.
#[derive(Serialize)]
struct AreaReport {
    name: String,
    pixels: usize,
    /// Pixels that are infinite or not a number.
    not_finite: usize,
    /// Mean luminance of the image over the reference's, less one.
    mean_difference: Option<f64>,
    /// By key; null where a metric is undefined.
    metrics: BTreeMap<&'static str, Option<Measured>>,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let (image, reference) = (Film::read(&args.image)?, Film::read(&args.reference)?);
    let pair = Pair::new(&image, &reference)?;
    let areas = areas(&args, reference.size)?;
    let reports = areas.iter().map(|(name, area)| AreaReport::new(name, &pair, area)).collect::<Result<Vec<_>, _>>()?;
    let blocks = |film| Blocks::of_film(film, 8, Quantity::Luminance);
    let agreement =
        compare_blocks(&blocks(&image), &blocks(&reference), &BlockTest::default()).map_err(|error| Failure::Failed(error.into()))?;
    let exceeded = reports.iter().flat_map(|area| area.exceeded(&args.limit)).collect();
    let report = Report { areas: reports, agreement: agreement.verdict.to_string(), exceeded };
    if let Some(path) = &args.heat {
        heat(args.heat_of, &pair, &image, &reference)?.write(path)?;
    }
    if args.json {
        ui.json(&report)?;
    } else {
        ui.print(&table::of(&report, &agreement.to_string()))?;
    }
    match agreement.verdict {
        _ if !report.exceeded.is_empty() => Err(Failure::new(report.exceeded.join("; "))),
        verdict if args.agree && verdict != Verdict::Passed => Err(Failure::new(format!("agreement: {verdict}"))),
        _ => Ok(()),
    }
}

/// The whole image and the regions, under the mask.
fn areas(args: &Args, size: [u32; 2]) -> Result<Vec<(String, Area)>, Failure> {
    let mask = args.mask.as_deref().map(Film::read).transpose()?;
    let masked = |area: Area| match &mask {
        Some(mask) => area.masked(mask),
        None => Ok(area),
    };
    let mut areas = vec![("image".to_owned(), masked(Area::whole(size))?)];
    for (name, region) in &args.region {
        areas.push((name.clone(), Area::region(size, *region).and_then(masked)?));
    }
    Ok(areas)
}

fn heat(what: HeatOf, pair: &Pair, image: &Film, reference: &Film) -> Result<Film, Failure> {
    Ok(match what {
        HeatOf::FlipHdr => heat::of_flip(pair.flip_hdr().ok_or_else(|| Failure::new("the reference is black: no exposure suits it"))?),
        HeatOf::FlipLdr => heat::of_flip(pair.flip_ldr()),
        HeatOf::Difference => heat::of_difference(image, reference)?,
    })
}

impl AreaReport {
    fn new(name: &str, pair: &Pair, area: &Area) -> Result<Self, Failure> {
        let measured = |metric: Metric| Ok((metric.key(), pair.measure(metric, area)?));
        Ok(Self {
            name: name.to_owned(),
            pixels: area.count(),
            not_finite: pair.not_finite(area),
            mean_difference: pair.mean_difference(area),
            metrics: Metric::all().map(measured).collect::<Result<_, Failure>>()?,
        })
    }

    /// Limits that this area exceeds; an undefined metric exceeds every limit.
    fn exceeded<'a>(&'a self, limits: &'a [(Metric, f64)]) -> impl Iterator<Item = String> + 'a {
        limits.iter().filter_map(|&(metric, limit)| match self.metrics[metric.key()] {
            Some(measured) if metric.is_within(measured.value, limit) => None,
            Some(measured) => Some(format!("{}: {metric} is {:.4e}, the limit {limit:.4e}", self.name, measured.value)),
            None => Some(format!("{}: {metric} is undefined: the reference is black", self.name)),
        })
    }
}
