//! One difference of two means: is it real, is it small enough, or can neither be said?

use super::Moments;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use std::fmt;

/// A mean with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Of the mean.
    pub standard_error: f64,
    /// Degrees of freedom of the standard error; infinite where it is as good as known.
    pub freedom: f64,
}

impl From<&Moments> for Estimate {
    fn from(moments: &Moments) -> Self {
        let freedom = moments.count().saturating_sub(1) as f64;
        Self { mean: moments.mean(), standard_error: moments.standard_error(), freedom }
    }
}

/// An estimated difference with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Ours less the reference's.
    pub value: f64,
    /// Of `value`.
    pub standard_error: f64,
    /// Degrees of freedom of the standard error; infinite where it is as good as known.
    pub freedom: f64,
}

impl Difference {
    /// Whose standard error is as good as known: each side is a mean of very many samples.
    pub fn normal(value: f64, standard_error: f64) -> Self {
        Self { value, standard_error, freedom: f64::INFINITY }
    }

    /// Of two independent samples of unequal variances (Welch 1947, with Satterthwaite's degrees of freedom).
    pub fn welch(ours: impl Into<Estimate>, reference: impl Into<Estimate>) -> Self {
        let (ours, reference) = (ours.into(), reference.into());
        let (a, b) = (ours.standard_error.powi(2), reference.standard_error.powi(2));
        let freedom = (a + b).powi(2) / (a * a / ours.freedom + b * b / reference.freedom);
        Self {
            value: ours.mean - reference.mean,
            standard_error: (a + b).sqrt(),
            // Without any error, or with known errors on both sides, the t distribution is the normal one.
            freedom: if freedom.is_nan() { f64::INFINITY } else { freedom },
        }
    }

    /// In units of `scale`. Nothing stays nothing, even in units of nothing.
    pub fn relative_to(self, scale: f64) -> Self {
        let divide = |x: f64| if x == 0.0 { 0.0 } else { x / scale.abs() };
        Self { value: divide(self.value), standard_error: divide(self.standard_error), ..self }
    }

    /// Distance from `centre` in standard errors. Equal values without error are at 0, others infinitely far.
    pub fn score(&self, centre: f64) -> f64 {
        let distance = self.value - centre;
        if distance == 0.0 { 0.0 } else { distance / self.standard_error }
    }

    /// Two-sided p-value of "there is no difference": the z-test, or the t-test where `freedom` is finite.
    pub fn p_different(&self) -> f64 {
        (2.0 * self.upper_tail(self.score(0.0).abs())).min(1.0)
    }

    /// p-value of "the difference is `band` or more": small means that equivalence is shown (two one-sided tests, Schuirmann 1987).
    pub fn p_equivalent(&self, band: f64) -> f64 {
        let (below, above) = (self.upper_tail(self.score(-band)), self.upper_tail(-self.score(band)));
        below.max(above)
    }

    /// p-value of "the difference is within `band`": small means that it is shown to be more.
    pub fn p_outside(&self, band: f64) -> f64 {
        let excess = self.value.abs() - band;
        self.upper_tail(if excess == 0.0 { 0.0 } else { excess / self.standard_error })
    }

    /// Judges the difference against `band`.
    pub fn judge(&self, band: f64, rule: Rule) -> Verdict {
        self.judge_by(band, rule, self.p_outside(band), self.p_equivalent(band))
    }

    /// As [`Difference::judge`], with p-values that were adjusted because the difference is one of many.
    pub fn judge_by(&self, band: f64, rule: Rule, p_outside: f64, p_equivalent: f64) -> Verdict {
        if self.value.is_nan() {
            return Verdict::Failed;
        }
        if self.standard_error.is_nan() {
            return Verdict::NotResolved;
        }
        let inside = self.value.abs() <= band;
        match rule {
            Rule::Estimate if inside => Verdict::Passed,
            Rule::Estimate => Verdict::Failed,
            Rule::Exceeds { alpha } if p_outside <= alpha => Verdict::Failed,
            Rule::Exceeds { .. } => Verdict::Passed,
            Rule::Inside { .. } if inside => Verdict::Passed,
            Rule::Inside { alpha } if p_outside <= alpha => Verdict::Failed,
            Rule::Inside { .. } => Verdict::NotResolved,
            Rule::Equivalent { alpha } if p_equivalent <= alpha => Verdict::Passed,
            Rule::Equivalent { alpha } if p_outside <= alpha => Verdict::Failed,
            Rule::Equivalent { .. } => Verdict::NotResolved,
        }
    }

    /// Probability of a standard score above `score`; of a score that is no number there is none.
    fn upper_tail(&self, score: f64) -> f64 {
        if score.is_nan() {
            return f64::NAN;
        }
        if score.is_infinite() {
            return if score > 0.0 { 0.0 } else { 1.0 };
        }
        if self.freedom.is_finite() {
            StudentsT::new(0.0, 1.0, self.freedom.max(1.0)).expect("location 0, scale 1 and freedom ≥ 1 are valid").sf(score)
        } else {
            Normal::standard().sf(score)
        }
    }
}

/// The largest standard error at which two means without a difference are shown equivalent within `band` nearly always (95 % at
/// α = 0.05): band / 3.3, of which 1.645 are for each of the two risks.
pub fn largest_error(band: f64) -> f64 {
    band / 3.3
}

/// When a difference counts as within its band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// When the estimate is. For differences whose standard error was required to be small against the band beforehand.
    Estimate,
    /// Unless it is shown to be outside at `alpha`. Lenient: noise passes, so resolution must be required beside it.
    Exceeds {
        /// Significance level.
        alpha: f64,
    },
    /// When the estimate is; it fails when it is shown to be outside at `alpha`. An estimate outside by what may be noise is not resolved: of many
    /// estimates some are, and more samples tell.
    Inside {
        /// Significance level.
        alpha: f64,
    },
    /// Only when it is shown to be inside at `alpha` (equivalence). Strict: between shown inside and shown outside it is not resolved.
    Equivalent {
        /// Significance level.
        alpha: f64,
    },
}

/// What a comparison says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The difference is small enough.
    Passed,
    /// It is not.
    Failed,
    /// More samples are needed to say.
    NotResolved,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Passed => "passed",
            Self::Failed => "failed",
            Self::NotResolved => "not resolved",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{multiple::plausible_count, rng::SplitMix};

    fn sample(rng: &mut SplitMix, n: usize, mean: f64, deviation: f64) -> Moments {
        (0..n).map(|_| mean + deviation * rng.normal()).collect()
    }

    fn rejections(trials: u64, seed: u64, mut reject: impl FnMut(&mut SplitMix) -> bool) -> u64 {
        let mut rng = SplitMix::new(seed);
        (0..trials).filter(|_| reject(&mut rng)).count() as u64
    }

    #[test]
    fn textbook_values() {
        assert!((Difference::normal(1.959_963_985, 1.0).p_different() - 0.05).abs() < 1e-9);
        assert!((Difference { value: 2.228_138_852, standard_error: 1.0, freedom: 10.0 }.p_different() - 0.05).abs() < 1e-8);
        // Welch's own example, as in R: t.test(c(1,2,3,4,5), c(2,4,6,8,10)) gives t = -1.8974, df = 5.8824, p = 0.1075.
        let (a, b) = (Moments::from_iter([1.0, 2.0, 3.0, 4.0, 5.0]), Moments::from_iter([2.0, 4.0, 6.0, 8.0, 10.0]));
        let welch = Difference::welch(&a, &b);
        assert!((welch.score(0.0) + 1.897_367).abs() < 1e-6 && (welch.freedom - 5.882_353).abs() < 1e-6);
        assert!((welch.p_different() - 0.107_531).abs() < 1e-5, "{}", welch.p_different());
    }

    #[test]
    fn exact_values_need_no_error() {
        let equal = Difference::normal(0.0, 0.0);
        assert_eq!((equal.p_different(), equal.p_equivalent(0.1)), (1.0, 0.0));
        let apart = Difference::normal(0.2, 0.0);
        assert_eq!((apart.p_different(), apart.p_equivalent(0.1), apart.p_outside(0.1)), (0.0, 1.0, 0.0));
        assert_eq!(Difference::normal(f64::NAN, 1.0).judge(1.0, Rule::Estimate), Verdict::Failed);
        for rule in [Rule::Estimate, Rule::Exceeds { alpha: 0.05 }, Rule::Inside { alpha: 0.05 }, Rule::Equivalent { alpha: 0.05 }] {
            let [nowhere, unknown] = [(f64::NAN, 1.0), (2.0, f64::NAN)]
                .map(|(value, standard_error)| Difference { value, standard_error, freedom: 3.0 }.judge(1.0, rule));
            assert_eq!([nowhere, unknown], [Verdict::Failed, Verdict::NotResolved], "{rule:?}");
        }
    }

    #[test]
    fn welch_rejects_true_nulls_at_its_level() {
        let rate = rejections(4000, 11, |rng| {
            let (a, b) = (sample(rng, 8, 1.0, 1.0), sample(rng, 24, 1.0, 3.0));
            Difference::welch(&a, &b).p_different() <= 0.05
        });
        assert!(plausible_count(rate, 4000, 0.05), "{rate} of 4000");
    }

    #[test]
    fn z_test_finds_what_it_should() {
        // Power of a two-sided test at α = 0.05 against a shift of 3 standard errors: Φ(3 − 1.96) = 0.8508.
        let found = rejections(4000, 12, |rng| Difference::normal(3.0 + rng.normal(), 1.0).p_different() <= 0.05);
        assert!(plausible_count(found, 4000, 0.8508), "{found} of 4000");
        let false_alarms = rejections(4000, 13, |rng| Difference::normal(rng.normal(), 1.0).p_different() <= 0.05);
        assert!(plausible_count(false_alarms, 4000, 0.05), "{false_alarms} of 4000");
    }

    #[test]
    fn equivalence_is_claimed_wrongly_no_more_often_than_alpha() {
        // The true difference is at the edge of the band, the worst case.
        let wrong = rejections(4000, 14, |rng| {
            Difference::normal(1.0 + 0.3 * rng.normal(), 0.3).judge(1.0, Rule::Equivalent { alpha: 0.05 }) == Verdict::Passed
        });
        assert!(plausible_count(wrong, 4000, 0.05), "{wrong} of 4000");
    }

    #[test]
    fn equivalence_is_shown_at_the_stated_error() {
        // se = band/3.3, no difference: passes when |z| < 3.3 − 1.645, i.e. with probability 2 Φ(1.655) − 1 = 0.9021.
        let se = largest_error(1.0);
        let shown = rejections(4000, 15, |rng| {
            Difference::normal(se * rng.normal(), se).judge(1.0, Rule::Equivalent { alpha: 0.05 }) == Verdict::Passed
        });
        assert!(plausible_count(shown, 4000, 0.9021), "{shown} of 4000");
    }

    #[test]
    fn too_noisy_is_neither_passed_nor_failed() {
        let noisy = Difference::normal(0.0, 1.0);
        assert_eq!(noisy.judge(1.0, Rule::Equivalent { alpha: 0.05 }), Verdict::NotResolved);
        assert_eq!(noisy.judge(1.0, Rule::Exceeds { alpha: 0.05 }), Verdict::Passed);
        let judged_inside = |value| Difference::normal(value, 1.0).judge(1.0, Rule::Inside { alpha: 0.05 });
        assert_eq!([0.9, 1.5, 5.0].map(judged_inside), [Verdict::Passed, Verdict::NotResolved, Verdict::Failed]);
        assert_eq!(Difference::normal(5.0, 1.0).judge(1.0, Rule::Exceeds { alpha: 0.05 }), Verdict::Failed);
        assert_eq!(Difference::normal(5.0, 1.0).judge(1.0, Rule::Equivalent { alpha: 0.05 }), Verdict::Failed);
    }
}
