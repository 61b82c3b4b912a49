//! Has a graph's picture changed? Means over independent seeds against those kept in a file.
//!
//! Pictures of random numbers differ whenever a number is drawn differently, so what is kept is a mean with its variance, and what is asked is
//! whether both can be means of one distribution: for every pixel ([`crate::stats::pixels`]), for the image's mean, which finds a bias too small for any
//! pixel, and for the noise of one render, which finds reuse that no longer helps and changes no mean. The seeds are the same on both sides: code that
//! did not change gives the same bits on the same adapter, and code that draws other numbers gives an independent picture.

mod page;
mod store;

pub use page::{PageError, Shown, write};
pub use store::{Kept, Scalar, Store, StoreError};

use crate::{
    compare::{
        error::CompareError,
        subject::{Schedule, Stage},
    },
    film::{Facts, Film, GraphText, Run, Runs, luminance},
    stats::{
        Difference, Estimate, Moments,
        ensemble::Ensemble,
        pixels::{PixelComparison, PixelError, PixelTest, compare_pixels},
    },
};
use aquifer_graph::{Document, Source};
use std::fmt;

/// Seeds of a kept picture.
pub const SEEDS: u32 = 64;
/// Frames of history before the one that is kept.
pub const WARM_UP: u32 = 4;
/// Radius of spatial reuse in pixels, whatever the graph says: its own is meant for images of 1080 rows, and would be less than a pixel of these.
pub const RADIUS: f32 = 6.0;
/// Candidates of each slot of a grid of lights: its size does not shrink with the image.
const GRID_CANDIDATES: u32 = 1;
/// Chance that the image's mean, or its noise, fails by itself.
const ALPHA: f64 = 0.001;

/// What is kept of a graph on a scene.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The mean of one frame over seeds, with the variance of that mean.
    pub film: Film,
    /// Mean luminance of the image over seeds, and how far one seed's image is from their mean, as a share of it.
    pub scalars: Kept,
    /// Hash of the mean's bits.
    pub bits: String,
}

/// What a comparison found.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Pixel by pixel.
    pub pixels: PixelComparison,
    /// Of the image's mean, as a share.
    pub level: Difference,
    /// Of the noise, as a share.
    pub noise: Difference,
    /// The same bits as the last time on this adapter; `None` where it kept none.
    pub same_bits: Option<bool>,
}

impl Verdict {
    /// Nothing has changed that statistics can tell.
    pub fn passed(&self) -> bool {
        self.pixels.passed && self.failed().is_none()
    }

    /// Which number of the whole image has changed.
    pub fn failed(&self) -> Option<&'static str> {
        let fails = |difference: &Difference| difference.p_different() <= ALPHA;
        [("mean", &self.level), ("noise", &self.noise)].into_iter().find(|(_, difference)| fails(difference)).map(|(name, _)| name)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = if self.passed() { "unchanged" } else { "changed" };
        let bits = match self.same_bits {
            Some(true) => "the same bits",
            Some(false) => "other bits",
            None => "no bits kept on this adapter",
        };
        let share = |difference: &Difference| format!("{:+.2} ± {:.2} %", 100.0 * difference.value, 100.0 * difference.standard_error);
        let (failed, pixels) = (self.pixels.failed, self.pixels.p.len());
        write!(f, "{word} ({bits}; {failed} of {pixels} pixels fail, mean {}, noise {})", share(&self.level), share(&self.noise))
    }
}

/// The picture of a graph on a stage.
///
/// # Errors
/// What the graph or the device refuses.
pub fn picture(stage: &Stage, document: &Document, scene: &str) -> Result<Picture, CompareError> {
    let document = fitted(stage, document)?;
    let mut subject = stage.subject(&document, None, WARM_UP)?;
    let schedule = Schedule { warm_up: WARM_UP, frames: 1 };
    let mut films = Vec::new();
    for seed in 0..u64::from(SEEDS) {
        subject.run(seed, schedule, |_, _, shot| {
            films.push(shot.film);
            Ok(())
        })?;
    }
    let mut mean = Ensemble::default();
    films.iter().try_for_each(|film| mean.push(film))?;
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
    let film = Film { facts: Some(facts), ..mean.film() };
    let bits: Vec<u8> = film.color.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let hash = blake3::hash(&bits).to_hex();
    Ok(Picture { scalars: scalars(&films, &film), film, bits: hash[..32].to_owned() })
}

/// The graph for an image as small as these.
fn fitted(stage: &Stage, document: &Document) -> Result<Document, CompareError> {
    let graph = stage.graph(document, None)?;
    let mut edits = std::collections::BTreeSet::new();
    for node in graph.nodes() {
        match node.kind.as_str() {
            "spatial" => edits.extend([format!("{}.rows=0.0", node.pass), format!("{}.radius={RADIUS:?}", node.pass)]),
            "regir" => edits.extend([format!("{}.candidates={GRID_CANDIDATES}", node.pass)]),
            _ => {}
        }
    }
    let mut document = document.clone();
    document.apply(edits.into_iter().map(|text| Source::new("regress", text)))?;
    Ok(document)
}

fn scalars(films: &[Film], mean: &Film) -> Kept {
    let bright = |color: &[f32; 3]| luminance(color.map(f64::from));
    let total: f64 = mean.color.iter().map(bright).sum();
    let level: Moments = films.iter().map(|film| film.color.iter().map(bright).sum::<f64>() / mean.pixels() as f64).collect();
    let distance = |film: &Film| film.color.iter().zip(&mean.color).map(|(one, mean)| (bright(one) - bright(mean)).abs()).sum::<f64>();
    let noise: Moments = films.iter().map(|film| if total > 0.0 { distance(film) / total } else { 0.0 }).collect();
    Kept { level: (&level).into(), noise: (&noise).into() }
}

/// Is the picture still the one that was kept?
///
/// # Errors
/// For pictures of different sizes or without variance.
pub fn compare(got: &Picture, want: &Film, kept: &Kept, bits: Option<&str>) -> Result<Verdict, PixelError> {
    let seeds = |film: &Film| film.facts.as_ref().map_or(u64::from(SEEDS), |facts| facts.runs.frames());
    let estimate = |scalar: &Scalar, film: &Film| Estimate {
        mean: scalar.mean,
        standard_error: scalar.standard_error,
        freedom: seeds(film).saturating_sub(1) as f64,
    };
    let share = |got_scalar: &Scalar, kept: &Scalar| {
        Difference::welch(estimate(got_scalar, &got.film), estimate(kept, want)).relative_to(kept.mean)
    };
    Ok(Verdict {
        pixels: compare_pixels(&got.film, want, [seeds(&got.film), seeds(want)], &PixelTest::default())?,
        level: share(&got.scalars.level, &kept.level),
        noise: share(&got.scalars.noise, &kept.noise),
        same_bits: bits.map(|bits| bits == got.bits),
    })
}

/// Got less want, for people to look at.
pub fn difference(got: &Film, want: &Film) -> Film {
    let color = got.color.iter().zip(&want.color).map(|(got, want)| [0, 1, 2].map(|c| got[c] - want[c])).collect();
    Film { size: got.size, color, ..Film::default() }
}
