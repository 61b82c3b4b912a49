//! Has a graph's picture changed? Means over independent seeds against those kept in a file.
//!
//! Pictures of random numbers differ whenever a number is drawn differently, so what is kept is a mean with its variance, and what is asked is
//! whether both can be means of one distribution ([`crate::stats::pixels`]). The seeds are the same on both sides: code that did not change gives
//! the same picture, and code that draws other numbers gives an independent one.

use crate::{
    compare::{
        error::CompareError,
        subject::{Schedule, Stage},
    },
    film::{Facts, Film, GraphText, Run, Runs},
    stats::{
        ensemble::Ensemble,
        pixels::{PixelComparison, PixelError, PixelTest, compare_pixels},
    },
};
use aquifer_graph::Document;

/// Seeds of a kept picture.
pub const SEEDS: u32 = 64;
/// Frames of history before the one that is kept.
pub const WARM_UP: u32 = 4;

/// The mean of one frame over seeds, with the variance of that mean.
///
/// # Errors
/// What the graph or the device refuses.
pub fn picture(stage: &Stage, document: &Document, scene: &str) -> Result<Film, CompareError> {
    let mut subject = stage.subject(document, None, WARM_UP)?;
    let mut mean = Ensemble::default();
    let schedule = Schedule { warm_up: WARM_UP, frames: 1 };
    for seed in 0..u64::from(SEEDS) {
        subject.run(seed, schedule, |_, _, shot| Ok(mean.push(&shot.film)?))?;
    }
    let frames = (0..u64::from(SEEDS)).map(|seed| Run { seed, first_frame: WARM_UP.into(), frames: 1 });
    let facts = Facts {
        samples_per_pixel: SEEDS,
        // Pictures are kept in version control: what differs from run to run stays out.
        render_seconds: 0.0,
        graph: GraphText { text: subject.graph().title().to_owned(), hash: subject.graph().digest() },
        scene: scene.to_owned(),
        environment: None,
        camera: stage.camera.clone().unwrap_or_default(),
        animation_time: stage.time,
        transport: subject.graph().transport().to_string(),
        runs: Runs::new(frames.collect()).expect("seeds differ"),
        adapter: stage.context.adapter().name.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    };
    Ok(Film { facts: Some(facts), ..mean.film() })
}

/// Are both means of one distribution?
///
/// # Errors
/// For pictures of different sizes or without variance.
pub fn compare(got: &Film, want: &Film) -> Result<PixelComparison, PixelError> {
    let seeds = |film: &Film| film.facts.as_ref().map_or(u64::from(SEEDS), |facts| facts.runs.frames());
    compare_pixels(got, want, [seeds(got), seeds(want)], &PixelTest::default())
}

/// Got less want, for people to look at.
pub fn difference(got: &Film, want: &Film) -> Film {
    let color = got.color.iter().zip(&want.color).map(|(got, want)| [0, 1, 2].map(|c| got[c] - want[c])).collect();
    Film { size: got.size, color, ..Film::default() }
}
