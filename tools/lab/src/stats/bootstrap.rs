//! Confidence intervals by resampling (Efron and Tibshirani 1993; Davison and Hinkley 1997).

use super::rng::SplitMix;
use statrs::distribution::{ContinuousCDF, Normal};
use std::fmt;

/// How interval ends are read off the resampled statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Their quantiles.
    Percentile,
    /// Quantiles corrected for bias and acceleration: the better choice for skewed statistics such as error ratios.
    Bca,
}

/// How to resample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bootstrap {
    /// How often. Ends of a 95 % interval settle at a few thousand.
    pub resamples: usize,
    /// Confidence, e.g. 0.95.
    pub level: f64,
    /// How ends are found.
    pub method: Method,
    /// Equal seeds give equal intervals.
    pub seed: u64,
}

impl Default for Bootstrap {
    fn default() -> Self {
        Self { resamples: 4000, level: 0.95, method: Method::Bca, seed: 0 }
    }
}

/// An estimate and the ends of its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The statistic of the data themselves.
    pub estimate: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(3);
        write!(f, "{:.digits$} ({:.digits$} … {:.digits$})", self.estimate, self.low, self.high)
    }
}

impl Bootstrap {
    /// Interval of a statistic of one sample.
    pub fn of(&self, values: &[f64], statistic: impl Fn(&[f64]) -> f64) -> Interval {
        self.of_indices(&[values.len()], |chosen| statistic(&gather(values, &chosen[0])))
    }

    /// Interval of a statistic of two independent samples, each resampled on its own.
    pub fn of_two(&self, a: &[f64], b: &[f64], statistic: impl Fn(&[f64], &[f64]) -> f64) -> Interval {
        self.of_indices(&[a.len(), b.len()], |chosen| statistic(&gather(a, &chosen[0]), &gather(b, &chosen[1])))
    }

    /// The general case: `sizes` are the sizes of independent samples, and `statistic` gets the chosen indices of each. Pairs stay pairs
    /// when one list of indices picks from both.
    pub fn of_indices(&self, sizes: &[usize], statistic: impl Fn(&[Vec<usize>]) -> f64) -> Interval {
        let all: Vec<Vec<usize>> = sizes.iter().map(|&n| (0..n).collect()).collect();
        let estimate = statistic(&all);
        if sizes.iter().any(|&n| n < 2) {
            return Interval { estimate, low: f64::NEG_INFINITY, high: f64::INFINITY };
        }
        let resampled = self.resample(sizes, &statistic);
        let tail = (1.0 - self.level) / 2.0;
        let [low, high] = match self.method {
            Method::Percentile => [tail, 1.0 - tail],
            Method::Bca => {
                let bias = bias(&resampled, estimate);
                let acceleration = acceleration(&all, &statistic);
                [tail, 1.0 - tail].map(|p| corrected(p, bias, acceleration))
            }
        }
        .map(|p| quantile(&resampled, p));
        Interval { estimate, low, high }
    }

    fn resample(&self, sizes: &[usize], statistic: &impl Fn(&[Vec<usize>]) -> f64) -> Vec<f64> {
        let mut rng = SplitMix::new(self.seed);
        let mut chosen: Vec<Vec<usize>> = sizes.iter().map(|&n| vec![0; n]).collect();
        let mut draw = || {
            for indices in &mut chosen {
                let n = indices.len();
                indices.iter_mut().for_each(|index| *index = rng.below(n));
            }
            statistic(&chosen)
        };
        let mut resampled: Vec<f64> = (0..self.resamples.max(1)).map(|_| draw()).collect();
        resampled.sort_by(f64::total_cmp);
        resampled
    }
}

/// The standard score of the share of resampled statistics below the estimate; ties count half.
fn bias(resampled: &[f64], estimate: f64) -> f64 {
    let n = resampled.len() as f64;
    let below = resampled.iter().filter(|&&x| x < estimate).count() as f64;
    let equal = resampled.iter().filter(|&&x| x == estimate).count() as f64;
    let share = ((below + 0.5 * equal) / n).clamp(0.5 / n, 1.0 - 0.5 / n);
    Normal::standard().inverse_cdf(share)
}

/// From the jackknife's influence values, for several samples (Davison and Hinkley 1997, equation 5.26).
fn acceleration(all: &[Vec<usize>], statistic: &impl Fn(&[Vec<usize>]) -> f64) -> f64 {
    let (mut squares, mut cubes) = (0.0, 0.0);
    for sample in 0..all.len() {
        let n = all[sample].len();
        let left_out: Vec<f64> = (0..n)
            .map(|i| {
                let mut rest = all.to_vec();
                rest[sample].remove(i);
                statistic(&rest)
            })
            .collect();
        let mean = left_out.iter().sum::<f64>() / n as f64;
        for value in left_out {
            let influence = (n - 1) as f64 * (mean - value) / n as f64;
            squares += influence.powi(2);
            cubes += influence.powi(3);
        }
    }
    if squares > 0.0 { cubes / (6.0 * squares.powf(1.5)) } else { 0.0 }
}

/// Which quantile stands for `p` after correction.
fn corrected(p: f64, bias: f64, acceleration: f64) -> f64 {
    let normal = Normal::standard();
    let shifted = bias + normal.inverse_cdf(p);
    normal.cdf(bias + shifted / (1.0 - acceleration * shifted))
}

/// Linear between order statistics, which must be sorted.
fn quantile(sorted: &[f64], p: f64) -> f64 {
    let place = p.clamp(0.0, 1.0) * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    if below == above { below } else { below + (above - below) * place.fract() }
}

fn gather(values: &[f64], indices: &[usize]) -> Vec<f64> {
    indices.iter().map(|&i| values[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::multiple::plausible_count;

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    #[test]
    fn equal_seeds_give_equal_intervals() {
        let values: Vec<f64> = (0..20).map(|i| f64::from(i).sin()).collect();
        let with = |seed| Bootstrap { resamples: 500, seed, ..Bootstrap::default() }.of(&values, mean);
        assert_eq!(with(1), with(1));
        assert_ne!(with(1), with(2));
    }

    #[test]
    fn degenerate_samples() {
        let constant = Bootstrap::default().of(&[2.0; 5], mean);
        assert_eq!(constant, Interval { estimate: 2.0, low: 2.0, high: 2.0 });
        assert_eq!(Bootstrap::default().of(&[2.0], mean).high, f64::INFINITY);
        assert_eq!(constant.to_string(), "2.000 (2.000 … 2.000)");
    }

    #[test]
    fn the_law_school_example() {
        // Efron and Tibshirani 1993, tables 3.1 and 14.2: correlation 0.776, 90 % BCa interval about (0.43, 0.92).
        let lsat = [576., 635., 558., 578., 666., 580., 555., 661., 651., 605., 653., 575., 545., 572., 594.];
        let gpa = [3.39, 3.30, 2.81, 3.03, 3.44, 3.07, 3.00, 3.43, 3.36, 3.13, 3.12, 2.74, 2.76, 2.88, 2.96];
        let correlation = |chosen: &[Vec<usize>]| {
            let (x, y) = (gather(&lsat, &chosen[0]), gather(&gpa, &chosen[0]));
            let (mx, my) = (mean(&x), mean(&y));
            let sum = |a: &[f64], ma: f64, b: &[f64], mb: f64| a.iter().zip(b).map(|(a, b)| (a - ma) * (b - mb)).sum::<f64>();
            sum(&x, mx, &y, my) / (sum(&x, mx, &x, mx) * sum(&y, my, &y, my)).sqrt()
        };
        let interval = Bootstrap { level: 0.9, ..Bootstrap::default() }.of_indices(&[15], correlation);
        assert!((interval.estimate - 0.776).abs() < 5e-4);
        assert!((interval.low - 0.43).abs() < 0.03 && (interval.high - 0.923).abs() < 0.015, "{interval}");
    }

    /// How many of 400 intervals for a ratio of two lognormal means hold the true ratio.
    fn covered(method: Method, seed: u64) -> u64 {
        let mut rng = SplitMix::new(seed);
        let mut sample = |median: f64| -> Vec<f64> { (0..32).map(|_| median * (0.5 * rng.normal()).exp()).collect() };
        let options = Bootstrap { resamples: 500, method, ..Bootstrap::default() };
        (0..400)
            .filter(|_| {
                let (a, b) = (sample(3.0), sample(1.0));
                let interval = options.of_two(&a, &b, |a, b| mean(a) / mean(b));
                interval.low <= 3.0 && 3.0 <= interval.high
            })
            .count() as u64
    }

    #[test]
    fn intervals_hold_the_truth_about_as_often_as_they_say() {
        // Bootstrap intervals of 32 skewed values cover a little less than their nominal 95 %.
        for method in [Method::Percentile, Method::Bca] {
            let covered = covered(method, 41);
            assert!(plausible_count(covered, 400, 0.95) || plausible_count(covered, 400, 0.93), "{method:?}: {covered}");
        }
    }
}
