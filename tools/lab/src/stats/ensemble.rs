//! Independent renders of the same thing, one a seed: the only honest source of variance where frames share samples.

use super::{Moments, SizesDiffer, same_size};
use crate::film::Film;

/// Per-pixel moments over renders.
#[derive(Clone, Debug, Default)]
pub struct Ensemble {
    size: [u32; 2],
    pixels: Vec<[Moments; 3]>,
    renders: u64,
}

/// Mean square error of one render, split. All parts are estimates without bias, and may come out below zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorSplit {
    /// Squared distance of the expected image from the truth.
    pub bias_squared: f64,
    /// Variance of one render.
    pub variance: f64,
}

impl ErrorSplit {
    /// The whole error of one render.
    pub fn mse(&self) -> f64 {
        self.bias_squared + self.variance
    }
}

impl Ensemble {
    /// Adds one render.
    pub fn push(&mut self, film: &Film) -> Result<(), SizesDiffer> {
        if self.renders == 0 {
            *self = Self { size: film.size, pixels: vec![Default::default(); film.pixels()], renders: 0 };
        }
        same_size(self.size, film.size)?;
        for (moments, color) in self.pixels.iter_mut().zip(&film.color) {
            for (moments, value) in moments.iter_mut().zip(color) {
                moments.push(f64::from(*value));
            }
        }
        self.renders += 1;
        Ok(())
    }

    /// How many renders.
    pub fn renders(&self) -> u64 {
        self.renders
    }

    /// Their mean, with the variance of the mean where there are two or more.
    pub fn film(&self) -> Film {
        let per_pixel = |value: fn(&Moments) -> f64| self.pixels.iter().map(|m| m.each_ref().map(|m| value(m) as f32)).collect();
        Film {
            size: self.size,
            color: per_pixel(Moments::mean),
            variance: (self.renders >= 2).then(|| per_pixel(|m| m.standard_error().powi(2))),
            ..Film::default()
        }
    }

    /// Bias and variance against `reference`, averaged over pixels and channels. NaN with fewer than two renders.
    pub fn split(&self, reference: &Film) -> Result<ErrorSplit, SizesDiffer> {
        same_size(self.size, reference.size)?;
        let count = 3.0 * self.pixels.len() as f64;
        let variance = self.pixels.iter().flatten().map(Moments::variance).sum::<f64>() / count;
        let squared = self.pixels.iter().flatten().zip(reference.color.iter().flatten());
        let distance = squared.map(|(m, r)| (m.mean() - f64::from(*r)).powi(2)).sum::<f64>() / count;
        let noise = reference.variance.iter().flatten().flatten().map(|v| f64::from(*v)).sum::<f64>() / count;
        Ok(ErrorSplit { bias_squared: distance - variance / self.renders as f64 - noise, variance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::rng::SplitMix;

    #[test]
    fn bias_and_variance_are_told_apart() {
        let mut rng = SplitMix::new(61);
        let mut image = |offset: f64, deviation: f64| {
            let color = (0..64 * 64).map(|_| [0, 1, 2].map(|_| (1.0 + offset + deviation * rng.normal()) as f32)).collect();
            let variance = Some(vec![[(deviation * deviation) as f32; 3]; 64 * 64]);
            Film { variance, ..Film::new([64, 64], color).unwrap() }
        };
        let mut ensemble = Ensemble::default();
        for _ in 0..8 {
            ensemble.push(&image(0.2, 0.5)).unwrap();
        }
        let split = ensemble.split(&image(0.0, 0.1)).unwrap();
        assert!((split.bias_squared - 0.04).abs() < 0.004, "{split:?}");
        assert!((split.variance - 0.25).abs() < 0.01, "{split:?}");
        let film = ensemble.film();
        let mean_variance = film.variance.unwrap().iter().flatten().sum::<f32>() / (3.0 * 4096.0);
        assert!((mean_variance - 0.25 / 8.0).abs() < 0.002, "{mean_variance}");
        assert!(ensemble.push(&Film::new([1, 1], vec![[0.0; 3]]).unwrap()).is_err());
    }
}
