//! A number over independent seeds.

use crate::stats::bootstrap::{Bootstrap, Interval};
use serde::{Deserialize, Serialize};

/// The median over seeds, which one outlier cannot move, with its 95 % bootstrap interval and everything it came from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The median.
    pub median: f64,
    /// Its interval; `None` with fewer than two values.
    pub interval: Option<[f64; 2]>,
    /// One a seed, in the order of seeds.
    pub values: Vec<f64>,
}

impl Summary {
    /// Of values in the order of their seeds; equal values give equal summaries.
    pub fn of(values: Vec<f64>) -> Self {
        let Interval { estimate, low, high } = Bootstrap::default().of(&values, median);
        let interval = (low.is_finite() && high.is_finite()).then_some([low, high]);
        Self { median: estimate, interval, values }
    }
}

/// The middle value, or the mean of the two in the middle; NaN of nothing.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.as_slice() {
        [] => f64::NAN,
        sorted => 0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_odd_even_and_no_values() {
        assert_eq!([median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0, 3.0, 2.0])], [2.0, 2.5]);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn one_value_has_no_interval() {
        assert_eq!(Summary::of(vec![1.0]).interval, None);
        let [low, high] = Summary::of((0..16).map(f64::from).collect()).interval.unwrap();
        assert!(low < 7.5 && high > 7.5 && low >= 0.0 && high <= 15.0);
    }
}
