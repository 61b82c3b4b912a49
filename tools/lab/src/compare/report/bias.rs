//! Bias and correlation of one graph.

use serde::{Deserialize, Serialize};

/// The error of one render split into bias and variance, over independent seeds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BiasFigures {
    /// Independent renders.
    pub seeds: u64,
    /// Squared distance of the expected image from the truth; may come out below zero by chance.
    pub bias_squared: f64,
    /// 95 % interval of `bias_squared`.
    pub bias_squared_interval: Option<[f64; 2]>,
    /// Variance of one render.
    pub variance: f64,
    /// 95 % interval of `variance`.
    pub variance_interval: Option<[f64; 2]>,
    /// Mean luminance over the reference's, less one.
    pub mean_difference: f64,
    /// Standard error of `mean_difference`.
    pub mean_error: f64,
    /// The largest relative difference that counts as none.
    pub band: f64,
    /// The equivalence test's word on `mean_difference`.
    pub verdict: BiasVerdict,
    /// Share of pixels whose t-test rejects "no bias" at 1 %: 1 % by chance alone.
    pub pixels_rejected: f64,
    /// Per-pixel t values, as an EXR file.
    pub t_map: Option<String>,
}

/// What the equivalence test says (two one-sided tests at 5 %).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BiasVerdict {
    /// Shown to be within the band.
    Unbiased,
    /// Shown to be outside.
    Biased,
    /// More seeds are needed to say.
    #[default]
    NotResolved,
}

/// How much of the noise is shared.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Correlation {
    /// Between a frame and the one 1, 2, … frames later: covariance over variance.
    pub temporal: Vec<f64>,
    /// Between a pixel and those 1, 2, … pixels away, across and down.
    pub spatial: Vec<f64>,
    /// Mean absolute difference between successive frames, relative to the mean.
    pub flicker: f64,
    /// Variance of one frame over N times the variance of the mean of N: 1 for independent frames, less where frames share noise.
    pub accumulation_gain: Vec<(u32, f64)>,
}
