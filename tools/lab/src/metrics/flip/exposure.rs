//! The exposures of HDR-FLIP: from where the brightest pixel is not yet white to where the median pixel is.

use super::color::{Color, luminance_of};

/// ACES as Narkowicz fitted it, numerator and denominator from the square down, with the usual 0.6 before it taken in.
const NUMERATOR: [f32; 3] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0];
const DENOMINATOR: [f32; 3] = [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];

/// Tone-mapped value that counts as nearly white (Eurographics 2021, section 4).
const NEARLY_WHITE: f32 = 0.85;

/// Exposures in stops, evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposures {
    /// The darkest picture: its brightest pixel is nearly white.
    pub first: f32,
    /// The brightest picture: its median pixel is nearly white.
    pub last: f32,
    /// How many, at least two.
    pub count: usize,
}

impl Exposures {
    /// Chosen from the reference alone; `None` when it is black. When more than half of it is black, the median is that of the rest.
    pub fn of(reference: &[[f32; 3]]) -> Option<Self> {
        let mut lit: Vec<f32> = reference.iter().map(|&color| luminance_of(color)).filter(|y| y.is_finite()).collect();
        let median_of = |values: &mut Vec<f32>| {
            let middle = values.len() / 2;
            (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f32::total_cmp).1)
        };
        let all = median_of(&mut lit);
        lit.retain(|&y| y > 0.0);
        let median = all.filter(|&y| y > 0.0).or_else(|| median_of(&mut lit))?;
        let brightest = lit.iter().copied().fold(0.0, f32::max);
        let white = luminance_of_nearly_white();
        let (first, last) = ((white / brightest).log2(), (white / median).log2());
        Some(Self { first, last, count: (last - first).ceil().max(2.0) as usize })
    }

    /// Every exposure.
    pub(super) fn steps(self) -> impl Iterator<Item = f32> {
        let step = (self.last - self.first) / (self.count - 1) as f32;
        (0..self.count).map(move |i| self.first + i as f32 * step)
    }
}

fn polynomial([square, line, constant]: [f32; 3], x: f32) -> f32 {
    (square * x + line) * x + constant
}

/// Exposed, tone-mapped, and cut to what a screen shows.
pub(super) fn develop(color: Color, exposure: f32) -> Color {
    let scale = exposure.exp2();
    color.map(|c| (polynomial(NUMERATOR, scale * c) / polynomial(DENOMINATOR, scale * c)).clamp(0.0, 1.0))
}

/// The larger root of curve(x) = [`NEARLY_WHITE`], a quadratic equation.
fn luminance_of_nearly_white() -> f32 {
    let [a, b, c] = [0, 1, 2].map(|i| NUMERATOR[i] - NEARLY_WHITE * DENOMINATOR[i]);
    let half = -0.5 * b / a;
    half + (half * half - c / a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_nearly_white() {
        let exposures = Exposures::of(&[[0.01; 3], [0.1; 3], [4.0; 3]]).unwrap();
        assert!((develop([4.0; 3], exposures.first)[0] - NEARLY_WHITE).abs() < 1e-4);
        assert!((develop([0.1; 3], exposures.last)[0] - NEARLY_WHITE).abs() < 1e-4);
        // 0.1 and 4 are 5.3 stops apart.
        assert_eq!((exposures.count, exposures.steps().count()), (6, 6));
    }

    #[test]
    fn mostly_black_and_black_references() {
        let half_lit = Exposures::of(&[[0.0; 3], [0.0; 3], [0.0; 3], [1.0; 3]]).unwrap();
        assert_eq!((half_lit.first, half_lit.count), (half_lit.last, 2));
        assert_eq!((Exposures::of(&[[0.0; 3]; 4]), Exposures::of(&[])), (None, None));
    }
}
