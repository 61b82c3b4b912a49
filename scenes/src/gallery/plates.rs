//! Two unit squares that face each other, one emitting, one diffuse: the textbook form factor. What the dark plate receives is known in
//! closed form, [`form_factor`]. For tests.

use crate::build::{Shape, Stage, glow, matte};
use aquifer_scene::Scene;
use glam::Vec3;

/// Radiance of the upper plate, W·m⁻²·sr⁻¹.
pub const RADIANCE: f32 = 1.0;

/// Reflectance of the lower plate.
pub const ALBEDO: f32 = 0.5;

/// Two parallel plates of 1 m × 1 m, `distance` metres apart: the lower one, at y = 0, is diffuse; the upper one emits downward and
/// reflects nothing, so that no light comes back.
///
/// Camera "main" sees both from the side. Camera "receiver" hangs half-way between them and looks straight down; its square picture is
/// filled by exactly the lower plate, so the mean of that picture is [`ALBEDO`] · [`RADIANCE`] · [`form_factor`]`(distance)`.
pub fn plates_at(distance: f32) -> Scene {
    let mut stage = Stage::new("plates");
    let receiver = stage.material(matte("receiver", [ALBEDO; 3]));
    let emitter = stage.material(glow("emitter", [RADIANCE; 3]));
    let mut plates = Shape::new("plates");
    plates.quad(receiver, Vec3::new(-0.5, 0.0, 0.5), Vec3::X, Vec3::NEG_Z);
    plates.quad(emitter, Vec3::new(-0.5, distance, -0.5), Vec3::X, Vec3::Z);
    stage.add(plates);
    let middle = 0.5 * distance;
    stage.camera("main", [1.1, middle, 2.6], [0.0, middle, 0.0], 40.0);
    stage.camera("receiver", [0.0, middle, 0.0], [0.0; 3], 2.0 * (0.5 / middle).atan().to_degrees());
    stage.into_scene()
}

pub(super) fn plates() -> Scene {
    plates_at(1.0)
}

/// Fraction of what one unit square sends out that reaches the other, parallel and opposite at `distance` metres (Howell, A Catalog of
/// Radiation Heat Transfer Configuration Factors, C-11).
pub fn form_factor(distance: f64) -> f64 {
    let x = 1.0 / distance;
    let root = (1.0 + x * x).sqrt();
    let logarithm = ((1.0 + x * x) / (1.0 + 2.0 * x * x).sqrt()).ln();
    let angles = 2.0 * x * root * (x / root).atan() - 2.0 * x * x.atan();
    2.0 / (std::f64::consts::PI * x * x) * (logarithm + angles)
}

#[cfg(test)]
mod tests {
    use super::form_factor;

    #[test]
    fn the_closed_form_agrees_with_summing_over_both_plates() {
        let distance = 0.7;
        let steps = 48;
        let at = |i: usize| (i as f64 + 0.5) / steps as f64;
        let mut sum = 0.0;
        // The kernel depends on the offsets only: count how often each offset occurs.
        for (i, j) in (0..2 * steps - 1).flat_map(|i| (0..2 * steps - 1).map(move |j| (i, j))) {
            let offset = |k: usize| at(k) - at(steps - 1);
            let often = |k: usize| (steps - k.abs_diff(steps - 1)) as f64;
            let squared = offset(i).powi(2) + offset(j).powi(2) + distance * distance;
            sum += often(i) * often(j) * distance * distance / (std::f64::consts::PI * squared * squared);
        }
        let numeric = sum / (steps as f64).powi(4);
        assert!((form_factor(distance) - numeric).abs() < 2e-4, "{} against {numeric}", form_factor(distance));
        assert!((form_factor(1.0) - 0.199_825).abs() < 1e-6);
    }
}
