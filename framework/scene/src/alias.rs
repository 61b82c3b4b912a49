//! Sampling from a list of weights in constant time.

use bytemuck::{Pod, Zeroable};

/// Steps of the thresholds: one for each value of a random number with 24 bits, so that the stored probabilities are those sampled.
const STEPS: f64 = (1 << 24) as f64;

/// Alias table (Vose, "A linear algorithm for generating random numbers with a given distribution", 1991).
///
/// With `u1`, `u2` uniform in \[0, 1): `i = floor(u1 · len)`, then `i` when `u2 < threshold[i]`, else `alias[i]`. `u2` must have 24 random
/// bits; taking the fraction of `u1 · len` for it would leave too few of them in a long table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AliasTable {
    /// One a weight; empty when no weight is positive.
    pub entries: Vec<AliasEntry>,
}

/// One column of the table, 16 bytes, as shaders read it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AliasEntry {
    /// Probability of staying, a multiple of 2⁻²⁴.
    pub threshold: f32,
    /// Where to go otherwise.
    pub alias: u32,
    /// Probability that this index is drawn at all, of the table as quantised.
    pub pmf: f32,
    /// `pmf` of the alias, to save a read.
    pub alias_pmf: f32,
}

impl AliasTable {
    /// From weights, of which those that are not finite and positive count as 0. An index with positive weight has positive probability,
    /// one with weight 0 is never drawn.
    pub fn new(weights: &[f64]) -> AliasTable {
        let weight = |&w: &f64| if w.is_finite() && w > 0.0 { w } else { 0.0 };
        let largest = weights.iter().map(weight).fold(0.0, f64::max);
        if largest == 0.0 {
            return AliasTable::default();
        }
        // Against the largest, so that the sum cannot overflow.
        let weights: Vec<f64> = weights.iter().map(|w| weight(w) / largest).collect();
        let columns = balance(&weights);
        let pmf = probabilities(&columns);
        let entry = |(index, &(threshold, alias)): (usize, &(f64, u32))| AliasEntry {
            threshold: threshold as f32,
            alias,
            pmf: pmf[index] as f32,
            alias_pmf: pmf[alias as usize] as f32,
        };
        AliasTable { entries: columns.iter().enumerate().map(entry).collect() }
    }

    /// How many weights it was made of; 0 when none was positive.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Nothing can be drawn.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The index drawn by two numbers in \[0, 1), or `None` from an empty table.
    pub fn sample(&self, u1: f32, u2: f32) -> Option<u32> {
        let last = self.entries.len().checked_sub(1)?;
        let index = ((u1 * self.entries.len() as f32) as usize).min(last);
        let entry = &self.entries[index];
        Some(if u2 < entry.threshold { index as u32 } else { entry.alias })
    }
}

/// Vose's two work lists; gives (threshold, alias) for every column.
fn balance(weights: &[f64]) -> Vec<(f64, u32)> {
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    let mut left: Vec<f64> = weights.iter().map(|weight| weight / mean).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..weights.len()).partition(|&index| left[index] < 1.0);
    let heaviest = (0..weights.len()).fold(0, |best, index| if weights[index] > weights[best] { index } else { best });
    let mut columns = vec![(1.0, heaviest as u32); weights.len()];
    while let (Some(&low), Some(&high)) = (small.last(), large.last()) {
        small.pop();
        columns[low] = (quantised(left[low], weights[low]), high as u32);
        left[high] -= 1.0 - left[low];
        if left[high] < 1.0 {
            large.pop();
            small.push(high);
        }
    }
    // Rounding leaves some columns over that ought to be full; one without weight must still never be drawn.
    for index in small.into_iter().chain(large).filter(|&index| weights[index] == 0.0) {
        columns[index].0 = 0.0;
    }
    columns
}

fn quantised(share: f64, weight: f64) -> f64 {
    let least = if weight > 0.0 { 1.0 } else { 0.0 };
    (share * STEPS).round().clamp(least, STEPS) / STEPS
}

/// What the quantised table really draws.
fn probabilities(columns: &[(f64, u32)]) -> Vec<f64> {
    let mut pmf = vec![0.0; columns.len()];
    for (index, &(threshold, alias)) in columns.iter().enumerate() {
        pmf[index] += threshold;
        pmf[alias as usize] += 1.0 - threshold;
    }
    pmf.iter_mut().for_each(|p| *p /= columns.len() as f64);
    pmf
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every column with both its outcomes, counted exactly.
    fn drawn(table: &AliasTable) -> Vec<f64> {
        let columns: Vec<_> = table.entries.iter().map(|entry| (f64::from(entry.threshold), entry.alias)).collect();
        probabilities(&columns)
    }

    proptest! {
        #[test]
        fn probabilities_are_the_weights(weights in prop::collection::vec(0.0_f64..1e3, 1..200)) {
            let table = AliasTable::new(&weights);
            let sum: f64 = weights.iter().sum();
            prop_assume!(sum > 0.0);
            for (index, (entry, drawn)) in table.entries.iter().zip(drawn(&table)).enumerate() {
                prop_assert!((drawn - weights[index] / sum).abs() < 2e-7, "{} {}", drawn, weights[index] / sum);
                prop_assert!((f64::from(entry.pmf) - drawn).abs() <= drawn * 1e-7);
                prop_assert_eq!(entry.alias_pmf, table.entries[entry.alias as usize].pmf);
                prop_assert_eq!(entry.threshold * STEPS as f32, (entry.threshold * STEPS as f32).round());
            }
        }
    }

    #[test]
    fn tiny_weights_stay_possible_and_zero_ones_impossible() {
        let weights = [1e30, 0.0, 1e-30, 5.0, 0.0, 1e30];
        let table = AliasTable::new(&weights);
        for (weight, entry) in weights.iter().zip(&table.entries) {
            assert_eq!(*weight > 0.0, entry.pmf > 0.0, "{weight}");
        }
        let reached = (0..600).flat_map(|i| [0.0, 0.5, 0.999_999_94].map(|u2| table.sample(i as f32 / 600.0, u2)));
        assert!(reached.flatten().all(|index| weights[index as usize] > 0.0));
    }

    #[test]
    fn no_weight_no_table() {
        for weights in [&[][..], &[0.0, 0.0], &[f64::NAN, -1.0, f64::INFINITY]] {
            let table = AliasTable::new(weights);
            assert!(table.is_empty() && table.sample(0.5, 0.5).is_none());
        }
    }

    #[test]
    fn frequencies_follow() {
        let table = AliasTable::new(&[1.0, 2.0, 3.0, 4.0]);
        let mut counts = [0_u32; 4];
        for i in 0..400 {
            for j in 0..400 {
                let index = table.sample((i as f32 + 0.5) / 400.0, (j as f32 + 0.5) / 400.0).unwrap();
                counts[index as usize] += 1;
            }
        }
        for (index, count) in counts.iter().enumerate() {
            let expected = 16_000.0 * (index + 1) as f32;
            assert!((*count as f32 - expected).abs() <= 400.0, "{count} {expected}");
        }
    }
}
