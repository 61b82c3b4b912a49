//! A clear sky with a sun, as an equirectangular map.

use aquifer_scene::Environment;
use glam::{Mat3, Vec3};
use std::f32::consts::{PI, TAU};

/// What the sky looks like. Radiance in W·m⁻²·sr⁻¹.
#[derive(Clone, Copy, Debug)]
pub struct Sky {
    /// Straight up.
    pub zenith: Vec3,
    /// Just above the horizon.
    pub horizon: Vec3,
    /// Below the horizon.
    pub ground: Vec3,
    /// Unit vector towards the sun.
    pub to_sun: Vec3,
    /// Radiance at the middle of the sun's lobe.
    pub sun: Vec3,
    /// Angle (degrees) at which the lobe, a Gaussian, has fallen to 1/e.
    pub sun_width: f32,
}

/// Paints a sky into a map `width` texels across and half as many down. The sun's lobe must be wider than a texel, 360°/width.
pub fn sky(name: &str, width: u32, look: &Sky) -> Environment {
    let height = width / 2;
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let radiance = texels
        .map(|(x, y)| {
            let direction = map_direction((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32);
            look.radiance(direction).to_array()
        })
        .collect();
    Environment { name: name.into(), width, height, radiance, world_to_map: Mat3::IDENTITY }
}

impl Sky {
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let angle = direction.angle_between(self.to_sun);
        let haze = 0.25 * self.horizon * (-angle / 0.35).exp();
        let lobe = self.sun * (-(angle / self.sun_width.to_radians()).powi(2)).exp();
        if direction.y < 0.0 {
            let fade = (-direction.y * 12.0).min(1.0);
            return self.horizon.lerp(self.ground, fade);
        }
        let rise = (1.0 - direction.y).powi(4);
        self.zenith.lerp(self.horizon, rise) + haze + lobe
    }
}

/// The inverse of the map's convention, see [`Environment`].
fn map_direction(u: f32, v: f32) -> Vec3 {
    let (sin_polar, cos_polar) = (PI * v).sin_cos();
    let (sin_turn, cos_turn) = (TAU * (u - 0.5)).sin_cos();
    Vec3::new(sin_polar * sin_turn, cos_polar, -sin_polar * cos_turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_follow_the_maps_convention() {
        for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.77, 0.9), (0.25, 0.4)] {
            let d = map_direction(u, v);
            assert!((0.5 + d.x.atan2(-d.z) / TAU - u).abs() < 1e-6);
            assert!((d.y.acos() / PI - v).abs() < 1e-6);
        }
    }
}
