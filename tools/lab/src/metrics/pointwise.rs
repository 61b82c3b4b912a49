//! Metrics that look at one pixel at a time.

use super::Measured;
use crate::{
    film::{Area, Film, srgb},
    stats::error::EPSILON,
};

/// The arithmetic mean.
pub(super) fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// What the error of MAPE is relative to.
pub(super) fn of_reference(_image: f64, reference: f64) -> f64 {
    reference.abs() + EPSILON
}

/// What the error of SMAPE is relative to.
pub(super) fn of_both(image: f64, reference: f64) -> f64 {
    image.abs() + reference.abs() + EPSILON
}

/// Mean of |x − r| / `denominator` in red, green and blue.
pub(super) fn absolute(image: &Film, reference: &Film, area: &Area, denominator: fn(f64, f64) -> f64) -> [f64; 3] {
    [0, 1, 2].map(|c| {
        mean(area.pixels().map(|i| {
            let (x, r) = (f64::from(image.color[i][c]), f64::from(reference.color[i][c]));
            (x - r).abs() / denominator(x, r)
        }))
    })
}

/// Of sRGB values from 0 to 1, so that it is the number that other programs give for PNG files.
pub(super) fn psnr(image: &Film, reference: &Film, area: &Area) -> Measured {
    let decibels = |mse: f64| -10.0 * mse.log10();
    let shown = |linear: f32| f64::from(srgb(linear));
    let square = [0, 1, 2].map(|c| mean(area.pixels().map(|i| (shown(image.color[i][c]) - shown(reference.color[i][c])).powi(2))));
    Measured::plain(decibels(square.iter().sum::<f64>() / 3.0), Some(square.map(decibels)))
}
