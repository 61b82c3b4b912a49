//! Repeatable random numbers.

use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// PCG32 (O'Neill 2014, XSH-RR output on a 64-bit linear congruential state).
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

const MULTIPLIER: u64 = 6_364_136_223_846_793_005;
const INCREMENT: u64 = 1_442_695_040_888_963_407;

impl Random {
    /// A stream that depends on nothing but the seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Self { state: seed.wrapping_add(INCREMENT) };
        random.bits();
        random
    }

    /// 32 uniform bits.
    pub fn bits(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(MULTIPLIER).wrapping_add(INCREMENT);
        let xorshifted = (((old >> 18) ^ old) >> 27) as u32;
        xorshifted.rotate_right((old >> 59) as u32)
    }

    /// Uniform in \[0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 * (1.0 / (1 << 24) as f32)
    }

    /// Uniform in \[low, high).
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Uniform in 0..count; `count` must not be 0.
    pub fn index(&mut self, count: usize) -> usize {
        ((u64::from(self.bits()) * count as u64) >> 32) as usize
    }

    /// Log-uniform in \[low, high): every decade is as likely as another.
    pub fn decades(&mut self, low: f32, high: f32) -> f32 {
        low * (high / low).powf(self.unit())
    }

    /// Uniform in the unit disk.
    pub fn in_disk(&mut self) -> Vec2 {
        let radius = self.unit().sqrt();
        Vec2::from_angle(self.range(0.0, TAU)) * radius
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> Vec3 {
        let y = self.range(-1.0, 1.0);
        let round = Vec2::from_angle(self.range(0.0, TAU)) * (1.0 - y * y).max(0.0).sqrt();
        Vec3::new(round.x, y, round.y)
    }
}
