//! What came of one graph on one case.

use crate::{
    film::Film,
    stats::{Difference, Rule, Verdict},
};
use aquifer_render::PortCounts;
use serde::Serialize;
use std::fmt::Write as _;

/// Share of the mean by which an unbiased graph may be shown to differ.
const BAND: f64 = 0.05;
/// The same for a graph whose bias is labelled: less than this is its label's to tell of.
const LABELLED_BAND: f64 = 0.5;
/// One side of a test. A table of 400 rows raises a false alarm once in 25 tables.
const ALPHA: f64 = 1e-4;
/// Largest standard error, as a share of the band, with which a row counts as measured.
const RESOLUTION: f64 = 0.5;

/// One cell of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The case.
    pub case: String,
    /// The graph.
    pub graph: String,
    /// What is said of it.
    pub outcome: Outcome,
    /// The case names this graph among those that do not pass, for this reason.
    pub known: Option<String>,
    /// What speaks against it, or which limit forbids it; empty where it passed.
    pub why: String,
    /// `aquifer check` says that it is biased on this scene.
    pub labelled: bool,
    /// Independent runs.
    pub seeds: u64,
    /// Standard error of the truth's mean luminance, as a share of it.
    pub truth_error: f64,
    /// Mean luminance less the truth's, as a share of the truth's, of the last frames looked at.
    pub bias: Option<Share>,
    /// Mean luminance of the last frames less that of the first ones, as a share of the truth's; of still cases.
    pub drift: Option<Share>,
    /// The pixel that is farthest from the truth.
    pub worst_pixel: Option<Pixel>,
    /// Elements of all outputs of all passes over all frames.
    pub nan: u64,
    /// Likewise.
    pub infinite: u64,
    /// Frames after the change until nothing is shown to be wrong any more; of cases with a change.
    pub recovers_after: Option<u32>,
}

/// What is said of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Finite, and nothing is shown to be wrong where it could be.
    Passed,
    /// Something is.
    Failed,
    /// Noise hides too much.
    NotResolved,
    /// The adapter is too small, and says which limit and by how much.
    Limited,
    /// The scene is not taken, and the reason is told.
    Refused,
}

/// A share with its standard error and the degrees of freedom of that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// The share.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Of the standard error.
    pub freedom: f64,
}

/// A pixel that differs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pixel {
    /// Across and down.
    pub at: [u32; 2],
    /// Luminance less the truth's, as a share of the truth's mean.
    pub difference: f64,
}

/// What the page shows of a row.
#[derive(Clone, Debug)]
pub struct Pictures {
    /// Mean over the seeds.
    pub got: Film,
    /// The path tracer's.
    pub want: Film,
}

impl From<Difference> for Share {
    fn from(found: Difference) -> Self {
        // JSON has no infinity; beyond this the t distribution is the normal one.
        Share { value: found.value, standard_error: found.standard_error, freedom: found.freedom.min(1e9) }
    }
}

impl Share {
    /// Half a 95 % interval is two of these, nearly.
    fn difference(self) -> Difference {
        Difference { value: self.value, standard_error: self.standard_error, freedom: self.freedom }
    }

    /// Is it shown to be more than the band?
    pub fn is_outside(self, labelled: bool) -> bool {
        self.difference().judge(band(labelled), Rule::Exceeds { alpha: ALPHA }) == Verdict::Failed
    }

    /// Is it shown to be other than nothing, at this level?
    pub fn is_real(self, alpha: f64) -> bool {
        self.difference().p_different() <= alpha || self.value.is_nan()
    }

    /// Is it known well enough to be judged?
    pub fn is_resolved(self, labelled: bool) -> bool {
        self.standard_error <= RESOLUTION * band(labelled)
    }

    pub(super) fn percent(self) -> String {
        format!("{:+.2} % ± {:.2} %", 100.0 * self.value, 100.0 * self.standard_error)
    }
}

fn band(labelled: bool) -> f64 {
    if labelled { LABELLED_BAND } else { BAND }
}

impl Row {
    /// Judges what was measured.
    pub fn judge(&mut self, counts: &[PortCounts]) {
        self.nan = counts.iter().map(|counts| counts.nan).sum();
        self.infinite = counts.iter().map(|counts| counts.infinite).sum();
        let sick = counts.iter().find(|counts| counts.nan + counts.infinite > 0);
        // Where not even the truth is known, its error is no good guess either.
        let known = self.truth_error <= RESOLUTION * band(self.labelled);
        let outside = |share: &Option<Share>| share.filter(|share| known && share.is_outside(self.labelled));
        let (outcome, why) = match (sick, outside(&self.bias), outside(&self.drift)) {
            (Some(PortCounts { pass, port, .. }), ..) => (Outcome::Failed, format!("NaN or infinity, first in `{pass}.{port}`")),
            (_, Some(bias), _) => (Outcome::Failed, format!("bias {}", bias.percent())),
            (.., Some(drift)) => (Outcome::Failed, format!("drift {}", drift.percent())),
            _ if !known || self.bias.is_some_and(|bias| !bias.is_resolved(self.labelled)) => {
                (Outcome::NotResolved, "more seeds are needed to say".to_owned())
            }
            _ => (Outcome::Passed, String::new()),
        };
        (self.outcome, self.why) = (outcome, why);
    }

    /// Did it do what the case wants?
    pub fn is_good(&self) -> bool {
        matches!(self.outcome, Outcome::Passed | Outcome::Limited | Outcome::Refused)
    }

    /// The case's list of graphs that do not pass is right about this one.
    pub fn is_as_known(&self) -> bool {
        self.is_good() == self.known.is_none()
    }

    /// Few letters for a table.
    pub fn word(&self) -> &'static str {
        match (self.outcome, self.is_as_known()) {
            (_, false) if self.is_good() => "passes, but is listed",
            (_, true) if !self.is_good() => "known",
            (Outcome::Passed, _) => "pass",
            (Outcome::Failed, _) => "FAIL",
            (Outcome::NotResolved, _) => "not resolved",
            (Outcome::Limited, _) => "limit",
            (Outcome::Refused, _) => "refused",
        }
    }

    /// Everything of note, in a line.
    pub fn sentence(&self) -> String {
        let mut text = format!("{} on {}: {}", self.graph, self.case, self.word());
        if let Some(bias) = self.bias {
            let _ = write!(text, ", bias {}", bias.percent());
        }
        if let Some(drift) = self.drift {
            let _ = write!(text, ", drift {}", drift.percent());
        }
        if let Some(Pixel { at: [x, y], difference }) = self.worst_pixel {
            let _ = write!(text, ", worst pixel ({x}, {y}) {:+.1} % of the mean", 100.0 * difference);
        }
        if let Some(frames) = self.recovers_after {
            let _ = write!(text, ", right after {frames} frames");
        }
        let _ = write!(text, ", {} NaN, {} infinite, {} seeds", self.nan, self.infinite, self.seeds);
        if !self.why.is_empty() {
            let _ = write!(text, " ({})", self.why);
        }
        text
    }
}

/// One line a case, one column a graph.
pub fn table(rows: &[Row]) -> String {
    let distinct = |of: fn(&Row) -> &String| {
        let mut names: Vec<&str> = Vec::new();
        rows.iter().map(of).for_each(|name| {
            if !names.contains(&name.as_str()) {
                names.push(name)
            }
        });
        names
    };
    let (cases, graphs) = (distinct(|row| &row.case), distinct(|row| &row.graph));
    let cell = |case: &str, graph: &str| rows.iter().find(|row| row.case == case && row.graph == graph).map_or("", Row::word);
    let mut lines = vec![[&["case"], &graphs[..]].concat()];
    lines.extend(cases.iter().map(|&case| [&[case], &graphs.iter().map(|graph| cell(case, graph)).collect::<Vec<_>>()[..]].concat()));
    let width = |column: usize| lines.iter().map(|line| line[column].len()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..=graphs.len()).map(width).collect();
    let line = |cells: &Vec<&str>| {
        let padded: Vec<String> = cells.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        padded.join("  ").trim_end().to_owned()
    };
    lines.iter().map(line).collect::<Vec<_>>().join("\n")
}
