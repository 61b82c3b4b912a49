//! The colour spaces of FLIP, and the distance in the last of them.

use crate::film::luminance;

/// Three components of a space that the function names.
pub(super) type Color = [f32; 3];

/// CIE XYZ of linear Rec. 709 under D65, as exact quotients (the matrix that the authors use).
const TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];
/// And back.
const FROM_XYZ: [[f32; 3]; 3] =
    [[3.241_003_3, -1.537_399, -0.498_615_86], [-0.969_224_33, 1.875_930_1, 0.041_554_224], [0.055_639_423, -0.204_011_2, 1.057_148_9]];
/// White: XYZ of (1, 1, 1).
const WHITE: Color = [0.950_428_55, 1.0, 1.088_900_4];

/// Exponent of the colour difference, and the shares at which it bends (HPG 2020, section 4.2).
const COLOR_EXPONENT: f32 = 0.7;
const BEND_AT: f32 = 0.4;
const BEND_TO: f32 = 0.95;

fn apply(matrix: &[[f32; 3]; 3], v: Color) -> Color {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// XYZ as shares of white.
fn to_relative_xyz(linear: Color) -> Color {
    let xyz = apply(&TO_XYZ.map(|row| row.map(|x| x as f32)), linear);
    [0, 1, 2].map(|c| xyz[c] / WHITE[c])
}

/// YCxCz: the linear opponent space in which eyes are modelled as filters.
pub(super) fn to_opponent(linear: Color) -> Color {
    let [x, y, z] = to_relative_xyz(linear);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn from_opponent([y, cx, cz]: Color) -> Color {
    let y = (y + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    apply(&FROM_XYZ, [0, 1, 2].map(|c| relative[c] * WHITE[c]))
}

/// Lab with Hunt's adjustment: chroma counts less where it is dark (HPG 2020, equations 8 and 9).
fn to_hunt_lab(linear: Color) -> Color {
    const DELTA: f32 = 6.0 / 29.0;
    let curve = |t: f32| if t > DELTA.powi(3) { t.powf(1.0 / 3.0) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 };
    let [x, y, z] = to_relative_xyz(linear).map(curve);
    let l = 116.0 * y - 16.0;
    [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
}

/// A filtered opponent colour as it is compared: cut to what a screen can show, then made even for the eye.
pub(super) fn perceived(opponent: Color) -> Color {
    to_hunt_lab(from_opponent(opponent).map(|c| c.clamp(0.0, 1.0)))
}

/// HyAB raised to the colour exponent (HPG 2020, equation 10).
fn distance(a: Color, b: Color) -> f32 {
    let chroma = ((a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt();
    ((a[0] - b[0]).abs() + chroma).powf(COLOR_EXPONENT)
}

/// Maps distances to 0…1.
pub(super) struct Scale {
    /// The distance of green and blue, the largest there is.
    largest: f32,
}

impl Default for Scale {
    fn default() -> Self {
        Self { largest: distance(to_hunt_lab([0.0, 1.0, 0.0]), to_hunt_lab([0.0, 0.0, 1.0])) }
    }
}

impl Scale {
    /// Difference of two perceived colours; large ones are pressed together (HPG 2020, equation 11).
    pub(super) fn difference(&self, a: Color, b: Color) -> f32 {
        let (distance, bend) = (distance(a, b), BEND_AT * self.largest);
        match distance < bend {
            true => distance * BEND_TO / bend,
            false => BEND_TO + (distance - bend) / (self.largest - bend) * (1.0 - BEND_TO),
        }
    }
}

/// Relative luminance, in the precision of films.
pub(super) fn luminance_of(linear: Color) -> f32 {
    luminance(linear.map(f64::from)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spaces_are_left_as_they_were_entered() {
        for color in [[0.0; 3], [1.0; 3], [0.2, 0.5, 0.9], [1.0, 0.0, 0.0]] {
            let back = from_opponent(to_opponent(color));
            assert!((0..3).all(|c| (back[c] - color[c]).abs() < 1e-5), "{color:?} {back:?}");
        }
    }

    #[test]
    fn known_values() {
        let close = |a: Color, b: Color| (0..3).all(|c| (a[c] - b[c]).abs() < 1e-2);
        assert!(close(to_hunt_lab([1.0; 3]), [100.0, 0.0, 0.0]), "{:?}", to_hunt_lab([1.0; 3]));
        // Lab of sRGB green is (87.73, −86.18, 83.18).
        assert!(close(to_hunt_lab([0.0, 1.0, 0.0]), [87.73, 0.8773 * -86.18, 0.8773 * 83.18]), "{:?}", to_hunt_lab([0.0, 1.0, 0.0]));
    }
}
