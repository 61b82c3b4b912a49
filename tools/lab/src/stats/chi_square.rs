//! Do counts follow a distribution?

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// The fewest expected counts a bin may have: below it the statistic is not χ² distributed.
pub const LEAST_EXPECTED: f64 = 5.0;

/// Result of a goodness-of-fit test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoodnessOfFit {
    /// Pearson's Σ (observed − expected)² / expected.
    pub statistic: f64,
    /// Degrees of freedom.
    pub freedom: u64,
    /// Bins left after pooling.
    pub bins: usize,
    /// Probability of a statistic this large when the counts do follow the distribution.
    pub p: f64,
}

/// Why a goodness-of-fit test cannot be made.
#[derive(Clone, Copy, Debug, thiserror::Error, PartialEq)]
pub enum FitError {
    /// One list is longer than the other.
    #[error("{observed} observed bins, {expected} expected ones")]
    Lengths {
        /// Observed bins.
        observed: usize,
        /// Expected bins.
        expected: usize,
    },
    /// An expectation is negative or not finite.
    #[error("bin {bin} expects {value} counts")]
    Expectation {
        /// Which bin.
        bin: usize,
        /// What it expects.
        value: f64,
    },
    /// Something was seen where nothing can be.
    #[error("bin {bin} expects nothing, but holds {count}")]
    Impossible {
        /// Which bin.
        bin: usize,
        /// What it holds.
        count: u64,
    },
    /// Too few bins are left after pooling.
    #[error("only {bins} bins expect {LEAST_EXPECTED} counts or more: draw more samples")]
    TooFewBins {
        /// How many.
        bins: usize,
    },
}

/// Pearson's χ² test. Bins that expect fewer than [`LEAST_EXPECTED`] are pooled, the rarest first; `fitted` is how many parameters of the
/// distribution were estimated from the counts. Counts where exactly nothing is expected are an error, whatever their number.
pub fn goodness_of_fit(observed: &[u64], expected: &[f64], fitted: u64) -> Result<GoodnessOfFit, FitError> {
    check(observed, expected)?;
    let bins = pool(observed, expected);
    let freedom = (bins.len() as u64).saturating_sub(1 + fitted);
    if freedom == 0 {
        return Err(FitError::TooFewBins { bins: bins.len() });
    }
    let statistic = bins.iter().map(|&(seen, expected)| (seen - expected).powi(2) / expected).sum();
    let p = ChiSquared::new(freedom as f64).expect("the degrees of freedom are positive").sf(statistic);
    Ok(GoodnessOfFit { statistic, freedom, bins: bins.len(), p })
}

fn check(observed: &[u64], expected: &[f64]) -> Result<(), FitError> {
    if observed.len() != expected.len() {
        return Err(FitError::Lengths { observed: observed.len(), expected: expected.len() });
    }
    for (bin, (&count, &value)) in observed.iter().zip(expected).enumerate() {
        if !value.is_finite() || value < 0.0 {
            return Err(FitError::Expectation { bin, value });
        }
        if value == 0.0 && count > 0 {
            return Err(FitError::Impossible { bin, count });
        }
    }
    Ok(())
}

/// (observed, expected) of bins that each expect enough.
fn pool(observed: &[u64], expected: &[f64]) -> Vec<(f64, f64)> {
    let mut bins: Vec<(f64, f64)> = observed.iter().zip(expected).map(|(&o, &e)| (o as f64, e)).filter(|bin| bin.1 > 0.0).collect();
    bins.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut pooled = Vec::new();
    let mut open = (0.0, 0.0);
    for (seen, expected) in bins {
        open = (open.0 + seen, open.1 + expected);
        if open.1 >= LEAST_EXPECTED {
            pooled.push(std::mem::take(&mut open));
        }
    }
    match pooled.last_mut() {
        Some(last) => *last = (last.0 + open.0, last.1 + open.1),
        None => pooled.push(open),
    }
    pooled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{multiple::plausible_count, rng::SplitMix};

    #[test]
    fn a_worked_example() {
        // Die thrown 60 times; R: chisq.test(c(5,8,9,8,10,20)) gives X² = 13.4, df = 5, p = 0.01991.
        let test = goodness_of_fit(&[5, 8, 9, 8, 10, 20], &[10.0; 6], 0).unwrap();
        assert!((test.statistic - 13.4).abs() < 1e-12 && test.freedom == 5);
        assert!((test.p - 0.019_91).abs() < 1e-5, "{}", test.p);
    }

    #[test]
    fn rare_bins_are_pooled() {
        let test = goodness_of_fit(&[2, 1, 3, 50, 44], &[2.0, 2.0, 2.0, 47.0, 47.0], 0).unwrap();
        assert_eq!((test.bins, test.freedom), (3, 2));
        let leftover = goodness_of_fit(&[60, 50, 1], &[60.0, 50.0, 1.0], 0).unwrap();
        assert_eq!((leftover.bins, leftover.statistic), (2, 0.0));
    }

    #[test]
    fn what_cannot_be_tested_is_said() {
        assert_eq!(goodness_of_fit(&[1], &[1.0, 2.0], 0), Err(FitError::Lengths { observed: 1, expected: 2 }));
        assert_eq!(goodness_of_fit(&[10, 1], &[11.0, 0.0], 0), Err(FitError::Impossible { bin: 1, count: 1 }));
        assert_eq!(goodness_of_fit(&[3, 3], &[3.0, 3.0], 0), Err(FitError::TooFewBins { bins: 1 }));
        assert!(matches!(goodness_of_fit(&[3, 3], &[3.0, f64::NAN], 0), Err(FitError::Expectation { bin: 1, .. })));
    }

    /// Of 1000 tests at α = 0.05 of 2000 draws from 20 bins whose first has `weight` times its share: how many reject?
    fn rejections(weight: f64, seed: u64) -> u64 {
        let mut rng = SplitMix::new(seed);
        let reject = |_: &usize| {
            let mut counts = [0_u64; 20];
            for _ in 0..2000 {
                let x = rng.uniform() * (19.0 + weight);
                counts[if x < weight { 0 } else { (1.0 + x - weight) as usize }] += 1;
            }
            goodness_of_fit(&counts, &[100.0; 20], 0).is_ok_and(|test| test.p <= 0.05)
        };
        (0..1000).filter(reject).count() as u64
    }

    #[test]
    fn level_and_power() {
        let false_alarms = rejections(1.0, 31);
        assert!(plausible_count(false_alarms, 1000, 0.05), "{false_alarms}");
        // A bin 1.5 times as likely as it should be: noncentrality 22.61, power 0.847 with 19 degrees of freedom.
        let found = rejections(1.5, 32);
        assert!(plausible_count(found, 1000, 0.847), "{found}");
    }
}
