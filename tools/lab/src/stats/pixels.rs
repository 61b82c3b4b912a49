//! Is an image still the one it was? A z-test for every pixel.

use super::{Difference, Estimate, SizesDiffer, multiple::sidak, same_size};
use crate::film::Film;

/// What a pixel-by-pixel test asks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelTest {
    /// Chance that any of all pixels fails by noise alone.
    pub alpha: f64,
    /// Share of pixels that must pass, since pixels are heavier-tailed than the normal distribution says.
    pub share: f64,
    /// Relative difference that is rounding, whatever the variance.
    pub rounding: f64,
}

impl Default for PixelTest {
    fn default() -> Self {
        Self { alpha: 0.01, share: 0.9975, rounding: 1e-5 }
    }
}

/// What a pixel-by-pixel test found.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelComparison {
    /// p-value of each pixel's most different channel.
    pub p: Vec<f64>,
    /// How many pixels fail.
    pub failed: usize,
    /// Enough pixels pass.
    pub passed: bool,
}

/// Why a pixel-by-pixel test cannot be made.
#[derive(Clone, Copy, Debug, thiserror::Error, PartialEq)]
pub enum PixelError {
    /// Different sizes.
    #[error(transparent)]
    Sizes(#[from] SizesDiffer),
    /// An image without variance.
    #[error("the {which} image holds no variance")]
    NoVariance {
        /// `new` or `old`.
        which: &'static str,
    },
}

/// Welch's t-test in every channel of every pixel, at Šidák's level for all of them. `counts` says from how many independent renders
/// or frames each variance was estimated.
pub fn compare_pixels(new: &Film, old: &Film, counts: [u64; 2], test: &PixelTest) -> Result<PixelComparison, PixelError> {
    same_size(new.size, old.size)?;
    let new_variance = new.variance.as_ref().ok_or(PixelError::NoVariance { which: "new" })?;
    let old_variance = old.variance.as_ref().ok_or(PixelError::NoVariance { which: "old" })?;
    let freedom = counts.map(|n| n.saturating_sub(1).max(1) as f64);
    let channel = |i: usize, c: usize| {
        let estimate = |film: &Film, variance: &[[f32; 3]], freedom| Estimate {
            mean: f64::from(film.color[i][c]),
            standard_error: f64::from(variance[i][c]).max(0.0).sqrt(),
            freedom,
        };
        p_of(estimate(new, new_variance, freedom[0]), estimate(old, old_variance, freedom[1]), test.rounding)
    };
    let p: Vec<f64> = (0..new.pixels()).map(|i| (0..3).map(|c| channel(i, c)).fold(1.0, f64::min)).collect();
    let level = sidak(test.alpha, 3 * p.len());
    let failed = p.iter().filter(|&&p| p <= level).count();
    let passed = (p.len() - failed) as f64 >= test.share * p.len() as f64;
    Ok(PixelComparison { p, failed, passed })
}

/// A channel that is not a number on one side only is different beyond doubt.
fn p_of(new: Estimate, old: Estimate, rounding: f64) -> f64 {
    if new.mean.is_nan() || old.mean.is_nan() {
        return if new.mean.is_nan() == old.mean.is_nan() { 1.0 } else { 0.0 };
    }
    let equal = new.mean == old.mean || (new.mean - old.mean).abs() <= rounding * old.mean.abs();
    if equal { 1.0 } else { Difference::welch(new, old).p_different() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{ensemble::Ensemble, rng::SplitMix};

    const SIZE: [u32; 2] = [40, 40];

    fn ensemble(rng: &mut SplitMix, change: impl Fn(usize) -> f64) -> Film {
        let mut ensemble = Ensemble::default();
        for _ in 0..32 {
            let color = (0..1600).map(|i| [0, 1, 2].map(|_| (1.0 + change(i) + 0.5 * rng.normal()) as f32)).collect();
            ensemble.push(&Film::new(SIZE, color).unwrap()).unwrap();
        }
        ensemble.film()
    }

    #[test]
    fn equal_expectations_pass_and_changed_ones_fail() {
        let mut rng = SplitMix::new(71);
        let old = ensemble(&mut rng, |_| 0.0);
        let test = PixelTest::default();
        let unchanged = compare_pixels(&ensemble(&mut rng, |_| 0.0), &old, [32, 32], &test).unwrap();
        assert!(unchanged.passed && unchanged.failed <= 1, "{}", unchanged.failed);
        // Ten of 1600 pixels change by 1.5, twelve standard errors of the difference.
        let changed = compare_pixels(&ensemble(&mut rng, |i| if i < 10 { 1.5 } else { 0.0 }), &old, [32, 32], &test).unwrap();
        assert!(!changed.passed && (9..=11).contains(&changed.failed), "{}", changed.failed);
    }

    #[test]
    fn exact_pixels_may_round_but_not_change() {
        let flat = |value: f32| Film { variance: Some(vec![[0.0; 3]; 1600]), ..Film::new(SIZE, vec![[value; 3]; 1600]).unwrap() };
        let compare = |a: f32, b: f32| compare_pixels(&flat(a), &flat(b), [32, 32], &PixelTest::default()).unwrap().failed;
        assert_eq!([compare(1.0, 1.0), compare(1.000_001, 1.0), compare(1.001, 1.0)], [0, 0, 1600]);
        assert_eq!([compare(f32::NAN, 1.0), compare(f32::NAN, f32::NAN), compare(f32::INFINITY, 1.0)], [1600, 0, 1600]);
        let bare = Film::new(SIZE, vec![[1.0; 3]; 1600]).unwrap();
        let error = compare_pixels(&bare, &flat(1.0), [32, 32], &PixelTest::default());
        assert_eq!(error, Err(PixelError::NoVariance { which: "new" }));
    }
}
