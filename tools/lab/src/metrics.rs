//! How far an image is from a reference: every metric, over the image and over parts of it. Definitions: `docs/metrics.md`.
//!
//! Where the reference knows the variance of its pixels, what that adds to an error is taken out if it can be: from means of squares, not
//! from means of absolute values, and not from what a screen shows.

mod flip;
pub mod heat;
mod pointwise;

pub use flip::{Exposures, FlipMap, PIXELS_PER_DEGREE, flip_hdr, flip_ldr};

use crate::{
    film::{Area, Film, luminance},
    stats::{
        SizesDiffer,
        error::{SquareError, mse_over, rel_mse_over},
        same_size,
    },
};
use serde::Serialize;
use std::{cell::OnceCell, fmt, str::FromStr};

/// A measure of distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Metric {
    /// Mean square error.
    Mse,
    /// Relative mean square error.
    RelMse,
    /// Mean absolute error, relative to the reference.
    Mape,
    /// Mean absolute error, relative to both images.
    Smape,
    /// Peak signal-to-noise ratio of what a screen shows, in dB; the only one of which more is better.
    Psnr,
    /// FLIP of what a screen shows.
    FlipLdr,
    /// FLIP over exposures.
    FlipHdr,
}

/// Every metric, its name for people and its key for options and files.
const NAMES: [(Metric, &str, &str); 7] = [
    (Metric::Mse, "MSE", "mse"),
    (Metric::RelMse, "relMSE", "rel_mse"),
    (Metric::Mape, "MAPE", "mape"),
    (Metric::Smape, "SMAPE", "smape"),
    (Metric::Psnr, "PSNR", "psnr"),
    (Metric::FlipLdr, "FLIP (LDR)", "flip_ldr"),
    (Metric::FlipHdr, "FLIP (HDR)", "flip_hdr"),
];

impl Metric {
    /// All of them, in the order in which they are shown.
    pub fn all() -> impl Iterator<Item = Self> {
        NAMES.into_iter().map(|(metric, ..)| metric)
    }

    /// For people.
    pub fn name(self) -> &'static str {
        NAMES[self as usize].1
    }

    /// For options and files.
    pub fn key(self) -> &'static str {
        NAMES[self as usize].2
    }

    /// Is `value` no worse than `limit`? What is not a number is worse.
    pub fn is_within(self, value: f64, limit: f64) -> bool {
        if self == Self::Psnr { value >= limit } else { value <= limit }
    }
}

impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// No metric has this key.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
#[error("there is no metric `{0}`; there are {keys}", keys = NAMES.map(|(.., key)| key).join(", "))]
pub struct UnknownMetric(pub String);

impl FromStr for Metric {
    type Err = UnknownMetric;

    fn from_str(key: &str) -> Result<Self, UnknownMetric> {
        NAMES.iter().find(|(.., known)| *known == key).map(|&(metric, ..)| metric).ok_or_else(|| UnknownMetric(key.to_owned()))
    }
}

/// What one metric gave over an area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// The result: without the part of the reference's variance where that is known and can be taken out.
    pub value: f64,
    /// Of the image against the reference as it is.
    pub raw: f64,
    /// The part that the reference's variance accounts for; `None` where it cannot be told from the rest.
    pub reference_variance: Option<f64>,
    /// `value` in red, green and blue, where channels can be told apart.
    pub channels: Option<[f64; 3]>,
}

impl Measured {
    fn square(channels: [SquareError; 3]) -> Self {
        let mean = SquareError::over_channels(channels);
        Self {
            value: mean.value(),
            raw: mean.raw,
            reference_variance: Some(mean.reference),
            channels: Some(channels.map(|error| error.value())),
        }
    }

    fn plain(value: f64, channels: Option<[f64; 3]>) -> Self {
        Self { value, raw: value, reference_variance: None, channels }
    }
}

/// Two images of one size, with the maps that every area shares; each is made when it is first asked for.
pub struct Pair<'a> {
    image: &'a Film,
    reference: &'a Film,
    flip_ldr: OnceCell<FlipMap>,
    flip_hdr: OnceCell<Option<FlipMap>>,
}

impl<'a> Pair<'a> {
    /// Of images that must have one size.
    pub fn new(image: &'a Film, reference: &'a Film) -> Result<Self, SizesDiffer> {
        same_size(image.size, reference.size)?;
        Ok(Self { image, reference, flip_ldr: OnceCell::new(), flip_hdr: OnceCell::new() })
    }

    /// The map of LDR-FLIP.
    pub fn flip_ldr(&self) -> &FlipMap {
        self.flip_ldr.get_or_init(|| flip::ldr(self.image, self.reference))
    }

    /// The map of HDR-FLIP; `None` when the reference is black.
    pub fn flip_hdr(&self) -> Option<&FlipMap> {
        self.flip_hdr.get_or_init(|| flip::hdr(self.image, self.reference)).as_ref()
    }

    /// One metric over an area; `None` where it is undefined: relative ones (and HDR-FLIP) where the reference is black.
    pub fn measure(&self, metric: Metric, area: &Area) -> Result<Option<Measured>, SizesDiffer> {
        same_size(area.size(), self.reference.size)?;
        let (image, reference) = (self.image, self.reference);
        let relative = matches!(metric, Metric::RelMse | Metric::Mape | Metric::Smape);
        if relative && self.is_black(area) {
            return Ok(None);
        }
        let mean_of = |map: &FlipMap| Measured::plain(pointwise::mean(area.pixels().map(|i| f64::from(map.errors[i]))), None);
        let absolute = |denominator| {
            let channels = pointwise::absolute(image, reference, area, denominator);
            Measured::plain(channels.iter().sum::<f64>() / 3.0, Some(channels))
        };
        Ok(match metric {
            Metric::Mse => Some(Measured::square(mse_over(image, reference, area)?)),
            Metric::RelMse => Some(Measured::square(rel_mse_over(image, reference, area)?)),
            Metric::Mape => Some(absolute(pointwise::of_reference)),
            Metric::Smape => Some(absolute(pointwise::of_both)),
            Metric::Psnr => Some(pointwise::psnr(image, reference, area)),
            Metric::FlipLdr => Some(mean_of(self.flip_ldr())),
            Metric::FlipHdr => self.flip_hdr().map(mean_of),
        })
    }

    /// Mean luminance of the image over the reference's, less one; `None` where the reference is black.
    pub fn mean_difference(&self, area: &Area) -> Option<f64> {
        let mean = |film: &Film| pointwise::mean(area.pixels().map(|i| luminance(film.color[i].map(f64::from))));
        (!self.is_black(area)).then(|| mean(self.image) / mean(self.reference) - 1.0)
    }

    /// Pixels of either image that are infinite or not a number; a metric that they reach is so too.
    pub fn not_finite(&self, area: &Area) -> usize {
        let broken = |film: &Film, i: usize| film.color[i].iter().any(|c| !c.is_finite());
        area.pixels().filter(|&i| broken(self.image, i) || broken(self.reference, i)).count()
    }

    fn is_black(&self, area: &Area) -> bool {
        area.pixels().all(|i| self.reference.color[i] == [0.0; 3])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_places() {
        for (i, metric) in Metric::all().enumerate() {
            assert_eq!((metric as usize, metric.key().parse()), (i, Ok(metric)));
        }
        assert!("flip".parse::<Metric>().unwrap_err().to_string().ends_with("psnr, flip_ldr, flip_hdr"));
        assert!(Metric::Psnr.is_within(40.0, 30.0) && Metric::Mse.is_within(0.1, 0.2) && !Metric::Mse.is_within(f64::NAN, 1.0));
    }

    #[test]
    fn known_values() {
        let image = Film::new([2, 1], vec![[0.5, 1.0, 0.0], [2.0; 3]]).unwrap();
        let reference = Film::new([2, 1], vec![[1.0, 1.0, 0.0], [2.0; 3]]).unwrap();
        let pair = Pair::new(&image, &reference).unwrap();
        let whole = Area::whole([2, 1]);
        let value = |metric, area: &Area| pair.measure(metric, area).unwrap().unwrap();
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6 * b.abs().max(1.0), "{a} {b}");
        close(value(Metric::Mse, &whole).value, 0.25 / 6.0);
        close(value(Metric::Mape, &whole).value, 0.5 / 1.01 / 6.0);
        close(value(Metric::Smape, &whole).value, 0.5 / 1.51 / 6.0);
        assert_eq!(value(Metric::Mape, &whole).channels.map(|c| c[1]), Some(0.0));
        // sRGB of 0.5 is 0.7354: the square error of the screen's values is 0.2646²/6.
        close(value(Metric::Psnr, &whole).value, -10.0 * (0.264_642_95_f64.powi(2) / 6.0).log10());
        let right = Area::region([2, 1], "1,0,1x1".parse().unwrap()).unwrap();
        assert_eq!(value(Metric::Psnr, &right).value, f64::INFINITY);
        assert_eq!((value(Metric::Mse, &right).value, value(Metric::FlipLdr, &whole).channels), (0.0, None));
        close(pair.mean_difference(&whole).unwrap(), -0.5 * 0.2126 / (0.9278 + 2.0));
    }

    #[test]
    fn nothing_is_relative_to_black() {
        let (image, reference) = (Film::new([1, 1], vec![[1.0; 3]]).unwrap(), Film::new([1, 1], vec![[0.0; 3]]).unwrap());
        let pair = Pair::new(&image, &reference).unwrap();
        let defined = Metric::all().map(|metric| pair.measure(metric, &Area::whole([1, 1])).unwrap().is_some());
        assert_eq!(defined.collect::<Vec<_>>(), [true, false, false, false, true, true, false]);
        assert_eq!(pair.mean_difference(&Area::whole([1, 1])), None);
    }

    #[test]
    fn broken_pixels_are_counted() {
        let image = Film::new([2, 1], vec![[f32::NAN, 0.0, 0.0], [1.0; 3]]).unwrap();
        let reference = Film::new([2, 1], vec![[1.0; 3]; 2]).unwrap();
        let pair = Pair::new(&image, &reference).unwrap();
        assert_eq!(pair.not_finite(&Area::whole([2, 1])), 1);
        assert!(pair.measure(Metric::Mse, &Area::whole([2, 1])).unwrap().unwrap().value.is_nan());
    }
}
