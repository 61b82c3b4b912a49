//! Many tests at once.

use statrs::distribution::{Binomial, DiscreteCDF};

/// Holm's step-down procedure (1979): which null hypotheses fall when the chance of any false rejection is to stay below `alpha`.
/// NaN counts as 1.
pub fn holm(p: &[f64], alpha: f64) -> Vec<bool> {
    adjusted(p).into_iter().map(|p| p <= alpha).collect()
}

/// Holm-adjusted p-values, in the order given: each may be compared with the family's α.
pub fn adjusted(p: &[f64]) -> Vec<f64> {
    let known = |i: usize| if p[i].is_nan() { 1.0 } else { p[i] };
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| known(a).total_cmp(&known(b)));
    let mut adjusted = vec![1.0; p.len()];
    let mut largest = 0.0_f64;
    for (rank, &i) in order.iter().enumerate() {
        largest = largest.max(known(i) * (p.len() - rank) as f64).min(1.0);
        adjusted[i] = largest;
    }
    adjusted
}

/// Šidák's level for each of `tests` independent tests such that the chance of any false rejection is `alpha`.
pub fn sidak(alpha: f64, tests: usize) -> f64 {
    // 1 − (1 − α)^(1/n), without the cancellation.
    -((-alpha).ln_1p() / tests.max(1) as f64).exp_m1()
}

/// Could `count` of `trials` be chance, when each succeeds with probability `rate`? Tails of 10⁻⁴ on both sides are not.
pub fn plausible_count(count: u64, trials: u64, rate: f64) -> bool {
    let Ok(binomial) = Binomial::new(rate, trials) else { return false };
    let at_least = if count == 0 { 1.0 } else { binomial.sf(count - 1) };
    binomial.cdf(count) > 1e-4 && at_least > 1e-4
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{Difference, rng::SplitMix};

    #[test]
    fn the_adjustment_of_a_worked_example() {
        // R: p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm") = 0.03 0.06 0.06 0.02.
        let found = adjusted(&[0.01, 0.04, 0.03, 0.005]);
        for (found, want) in found.iter().zip([0.03, 0.06, 0.06, 0.02]) {
            assert!((found - want).abs() < 1e-12);
        }
        assert_eq!(holm(&[0.01, 0.04, 0.03, 0.005, f64::NAN], 0.05), [true, false, false, true, false]);
    }

    #[test]
    fn any_false_alarm_among_many_is_as_rare_as_stated() {
        let mut rng = SplitMix::new(21);
        let (mut by_holm, mut by_sidak) = (0, 0);
        for _ in 0..2000 {
            let p: Vec<f64> = (0..40).map(|_| Difference::normal(rng.normal(), 1.0).p_different()).collect();
            by_holm += u64::from(holm(&p, 0.05).contains(&true));
            by_sidak += u64::from(p.iter().any(|&p| p <= sidak(0.05, 40)));
        }
        // Bonferroni's level for the smallest p: 1 − (1 − 0.05/40)⁴⁰ = 0.0488.
        assert!(plausible_count(by_holm, 2000, 0.0488), "{by_holm}");
        assert!(plausible_count(by_sidak, 2000, 0.05), "{by_sidak}");
    }

    #[test]
    fn one_planted_difference_is_found_among_many() {
        // Shift of 5 se against the level 0.05/40: Φ(5 − 3.2272) = 0.9619.
        let mut rng = SplitMix::new(22);
        let found = (0..2000).filter(|_| {
            let mut p: Vec<f64> = (0..39).map(|_| Difference::normal(rng.normal(), 1.0).p_different()).collect();
            p.push(Difference::normal(5.0 + rng.normal(), 1.0).p_different());
            holm(&p, 0.05)[39]
        });
        let found = found.count() as u64;
        assert!(plausible_count(found, 2000, 0.9619), "{found}");
    }

    #[test]
    fn sidak_is_exact_where_floats_would_cancel() {
        assert!((sidak(0.01, 1) - 0.01).abs() < 1e-15);
        assert!((sidak(0.01, 1_000_000) - 1.005_033_58e-8).abs() < 1e-15);
    }

    #[test]
    fn counts() {
        assert!(plausible_count(0, 10, 0.05) && plausible_count(50, 1000, 0.05));
        assert!(!plausible_count(100, 1000, 0.05) && !plausible_count(0, 1000, 0.05));
    }
}
