//! Smooth noise from a hash, the same on every machine.

use glam::{IVec3, Vec2, Vec3};

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
        let corner = |x, y, z| self.lattice(cell + IVec3::new(x, y, z));
        let along_x = |y, z| mix(corner(0, y, z), corner(1, y, z), blend.x);
        let along_y = |z| mix(along_x(0, z), along_x(1, z), blend.y);
        mix(along_y(0), along_y(1), blend.z)
    }

    /// Several octaves, each twice as fine and half as strong, normalised to \[0, 1\].
    pub fn fractal(&self, point: Vec3, octaves: u32) -> f32 {
        let (mut sum, mut total, mut layer, mut point) = (0.0, 0.0, *self, point);
        for octave in 0..octaves {
            let weight = 0.5_f32.powi(octave as i32);
            sum += weight * layer.at(point);
            total += weight;
            point *= 2.0;
            layer = Self { seed: layer.seed.wrapping_add(1), period: layer.period.map(|p| p * 2) };
        }
        sum / total
    }

    /// [`Noise::fractal`] over a plane.
    pub fn plane(&self, point: Vec2, octaves: u32) -> f32 {
        self.fractal(point.extend(0.5), octaves)
    }

    fn lattice(&self, cell: IVec3) -> f32 {
        let cell = self.period.map_or(cell, |period| cell.rem_euclid(IVec3::splat(period)));
        let mixed = [cell.x, cell.y, cell.z].iter().fold(self.seed, |hash, c| pcg(hash ^ pcg(*c as u32)));
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
        }
    }
}
