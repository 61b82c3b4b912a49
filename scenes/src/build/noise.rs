//! Smooth noise from a hash, the same on every machine.

use glam::{Vec2, Vec3};

/// Value noise on the integer lattice with quintic blending, optionally periodic.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    seed: u32,
    period: Option<i32>,
}

impl Noise {
    /// Noise that never repeats.
    pub fn new(seed: u32) -> Self {
        Self { seed, period: None }
    }

    /// Noise that repeats every `cells` units, for images that tile; each octave of [`Noise::fractal`] keeps the period.
    pub fn tiling(seed: u32, cells: i32) -> Self {
        Self { seed, period: Some(cells) }
    }

    /// Noise in \[0, 1\] with features about one unit wide.
    pub fn at(&self, point: Vec3) -> f32 {
        let cell = point.floor();
        let t = point - cell;
        let blend = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let cell = cell.as_ivec3();
        let corner = |x: i32, y: i32, z: i32| self.hash([cell.x + x, cell.y + y, cell.z + z]);
        let along_x = |y, z| mix(corner(0, y, z), corner(1, y, z), blend.x);
        let along_y = |z| mix(along_x(0, z), along_x(1, z), blend.y);
        mix(along_y(0), along_y(1), blend.z)
    }

    /// Several octaves, each twice as fine and half as strong, normalised to \[0, 1\].
    pub fn fractal(&self, point: Vec3, octaves: u32) -> f32 {
        self.octaves(octaves, |layer, scale| layer.at(point * scale))
    }

    /// [`Noise::at`] over a plane.
    pub fn plane_at(&self, point: Vec2) -> f32 {
        let cell = point.floor();
        let t = point - cell;
        let blend = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let cell = cell.as_ivec2();
        let row = |y| mix(self.hash([cell.x, cell.y + y]), self.hash([cell.x + 1, cell.y + y]), blend.x);
        mix(row(0), row(1), blend.y)
    }

    /// [`Noise::fractal`] over a plane.
    pub fn plane(&self, point: Vec2, octaves: u32) -> f32 {
        self.octaves(octaves, |layer, scale| layer.plane_at(point * scale))
    }

    fn octaves(&self, count: u32, value: impl Fn(Self, f32) -> f32) -> f32 {
        let (mut sum, mut total) = (0.0, 0.0);
        for octave in 0..count {
            let weight = 0.5_f32.powi(octave as i32);
            let layer = Self { seed: self.seed.wrapping_add(octave), period: self.period.map(|period| period << octave) };
            sum += weight * value(layer, (1 << octave) as f32);
            total += weight;
        }
        sum / total
    }

    /// The lattice's own value, in \[0, 1).
    fn hash<const N: usize>(&self, cell: [i32; N]) -> f32 {
        let cell = self.period.map_or(cell, |period| cell.map(|c| c.rem_euclid(period)));
        let mixed = cell.into_iter().fold(self.seed, |hash, c| pcg(hash.wrapping_add(c as u32)));
        (mixed >> 8) as f32 / (1 << 24) as f32
    }
}

/// The PCG hash (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
fn pcg(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiling_noise_repeats_and_stays_in_range() {
        let noise = Noise::tiling(3, 4);
        for i in 0..200 {
            let point = Vec2::new(i as f32 * 0.137, i as f32 * 0.071);
            let value = noise.plane(point, 4);
            assert!((0.0..=1.0).contains(&value));
            assert!((value - noise.plane(point + Vec2::splat(4.0), 4)).abs() < 1e-4);
            let solid = noise.fractal(point.extend(0.3), 4);
            assert!((0.0..=1.0).contains(&solid));
            assert!((solid - noise.fractal(point.extend(0.3) - Vec3::splat(4.0), 4)).abs() < 1e-4);
        }
    }
}
