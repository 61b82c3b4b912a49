//! Differences as pictures, in colour maps whose steps look even (and stay apart for most colour-blind people).

use super::FlipMap;
use crate::{
    film::{Film, linear, luminance},
    stats::{SizesDiffer, error::EPSILON, same_size},
};
use colorous::{Color, MAGMA, RED_BLUE};

/// FLIP from black (no difference) over red to pale yellow (1): magma, as the papers show it.
pub fn of_flip(map: &FlipMap) -> Film {
    picture(map.size, map.errors.iter().map(|&error| MAGMA.eval_continuous(f64::from(error).clamp(0.0, 1.0))))
}

/// Relative difference of luminance: blue where the image is too dark, white where it is right, red where it is too bright by half or more.
pub fn of_difference(image: &Film, reference: &Film) -> Result<Film, SizesDiffer> {
    same_size(image.size, reference.size)?;
    let bright = |color: &[f32; 3]| luminance(color.map(f64::from));
    let colors = image.color.iter().zip(&reference.color).map(|(x, r)| {
        let relative = (bright(x) - bright(r)) / (bright(r) + EPSILON);
        RED_BLUE.eval_continuous((0.5 - relative).clamp(0.0, 1.0))
    });
    Ok(picture(image.size, colors))
}

/// The colours of [`of_flip`] in 256 steps, three bytes of sRGB each.
pub fn scale_of_flip() -> Vec<u8> {
    scale(|place| MAGMA.eval_continuous(place))
}

/// The colours of [`of_difference`], from too bright to too dark, in the same form.
pub fn scale_of_difference() -> Vec<u8> {
    scale(|place| RED_BLUE.eval_continuous(place))
}

fn scale(color: impl Fn(f64) -> Color) -> Vec<u8> {
    (0..=255).map(|i| color(f64::from(i) / 255.0)).flat_map(|Color { r, g, b }| [r, g, b]).collect()
}

fn picture(size: [u32; 2], colors: impl Iterator<Item = Color>) -> Film {
    let color = colors.map(|Color { r, g, b }| [r, g, b].map(|code| linear(f32::from(code) / 255.0))).collect();
    Film { size, color, ..Film::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_middle() {
        let gray = |value: f32| Film::new([1, 1], vec![[value; 3]]).unwrap();
        let difference = |x: f32| of_difference(&gray(x), &gray(1.0)).unwrap().color[0];
        let [dark, right, bright] = [0.0, 1.0, 2.0].map(difference);
        assert!(dark[2] > 2.0 * dark[0] && bright[0] > 2.0 * bright[2] && right.iter().all(|&c| c > 0.8), "{dark:?} {right:?} {bright:?}");
        let map = of_flip(&FlipMap { size: [3, 1], errors: vec![0.0, 1.0, f32::NAN] });
        assert!(map.color[0].iter().all(|&c| c < 0.01) && map.color[1][0] > 0.9);
    }
}
