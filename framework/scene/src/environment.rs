//! Sampling directions by the light that comes from them.

use crate::{AliasTable, Environment, emission::luminance};
use glam::Vec3;
use std::f64::consts::PI;

/// Draws directions in proportion to an environment's luminance, texel by texel, evenly in solid angle within a texel.
///
/// The probability density per steradian is `pmf[texel] / texel_solid_angle(row)`: constant over a texel, with no singularity at the
/// poles. Weights are means of the *bilinearly filtered* map, so that wherever that is positive, so is the density.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentDistribution {
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// One entry a texel, row by row from the top; empty when the map is black.
    pub table: AliasTable,
    mean_luminance: f64,
}

impl EnvironmentDistribution {
    /// Of a map that [`crate::Scene::finish`] has checked.
    pub fn new(environment: &Environment) -> Self {
        let (width, height) = (environment.width, environment.height);
        let lumas: Vec<f64> = environment.radiance.iter().map(|&texel| luminance(texel).into()).collect();
        let mut weights = filtered(&lumas, width as usize, height as usize);
        for (row, texels) in weights.chunks_exact_mut(width as usize).enumerate() {
            let solid_angle = solid_angle(row as u32, width, height);
            texels.iter_mut().for_each(|weight| *weight *= solid_angle);
        }
        let mean_luminance = weights.iter().sum::<f64>() / (4.0 * PI);
        Self { width, height, table: AliasTable::new(&weights), mean_luminance }
    }

    /// Luminance averaged over the sphere of directions.
    pub fn mean_luminance(&self) -> f64 {
        self.mean_luminance
    }

    /// Steradians of each texel in `row`.
    pub fn texel_solid_angle(&self, row: u32) -> f32 {
        solid_angle(row, self.width, self.height) as f32
    }

    /// Probability density per steradian of a direction in the map's frame.
    pub fn pdf(&self, direction: Vec3) -> f32 {
        let [u, v] = Environment::uv(direction);
        let column = ((u * self.width as f32) as u32).min(self.width - 1);
        let row = ((v * self.height as f32) as u32).min(self.height - 1);
        let entry = self.table.entries.get((row * self.width + column) as usize);
        entry.map_or(0.0, |entry| entry.pmf / self.texel_solid_angle(row))
    }

    /// A unit direction in the map's frame from four numbers in \[0, 1): two choose the texel, two the place in it.
    pub fn sample(&self, u: [f32; 4]) -> Option<Vec3> {
        let texel = self.table.sample(u[0], u[1])?;
        let (column, row) = (texel % self.width, texel / self.width);
        let cos = |row: u32| (std::f32::consts::PI * row as f32 / self.height as f32).cos();
        let y = cos(row) + u[3] * (cos(row + 1) - cos(row));
        let phi = std::f32::consts::TAU * ((column as f32 + u[2]) / self.width as f32 - 0.5);
        let sin = (1.0 - y * y).max(0.0).sqrt();
        Some(Vec3::new(sin * phi.sin(), y, -sin * phi.cos()))
    }
}

impl Environment {
    /// Texture coordinates in \[0, 1\] of a unit direction in the map's frame.
    pub fn uv(direction: Vec3) -> [f32; 2] {
        let u = 0.5 + direction.x.atan2(-direction.z) / std::f32::consts::TAU;
        [u, direction.y.clamp(-1.0, 1.0).acos() / std::f32::consts::PI]
    }
}

fn solid_angle(row: u32, width: u32, height: u32) -> f64 {
    let cos = |row: u32| (PI * f64::from(row) / f64::from(height)).cos();
    2.0 * PI / f64::from(width) * (cos(row) - cos(row + 1))
}

/// Mean of the bilinear interpolation over each texel: 1/8, 6/8, 1/8 along each axis; round in u, held at the poles.
fn filtered(values: &[f64], width: usize, height: usize) -> Vec<f64> {
    let tap = |low: f64, mid: f64, high: f64| 0.125 * low + 0.75 * mid + 0.125 * high;
    let across: Vec<f64> = (0..values.len())
        .map(|index| {
            let (row, x) = (index / width * width, index % width);
            tap(values[row + (x + width - 1) % width], values[index], values[row + (x + 1) % width])
        })
        .collect();
    let down = |index: usize| {
        let (y, x) = (index / width, index % width);
        let at = |y: usize| across[y * width + x];
        tap(at(y.saturating_sub(1)), at(y), at((y + 1).min(height - 1)))
    };
    (0..values.len()).map(down).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Mat3;

    fn map() -> Environment {
        let (width, height) = (16, 8);
        let texel = |i: u32| [0.1, 1.0 + (i % 16) as f32, if i == 37 { 500.0 } else { 0.0 }];
        let radiance = (0..width * height).map(texel).collect();
        Environment { name: String::new(), width, height, radiance, world_to_map: Mat3::IDENTITY }
    }

    #[test]
    fn the_density_integrates_to_one() {
        let distribution = EnvironmentDistribution::new(&map());
        let mut sum = 0.0;
        for row in 0..8 {
            for column in 0..16 {
                let u = std::f32::consts::TAU * ((column as f32 + 0.5) / 16.0 - 0.5);
                let v = std::f32::consts::PI * (row as f32 + 0.5) / 8.0;
                let direction = Vec3::new(v.sin() * u.sin(), v.cos(), -v.sin() * u.cos());
                sum += distribution.pdf(direction) * distribution.texel_solid_angle(row);
            }
        }
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        let sphere: f32 = (0..8).map(|row| 16.0 * distribution.texel_solid_angle(row)).sum();
        assert!((sphere - 4.0 * std::f32::consts::PI).abs() < 1e-4);
    }

    #[test]
    fn samples_fall_where_the_density_says() {
        let distribution = EnvironmentDistribution::new(&map());
        // ∫ g dω by importance sampling against the closed form 4π/3 of g = y².
        let steps = 96;
        let mut sum = 0.0_f64;
        for texel in 0..steps * steps {
            for place in 0..16 {
                let (a, b) = (texel % steps, texel / steps);
                let u = [
                    (a as f32 + 0.5) / steps as f32,
                    (b as f32 + 0.5) / steps as f32,
                    (place % 4) as f32 / 4.0 + 0.125,
                    (place / 4) as f32 / 4.0 + 0.125,
                ];
                let direction = distribution.sample(u).unwrap();
                assert!((direction.length() - 1.0).abs() < 1e-5);
                sum += f64::from(direction.y * direction.y / distribution.pdf(direction));
            }
        }
        let found = sum / f64::from(steps * steps * 16);
        assert!((found / (4.0 * PI / 3.0) - 1.0).abs() < 0.02, "{found}");
    }

    #[test]
    fn wherever_the_filtered_map_is_bright_the_density_is_positive() {
        let mut environment = map();
        environment.radiance.fill([0.0; 3]);
        environment.radiance[3 * 16 + 15] = [1.0; 3];
        let distribution = EnvironmentDistribution::new(&environment);
        for (row, column) in [(2, 14), (2, 15), (2, 0), (3, 0), (4, 0), (4, 14)] {
            assert!(distribution.table.entries[row * 16 + column].pmf > 0.0);
        }
        assert_eq!(distribution.table.entries[3 * 16 + 2].pmf, 0.0);
    }

    #[test]
    fn a_constant_map_is_its_own_mean_and_a_black_one_has_no_table() {
        let mut environment = map();
        environment.radiance.fill([2.0; 3]);
        assert!((EnvironmentDistribution::new(&environment).mean_luminance() - 2.0).abs() < 1e-6);
        environment.radiance.fill([0.0; 3]);
        let black = EnvironmentDistribution::new(&environment);
        assert!(black.table.is_empty() && black.sample([0.5; 4]).is_none() && black.pdf(Vec3::Y) == 0.0);
    }

    #[test]
    fn directions_and_coordinates_agree_with_the_documented_mapping() {
        assert_eq!(Environment::uv(Vec3::NEG_Z), [0.5, 0.5]);
        assert_eq!(Environment::uv(Vec3::X), [0.75, 0.5]);
        assert_eq!(Environment::uv(Vec3::Y)[1], 0.0);
    }
}
