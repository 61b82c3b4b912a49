//! What a comparison found: the whole of `report.json`.
//!
//! Every number that a page or a table shows is here; names of files are relative to the folder of the report. An optional number that is
//! absent is undefined (a relative error of a black image, an interval of one value), never zero.

mod bias;
mod explained;
mod pair;
mod reach;

pub use bias::{BiasFigures, BiasVerdict, Correlation};
pub use explained::{Explained, Share, SwitchShare};
pub use pair::{Better, Pair, Ratio};
pub use reach::{EqualError, Reach};

use super::summary::Summary;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Grows whenever a reader of older files would misread newer ones.
pub const SCHEMA: u32 = 1;

/// A whole comparison.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: u32,
    /// What made it.
    pub made: Made,
    /// What was measured.
    pub protocol: Protocol,
    /// In the order of the command line; the first is the baseline.
    pub graphs: Vec<GraphFacts>,
    /// In the order of the command line.
    pub scenes: Vec<SceneResult>,
    /// What readers must know: unlike things compared by force, times that could not be made equal, references that are too noisy.
    pub warnings: Vec<String>,
}

/// What made a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Made {
    /// Version of Aquifer.
    pub version: String,
    /// Seconds since 1970, UTC.
    pub unix_time: u64,
    /// The command, word by word.
    pub command: Vec<String>,
    /// Name of the graphics adapter.
    pub adapter: String,
    /// `vulkan`, `metal`, `dx12`.
    pub backend: String,
    /// Driver and its version.
    pub driver: String,
    /// Who held the watch: `timestamps` of the device, or `wall` time of submitted work.
    pub clock: String,
    /// Seconds of measured rendering in all, warm-up included.
    pub measured_seconds: f64,
    /// Seconds of everything else but references: images read back, errors, files.
    pub lab_seconds: f64,
}

/// What was measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Protocol {
    /// One frame after `warm_up` frames.
    Frame {
        /// Frames before the one that counts; graphs without history need none.
        warm_up: u32,
        /// Independent seeds.
        seeds: u32,
        /// All films sample the middle of the pixel, so that antialiasing counts as nobody's error.
        centred: bool,
    },
    /// The mean of frames, over a growing budget.
    Accumulate {
        /// Frames before the first that counts.
        warm_up: u32,
        /// The largest budget.
        frames: u32,
        /// Independent seeds.
        seeds: u32,
        /// As in `Frame`.
        centred: bool,
    },
    /// The error of each frame of an animation.
    Trace {
        /// How many frames.
        frames: u32,
        /// Seconds from one frame to the next.
        step: f32,
        /// Independent seeds.
        seeds: u32,
        /// As in `Frame`.
        centred: bool,
    },
}

impl Protocol {
    /// Frames before the first that counts.
    pub fn warm_up(self) -> u32 {
        match self {
            Self::Frame { warm_up, .. } | Self::Accumulate { warm_up, .. } => warm_up,
            Self::Trace { .. } => 0,
        }
    }

    /// Independent repetitions.
    pub fn seeds(self) -> u32 {
        match self {
            Self::Frame { seeds, .. } | Self::Accumulate { seeds, .. } | Self::Trace { seeds, .. } => seeds,
        }
    }

    /// The same for any number of repetitions: more of them go on with those that are done.
    pub fn without_seeds(mut self) -> Self {
        match &mut self {
            Self::Frame { seeds, .. } | Self::Accumulate { seeds, .. } | Self::Trace { seeds, .. } => *seeds = 0,
        }
        self
    }
}

impl Default for Protocol {
    fn default() -> Self {
        Self::Frame { warm_up: 0, seeds: 0, centred: false }
    }
}

/// A graph that was compared.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GraphFacts {
    /// Short and unique in the report: the file's name, and what distinguishes it.
    pub name: String,
    /// Title of the file.
    pub title: String,
    /// Every text it was read from.
    pub text: String,
    /// Of everything that decides what it computes.
    pub hash: String,
    /// What the command line laid over it.
    pub settings: Vec<String>,
    /// Which light paths it holds.
    pub transport: String,
    /// Frames depend on frames before.
    pub history: bool,
    /// The parameter that spends spare time, where the file names one.
    pub knob: Option<String>,
    /// Why it is biased, line by line; empty for a graph that claims to be unbiased.
    pub bias: Vec<String>,
}

/// One scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneResult {
    /// Short and unique in the report.
    pub name: String,
    /// A built-in scene's name, or a file's name with the hash of its bytes and of the files that it names.
    pub identity: String,
    /// The environment laid over the scene's own, as `identity`.
    pub environment: Option<String>,
    /// Name of the camera.
    pub camera: String,
    /// Seconds into the animation at frame 0.
    pub animation_time: f32,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// One for every transport compared (one, unless forced); of a trace, that of its last frame.
    pub references: Vec<ReferenceFacts>,
    /// Every graph at every budget.
    pub cells: Vec<Cell>,
    /// Every graph against the baseline.
    pub pairs: Vec<Pair>,
    /// Time of each graph to the same error; `None` where budgets do not grow.
    #[serde(default)]
    pub equal_error: Option<EqualError>,
    /// Biased graphs whose bias was asked about.
    #[serde(default)]
    pub explained: Vec<Explained>,
}

/// What is taken for the truth.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReferenceFacts {
    /// Which light paths.
    pub transport: String,
    /// The file: mean and variance of the mean.
    pub image: String,
    /// Names the cache entry.
    pub hash: String,
    /// Samples in every pixel.
    pub samples: u64,
    /// Its variance of the mean, averaged over pixels and channels: what was taken out of every MSE.
    pub variance: f64,
    /// The same relative to each pixel, as in relMSE.
    pub rel_variance: f64,
    /// `variance` over the smallest MSE measured against it: how much of the smallest error is the reference's.
    pub share: Option<f64>,
    /// The smallest error measured is wholly within its noise.
    #[serde(default)]
    pub hides: bool,
    /// No light at all: relative metrics are undefined.
    pub black: bool,
}

/// A graph at one budget of time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Index into [`Report::graphs`].
    pub graph: usize,
    /// Index into [`SceneResult::references`].
    pub reference: usize,
    /// Milliseconds that were aimed at; `None` for a graph that runs at its own frame time.
    pub budget_ms: Option<f64>,
    /// The graph whose own frame time is the budget.
    pub budget_of: Option<usize>,
    /// What was run to meet the budget: one, or two around it whose squared errors are averaged by weight.
    pub variants: Vec<Variant>,
    /// Time of what makes the image: every pass that it needs; tonemap, accumulate and whatever comes after them left out.
    pub time_ms: Summary,
    /// Mean square error, the reference's variance taken out.
    pub mse: Summary,
    /// Relative mean square error, likewise; `None` where the reference is black.
    pub rel_mse: Option<Summary>,
    /// Further metrics by name, each over seeds.
    pub metrics: BTreeMap<String, Summary>,
    /// In order of execution, of the first variant.
    pub passes: Vec<PassShare>,
    /// The first seed's film.
    pub image: Option<String>,
    /// The mean over seeds with its variance.
    pub mean_image: Option<String>,
    /// Error against time (accumulate) or frame (trace).
    pub curve: Vec<Point>,
    /// How much of the error is bias.
    pub bias: Option<BiasFigures>,
    /// How much of the noise frames and neighbours share.
    pub correlation: Option<Correlation>,
}

/// How often a graph was run, and with which knob.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Variant {
    /// Value of the knob; `None` leaves the graph as written.
    pub knob: Option<f64>,
    /// Frames averaged.
    pub frames: u32,
    /// Median milliseconds.
    pub time_ms: f64,
    /// Share in the cell; the shares of a cell make 1.
    pub weight: f64,
}

/// Time of one pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PassShare {
    /// Its name; rounds of a repeated pass are `spatial.1`, `spatial.2`.
    pub pass: String,
    /// Median milliseconds in one frame.
    pub ms: f64,
    /// It counts: the image needs it.
    pub counted: bool,
}

/// One point of a curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Frames averaged (accumulate), or number of the frame (trace).
    pub frame: u32,
    /// Milliseconds until here (accumulate), or of this frame (trace).
    pub time_ms: f64,
    /// The same of every seed.
    #[serde(default)]
    pub times_ms: Vec<f64>,
    /// Seconds into the animation.
    pub animation_time: f32,
    /// Mean square error, the reference's variance taken out.
    pub mse: Summary,
    /// Relative mean square error; `None` where the reference is black.
    pub rel_mse: Option<Summary>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_survives_as_json() {
        let cell = Cell {
            variants: vec![Variant { knob: Some(4.0), frames: 1, time_ms: 2.0, weight: 1.0 }],
            mse: Summary::of(vec![1.0, 2.0, 4.0]),
            bias: Some(BiasFigures { verdict: BiasVerdict::NotResolved, ..BiasFigures::default() }),
            ..Cell::default()
        };
        let pair = Pair { better: Better::NotResolved, mse: Ratio { value: 1.5, interval: Some([0.5, 2.0]) }, ..Pair::default() };
        let scene = SceneResult { name: "cornell".into(), cells: vec![cell], pairs: vec![pair], ..SceneResult::default() };
        for protocol in [
            Protocol::Frame { warm_up: 32, seeds: 16, centred: true },
            Protocol::Trace { frames: 60, step: 1.0 / 30.0, seeds: 16, centred: false },
        ] {
            let report = Report { schema: SCHEMA, protocol, scenes: vec![scene.clone()], ..Report::default() };
            let text = serde_json::to_string_pretty(&report).unwrap();
            assert_eq!(serde_json::from_str::<Report>(&text).unwrap(), report);
        }
    }
}
