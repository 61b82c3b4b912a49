//! Two graphs against each other.

use serde::{Deserialize, Serialize};

/// One graph against another at equal time, as near as it goes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Index into [`super::SceneResult::cells`]: the baseline.
    pub baseline: usize,
    /// Likewise: what is held against it.
    pub other: usize,
    /// Time of the other over the baseline's.
    pub time: Ratio,
    /// `time` is within 5 % of 1.
    pub equal_time: bool,
    /// MSE of the baseline over the other's: above 1 the other is better.
    pub mse: Ratio,
    /// The same of relMSE; `None` where the reference is black.
    pub rel_mse: Option<Ratio>,
    /// Error × time of the baseline over the other's: what `mse` would be at equal time if variance fell as 1/time. Differs from `mse` only
    /// where times do.
    pub mse_time: Ratio,
    /// p-value of "both have the same error" (two-sided rank-sum test over seeds), adjusted for all pairs of the report (Holm).
    pub p: f64,
    /// Who has less error, as far as can be told.
    pub better: Better,
    /// The result in words.
    pub sentence: String,
}

/// A ratio with its 95 % bootstrap interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ratio {
    /// Of medians.
    pub value: f64,
    /// `None` with fewer than two seeds.
    pub interval: Option<[f64; 2]>,
}

/// Who has less error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// The baseline.
    Baseline,
    /// The other.
    Other,
    /// Chance could explain the difference.
    #[default]
    NotResolved,
}
