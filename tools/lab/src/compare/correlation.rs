//! How much of the noise frames and neighbours share.
//!
//! Noise is what is left of a render when the mean over seeds is taken away, so bias and the picture itself have no part in it.

use super::report::Correlation;
use crate::film::Film;
use rayon::prelude::*;

/// Pixels that the spatial figures look away.
const REACH: usize = 8;

/// Correlation of renders: `frames[k][i]` is frame k of seed i, successive frames of one run; the last frame is what others are held against.
/// At least one frame of two seeds.
pub fn correlation(frames: &[Vec<Film>]) -> Correlation {
    let noise: Vec<Vec<Vec<f64>>> = frames.iter().map(|films| noise(films)).collect();
    let Some((last, before)) = noise.split_last() else { return Correlation::default() };
    let (variance, flicker) = (product(last, last), flicker(frames));
    if variance <= 0.0 {
        return Correlation { flicker, ..Correlation::default() };
    }
    Correlation {
        temporal: before.iter().rev().map(|earlier| product(last, earlier) / variance).collect(),
        spatial: (1..=REACH).into_par_iter().map(|away| spatial(last, frames[frames.len() - 1][0].size, away) / variance).collect(),
        flicker,
        accumulation_gain: Vec::new(),
    }
}

/// Variance of one frame over N times the variance of the mean of N, for N = 1, 2, 4, …: from the films of both, by seed. Nothing of what does
/// not vary.
pub fn accumulation_gain(means: &[(u32, Vec<Film>)]) -> Vec<(u32, f64)> {
    let variance = |films: &[Film]| {
        let noise = noise(films);
        product(&noise, &noise)
    };
    let Some((_, single)) = means.iter().find(|(frames, _)| *frames == 1) else { return Vec::new() };
    let one = variance(single);
    let gains = means.iter().map(|(frames, films)| (*frames, one / (f64::from(*frames) * variance(films))));
    gains.filter(|(_, gain)| gain.is_finite()).collect()
}

/// Every film less the mean over films.
fn noise(films: &[Film]) -> Vec<Vec<f64>> {
    let values = |film: &Film| film.color.iter().flatten().map(|value| f64::from(*value)).collect::<Vec<f64>>();
    let mut all: Vec<Vec<f64>> = films.iter().map(values).collect();
    for at in 0..all.first().map_or(0, Vec::len) {
        let mean = all.iter().map(|film| film[at]).sum::<f64>() / all.len() as f64;
        all.iter_mut().for_each(|film| film[at] -= mean);
    }
    all
}

/// Covariance over seeds, averaged over pixels and channels.
fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>()).sum();
    sum / ((a.len().max(2) - 1) * a.first().map_or(1, Vec::len)) as f64
}

/// Covariance of pixels `away` from each other, across and down alike.
fn spatial(noise: &[Vec<f64>], size: [u32; 2], away: usize) -> f64 {
    let row = 3 * size[0] as usize;
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut sum, mut pairs) = (0.0, 0);
    for film in noise {
        for values in film.chunks_exact(row).filter(|values| values.len() > 3 * away) {
            sum += product(values, &values[3 * away..]);
            pairs += values.len() - 3 * away;
        }
        if let Some(below) = film.get(row * away..) {
            sum += product(film, below);
            pairs += below.len();
        }
    }
    // The mean over seeds was estimated from the same seeds.
    let seeds = noise.len() as f64;
    sum / pairs.max(1) as f64 * seeds / (seeds - 1.0).max(1.0)
}

/// Mean distance of the last two frames, relative to the mean.
fn flicker(frames: &[Vec<Film>]) -> f64 {
    let [.., before, last] = frames else { return 0.0 };
    let (mut distance, mut mean) = (0.0, 0.0);
    for (a, b) in before.iter().zip(last) {
        for (a, b) in a.color.iter().flatten().zip(b.color.iter().flatten()) {
            distance += f64::from((a - b).abs());
            mean += f64::from(*b);
        }
    }
    if mean > 0.0 { distance / mean } else { 0.0 }
}
