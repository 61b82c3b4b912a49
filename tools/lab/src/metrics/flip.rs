//! FLIP: the difference that a person sees who flips between two images on a screen.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, *FLIP: A Difference Evaluator for Alternating Images*, HPG 2020, for
//! images as a screen shows them; Andersson, Nilsson, Shirley, Akenine-Möller, *Visualizing Errors in Rendered High Dynamic Range Images*,
//! Eurographics 2021, for radiance: the largest of the former over a range of exposures. The filters are taken apart into one pass across
//! and one down. The test `tests/flip.rs` holds the means against those of the authors' own program.

mod color;
mod exposure;
mod filter;

use crate::{
    film::Film,
    stats::{SizesDiffer, same_size},
};
use color::Color;
use filter::{Feature, Plane, Smoothing};
use rayon::prelude::*;

pub use exposure::Exposures;

/// Pixels per degree of a viewer 0.7 m before a screen 0.7 m and 3840 pixels wide: the papers' default, about 67.
pub const PIXELS_PER_DEGREE: f32 = 3840.0 * std::f32::consts::PI / 180.0;

/// Exponent of the feature difference (HPG 2020, section 4.3).
const FEATURE_EXPONENT: f32 = 0.5;

/// The visible difference of every pixel, 0 to 1, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// One a pixel.
    pub errors: Vec<f32>,
}

/// LDR-FLIP of linear colour; what lies outside 0 to 1 is cut off, as a screen does.
pub fn flip_ldr(image: &Film, reference: &Film) -> Result<FlipMap, SizesDiffer> {
    same_size(image.size, reference.size)?;
    Ok(ldr(image, reference))
}

/// HDR-FLIP of radiance; `None` when the reference is black, so that no exposure suits it.
pub fn flip_hdr(image: &Film, reference: &Film) -> Result<Option<FlipMap>, SizesDiffer> {
    same_size(image.size, reference.size)?;
    Ok(hdr(image, reference))
}

/// [`flip_ldr`] of images known to have one size.
pub(super) fn ldr(image: &Film, reference: &Film) -> FlipMap {
    let shown = |film: &Film| film.color.iter().map(|color| color.map(|c| c.clamp(0.0, 1.0))).collect::<Vec<_>>();
    let size = image.size.map(|side| side as usize);
    FlipMap { size: image.size, errors: Eye::new(PIXELS_PER_DEGREE).difference(size, &shown(image), &shown(reference)) }
}

/// [`flip_hdr`] of images known to have one size.
pub(super) fn hdr(image: &Film, reference: &Film) -> Option<FlipMap> {
    let exposures = Exposures::of(&reference.color)?;
    let (eye, size) = (Eye::new(PIXELS_PER_DEGREE), image.size.map(|side| side as usize));
    let exposures: Vec<f32> = exposures.steps().collect();
    let errors = |&exposure: &f32| {
        let shown = |film: &Film| film.color.iter().map(|&color| exposure::develop(color, exposure)).collect::<Vec<_>>();
        eye.difference(size, &shown(image), &shown(reference))
    };
    // `max` would pass over a pixel that is not a number.
    let larger = |a: f32, b: f32| if a.is_nan() || a >= b { a } else { b };
    let largest = exposures
        .par_iter()
        .map(errors)
        .reduce(|| vec![0.0; reference.pixels()], |a, b| a.into_iter().zip(b).map(|(a, b)| larger(a, b)).collect());
    Some(FlipMap { size: image.size, errors: largest })
}

/// What depends on the viewing distance alone.
struct Eye {
    smoothing: Smoothing,
    feature: Feature,
    scale: color::Scale,
}

impl Eye {
    fn new(pixels_per_degree: f32) -> Self {
        Self { smoothing: Smoothing::new(pixels_per_degree), feature: Feature::new(pixels_per_degree), scale: color::Scale::default() }
    }

    /// LDR-FLIP of linear colours within 0 to 1 (HPG 2020, equation 17).
    fn difference(&self, size: [usize; 2], image: &[Color], reference: &[Color]) -> Vec<f32> {
        let [image, reference] = [image, reference].map(|colors| Planes::new(size, colors));
        let colors = self.colors(&image).zip(self.colors(&reference)).map(|(a, b)| self.scale.difference(a, b));
        let features = self.feature.strengths(&image.y).zip(self.feature.strengths(&reference.y)).map(feature_difference);
        colors.zip(features).map(|(color, feature)| color.powf(1.0 - feature)).collect()
    }

    /// What is left of the colours at this distance, in the space where they are compared.
    fn colors(&self, planes: &Planes) -> impl Iterator<Item = Color> + use<> {
        let [y, cx, cz] = self.smoothing.seen(&planes.y, &planes.cx, &planes.cz);
        y.values.into_iter().zip(cx.values).zip(cz.values).map(|((y, cx), cz)| color::perceived([y, cx, cz]))
    }
}

/// An image in the opponent space YCxCz.
struct Planes {
    y: Plane,
    cx: Plane,
    cz: Plane,
}

impl Planes {
    fn new(size: [usize; 2], colors: &[Color]) -> Self {
        let opponent: Vec<Color> = colors.iter().map(|&color| color::to_opponent(color)).collect();
        let [y, cx, cz] = [0, 1, 2].map(|c| Plane { size, values: opponent.iter().map(|color| color[c]).collect() });
        Self { y, cx, cz }
    }
}

/// From the strengths of edges and points in both images (HPG 2020, equation 16).
fn feature_difference(([edge, point], [other_edge, other_point]): ([f32; 2], [f32; 2])) -> f32 {
    let largest = (edge - other_edge).abs().max((point - other_point).abs());
    (std::f32::consts::FRAC_1_SQRT_2 * largest).powf(FEATURE_EXPONENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(color: Color) -> Film {
        Film::new([9, 7], vec![color; 63]).unwrap()
    }

    #[test]
    fn equal_images_do_not_differ_and_opposite_ones_do() {
        let (green, blue) = (flat([0.0, 1.0, 0.0]), flat([0.0, 0.0, 1.0]));
        assert!(flip_ldr(&green, &green).unwrap().errors.iter().all(|&error| error == 0.0));
        // Green against blue is the largest difference there is: 1, without features.
        assert!(flip_ldr(&green, &blue).unwrap().errors.iter().all(|&error| (error - 1.0).abs() < 1e-4));
    }

    #[test]
    fn what_is_beyond_the_screen_shows_in_hdr_alone() {
        let (bright, brighter) = (flat([4.0; 3]), flat([8.0; 3]));
        assert!(flip_ldr(&bright, &brighter).unwrap().errors.iter().all(|&error| error == 0.0));
        assert!(flip_hdr(&bright, &brighter).unwrap().unwrap().errors.iter().all(|&error| error > 0.1));
        assert_eq!(flip_hdr(&bright, &flat([0.0; 3])), Ok(None));
        assert!(flip_hdr(&bright, &Film::new([1, 1], vec![[1.0; 3]]).unwrap()).is_err());
    }

    #[test]
    fn a_pixel_that_is_not_a_number_stays_visible() {
        let mut broken = flat([1.0; 3]);
        broken.color[0] = [f32::NAN; 3];
        assert!(flip_hdr(&broken, &flat([1.0; 3])).unwrap().unwrap().errors[0].is_nan());
    }
}
