//! Mean and variance of a stream.

use serde::{Deserialize, Serialize};

/// Count, mean and variance, updated one value at a time (Welford 1962) or merged (Chan, Golub, LeVeque 1979).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moments {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Moments {
    /// Adds one value.
    pub fn push(&mut self, value: f64) {
        self.count += 1;
        let before = value - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (value - self.mean);
    }

    /// The moments of both streams together.
    pub fn merged(self, other: Self) -> Self {
        if self.count == 0 || other.count == 0 {
            return if self.count == 0 { other } else { self };
        }
        let (a, b) = (self.count as f64, other.count as f64);
        let delta = other.mean - self.mean;
        Self {
            count: self.count + other.count,
            mean: self.mean + delta * b / (a + b),
            squares: self.squares + other.squares + delta * delta * a * b / (a + b),
        }
    }

    /// How many values.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; 0 of nothing.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Unbiased variance of the values; NaN of fewer than two.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { f64::NAN } else { self.squares / (self.count - 1) as f64 }
    }

    /// Standard error of the mean; NaN of fewer than two values.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.count as f64).sqrt()
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut moments = Self::default();
        values.into_iter().for_each(|value| moments.push(value));
        moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        let moments: Moments = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().collect();
        assert_eq!((moments.count(), moments.mean()), (8, 5.0));
        assert!((moments.variance() - 32.0 / 7.0).abs() < 1e-12);
        assert!(Moments::from_iter([1.0]).variance().is_nan());
    }

    #[test]
    fn a_large_offset_costs_no_digits() {
        let moments: Moments = (0..1000).map(|i| 1e9 + f64::from(i % 2)).collect();
        assert!((moments.variance() - 250.0 / 999.0).abs() < 1e-6);
    }

    #[test]
    fn parts_make_the_whole() {
        let values: Vec<f64> = (0..50).map(|i| f64::from(i * i % 17)).collect();
        let whole: Moments = values.iter().copied().collect();
        for split in [0, 1, 25, 50] {
            let (a, b) = values.split_at(split);
            let merged = Moments::from_iter(a.iter().copied()).merged(b.iter().copied().collect());
            assert_eq!(merged.count(), 50);
            assert!((merged.mean() - whole.mean()).abs() < 1e-12 && (merged.variance() - whole.variance()).abs() < 1e-12);
        }
    }
}
