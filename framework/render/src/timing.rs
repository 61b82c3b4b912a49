//! How long passes take.

use serde::Serialize;
use std::{collections::VecDeque, time::Duration};

/// Samples that a median looks back on.
const WINDOW: usize = 1024;

/// Who held the watch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Clock {
    /// The device, at the beginning and the end of each pass.
    Timestamps,
    /// The host, which waited for each pass: submission and waiting are counted too.
    Wall,
}

/// Times of all passes since the renderer was built, its first frame left out: drivers compile then.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Timings {
    /// Who measured.
    pub clock: Clock,
    /// In order of execution.
    pub passes: Vec<PassTime>,
    /// Frames measured.
    pub frames: u64,
    /// Samples thrown away because their end came before their beginning.
    pub dropped: u64,
}

/// Time of one pass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassTime {
    /// Name in the graph file.
    pub pass: String,
    /// Median of the latest samples, in milliseconds; `None` before the first.
    pub median_ms: Option<f64>,
    /// Of the latest frame, in milliseconds.
    pub latest_ms: Option<f64>,
}

/// How long the way to the first picture took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Startup {
    /// Linking, validating and reflecting shaders.
    pub compose: Duration,
    /// Making pipelines.
    pub pipelines: Duration,
    /// Allocating and clearing memory.
    pub memory: Duration,
    /// The first frame from its beginning to its end, with what the driver compiles late.
    pub first_frame: Option<Duration>,
}

/// Collects samples.
#[derive(Debug)]
pub(crate) struct Stopwatch {
    clock: Clock,
    names: Vec<String>,
    samples: Vec<VecDeque<f64>>,
    frames: u64,
    dropped: u64,
}

impl Stopwatch {
    pub fn new(clock: Clock, names: Vec<String>) -> Self {
        Stopwatch { clock, samples: vec![VecDeque::new(); names.len()], names, frames: 0, dropped: 0 }
    }

    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// One frame's passes, in nanoseconds from beginning to end.
    pub fn frame(&mut self, times: impl IntoIterator<Item = Option<f64>>) {
        self.frames += 1;
        for (samples, time) in self.samples.iter_mut().zip(times) {
            let Some(nanoseconds) = time else {
                self.dropped += 1;
                continue;
            };
            if samples.len() == WINDOW {
                samples.pop_front();
            }
            samples.push_back(nanoseconds * 1e-6);
        }
    }

    pub fn timings(&self) -> Timings {
        let pass = |(name, samples): (&String, &VecDeque<f64>)| PassTime {
            pass: name.clone(),
            median_ms: median(samples.iter().copied().collect()),
            latest_ms: samples.back().copied(),
        };
        Timings {
            clock: self.clock,
            passes: self.names.iter().zip(&self.samples).map(pass).collect(),
            frames: self.frames,
            dropped: self.dropped,
        }
    }
}

/// Pairs of ticks as nanoseconds; `None` where the end comes before the beginning.
pub(crate) fn elapsed(ticks: &[u64], nanoseconds_per_tick: f64) -> impl Iterator<Item = Option<f64>> {
    ticks.chunks_exact(2).map(move |pair| Some(pair[1].checked_sub(pair[0])? as f64 * nanoseconds_per_tick))
}

fn median(mut samples: Vec<f64>) -> Option<f64> {
    samples.sort_by(f64::total_cmp);
    let upper = *samples.get(samples.len() / 2)?;
    let lower = samples[(samples.len() - 1) / 2];
    Some(0.5 * (lower + upper))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_of_odd_even_and_no_samples() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
    }

    #[test]
    fn a_sample_that_runs_backwards_is_dropped_and_counted() {
        let mut watch = Stopwatch::new(Clock::Timestamps, vec!["a".into(), "b".into()]);
        watch.frame(elapsed(&[10, 30, 50, 40], 1e5));
        watch.frame(elapsed(&[10, 20, 40, 50], 1e5));
        let timings = watch.timings();
        assert_eq!((timings.frames, timings.dropped), (2, 1));
        assert_eq!(timings.passes[0].median_ms, Some(1.5));
        assert_eq!(timings.passes[1].median_ms, Some(1.0));
        assert_eq!(timings.passes[0].latest_ms, Some(1.0));
    }
}
