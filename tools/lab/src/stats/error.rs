//! How far a noisy image is from the truth, when the truth is itself a noisy image.

use super::{SizesDiffer, same_size};
use crate::film::{Area, Film};

/// Added to the squared reference in relative errors, so that black pixels do not rule the sum; the value that tev uses.
pub const EPSILON: f64 = 0.01;

/// A mean square error, averaged over pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SquareError {
    /// Of the image against the reference as it is.
    pub raw: f64,
    /// The part of `raw` that the reference's own variance accounts for; 0 where the reference has no variance and counts as exact.
    pub reference: f64,
}

impl SquareError {
    /// An unbiased estimate of the error against the truth. May be below zero when the image is about as good as the reference.
    pub fn value(&self) -> f64 {
        self.raw - self.reference
    }

    /// The mean over channels.
    pub fn over_channels(channels: [Self; 3]) -> Self {
        let mean = |part: fn(&Self) -> f64| channels.iter().map(part).sum::<f64>() / 3.0;
        Self { raw: mean(|error| error.raw), reference: mean(|error| error.reference) }
    }

    /// Is the reference good enough: does its variance stay below `share` of the error?
    pub fn is_resolved(&self, share: f64) -> bool {
        self.reference <= share * self.value()
    }
}

/// Mean square error.
pub fn mse(image: &Film, reference: &Film) -> Result<SquareError, SizesDiffer> {
    Ok(SquareError::over_channels(mse_over(image, reference, &Area::whole(reference.size))?))
}

/// Relative mean square error: (x − r)² / (r² + [`EPSILON`]).
pub fn rel_mse(image: &Film, reference: &Film) -> Result<SquareError, SizesDiffer> {
    Ok(SquareError::over_channels(rel_mse_over(image, reference, &Area::whole(reference.size))?))
}

/// Mean square errors of red, green and blue in an area.
pub fn mse_over(image: &Film, reference: &Film, area: &Area) -> Result<[SquareError; 3], SizesDiffer> {
    weighted(image, reference, area, |_| 1.0)
}

/// Relative mean square errors of red, green and blue in an area.
pub fn rel_mse_over(image: &Film, reference: &Film, area: &Area) -> Result<[SquareError; 3], SizesDiffer> {
    weighted(image, reference, area, |r| 1.0 / (r * r + EPSILON))
}

fn weighted(image: &Film, reference: &Film, area: &Area, weight: impl Fn(f64) -> f64) -> Result<[SquareError; 3], SizesDiffer> {
    same_size(image.size, reference.size)?;
    same_size(area.size(), reference.size)?;
    let count = area.count() as f64;
    Ok([0, 1, 2].map(|c| {
        let (mut raw, mut noise) = (0.0, 0.0);
        for i in area.pixels() {
            let r = f64::from(reference.color[i][c]);
            raw += (f64::from(image.color[i][c]) - r).powi(2) * weight(r);
            noise += reference.variance.as_ref().map_or(0.0, |v| f64::from(v[i][c]) * weight(r));
        }
        SquareError { raw: raw / count, reference: noise / count }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{Moments, rng::SplitMix};

    /// A grey ramp plus noise, which knows its variance.
    fn noisy(rng: &mut SplitMix, deviation: f64) -> Film {
        let color = (0..32 * 32).map(|i| [0, 1, 2].map(|_| (0.5 + f64::from(i) / 1024.0 + deviation * rng.normal()) as f32)).collect();
        let variance = Some(vec![[(deviation * deviation) as f32; 3]; 32 * 32]);
        Film { variance, ..Film::new([32, 32], color).unwrap() }
    }

    #[test]
    fn known_values() {
        let image = Film::new([1, 1], vec![[1.0, 2.0, 3.0]]).unwrap();
        let reference = Film { variance: Some(vec![[0.3; 3]]), ..Film::new([1, 1], vec![[1.0, 1.0, 1.0]]).unwrap() };
        let error = mse(&image, &reference).unwrap();
        assert!((error.raw - 5.0 / 3.0).abs() < 1e-9 && (error.reference - 0.3).abs() < 1e-7);
        let relative = rel_mse(&image, &reference).unwrap();
        assert!((relative.raw - 5.0 / 3.0 / 1.01).abs() < 1e-9 && (relative.reference - 0.3 / 1.01).abs() < 1e-7);
        assert!(mse(&image, &Film::new([2, 1], vec![[0.0; 3]; 2]).unwrap()).is_err());
    }

    #[test]
    fn the_references_noise_is_taken_out() {
        let mut rng = SplitMix::new(51);
        let errors: Moments = (0..40).map(|_| mse(&noisy(&mut rng, 0.1), &noisy(&mut rng, 0.05)).unwrap().value()).collect();
        assert!((errors.mean() - 0.01).abs() < 4.0 * errors.standard_error(), "{errors:?}");
        // The same test sees the bias of an estimate that leaves the noise in.
        assert!(0.0025 > 8.0 * errors.standard_error());
    }

    #[test]
    fn a_poor_reference_is_noticed() {
        let mut rng = SplitMix::new(52);
        let image = noisy(&mut rng, 0.1);
        assert!(mse(&image, &noisy(&mut rng, 0.02)).unwrap().is_resolved(0.1));
        assert!(!mse(&image, &noisy(&mut rng, 0.1)).unwrap().is_resolved(0.1));
    }
}
