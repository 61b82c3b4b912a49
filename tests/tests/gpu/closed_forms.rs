//! Direct light against textbook integrals.

use crate::stage::Stage;
use aquifer_scene::Scene;
use aquifer_tests::{Parts, context, mean_of};
use glam::Vec3;
use std::{f32::consts::TAU, sync::Arc};

const GRAPH: &str = "extends = 'path_tracer.toml'\ntransport = 'direct'\noutput = 'accumulate.image'\n[pass.tonemap]\nremove = true";

/// Asserts that the mean of the image is `expected`, resolved to 0.1 %.
fn check(name: &str, scene: &Arc<Scene>, size: [u32; 2], frames: u32, expected: f64) {
    let Some(context) = context() else { return };
    mean_of(&Parts { size, ..Parts::new(scene, GRAPH) }.film(&context, frames), 0).assert_is(name, expected, 1e-3, 2e-4);
}

/// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11, for equal squares of side x at unit distance.
fn squares(x: f64) -> f64 {
    let root = (1.0 + x * x).sqrt();
    2.0 / (std::f64::consts::PI * x * x)
        * ((root * root / (1.0 + 2.0 * x * x).sqrt()).ln() + 2.0 * x * root * (x / root).atan() - 2.0 * x * x.atan())
}

#[test]
fn parallel_plates_exchange_their_form_factor() {
    assert!((squares(1.0) - 0.199_825).abs() < 1e-5, "the textbook's value");
    for distance in [1.0_f32, 0.4] {
        let mut stage = Stage::default();
        let (white, lamp) = (stage.diffuse(1.0, 0.0), stage.diffuse(0.0, 2.0));
        stage.square(Vec3::ZERO, Vec3::Y, 0.5, white);
        stage.square(Vec3::Y * distance, Vec3::NEG_Y, 0.5, lamp);
        // A plane parallel to the film is imaged evenly: the mean over pixels is the mean over the plate.
        let height = distance * 0.5;
        stage.camera(Vec3::Y * height, Vec3::ZERO, 2.0 * (0.5 / height).atan());
        check("plates", &stage.finish(), [32, 32], 2048, 2.0 * squares(1.0 / f64::from(distance)));
    }
}

#[test]
fn a_disk_lights_the_point_below_it() {
    let (radius, height) = (0.7_f32, 1.3_f32);
    let corners = 1024_u16;
    let ring: Vec<Vec3> = (0..corners)
        .map(|i| {
            let phi = TAU * f32::from(i) / f32::from(corners);
            Vec3::new(radius * phi.cos(), height, radius * phi.sin())
        })
        .collect();
    let mut stage = Stage::default();
    let (white, lamp) = (stage.diffuse(0.8, 0.0), stage.diffuse(0.0, 3.0));
    stage.square(Vec3::ZERO, Vec3::Y, 0.1, white);
    stage.polygon(&ring, lamp);
    stage.camera(Vec3::new(0.5, 0.4, 0.0), Vec3::ZERO, 1e-3);
    let r2 = f64::from(radius * radius);
    // E = π L sin²θ, out = ρ/π E.
    check("disk", &stage.finish(), [64, 64], 64, 0.8 * 3.0 * r2 / (r2 + f64::from(height * height)));
}

#[test]
fn a_sphere_lights_the_point_below_it() {
    let (radius, distance) = (0.5_f32, 1.5_f32);
    let (rings, turns) = (128_u32, 256_u32);
    let mut positions = Vec::new();
    for i in 0..=rings {
        let theta = std::f32::consts::PI * i as f32 / rings as f32;
        for j in 0..turns {
            let phi = TAU * j as f32 / turns as f32;
            positions.push(Vec3::Y * distance + radius * Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..rings {
        for j in 0..turns {
            let (a, b) = (i * turns + j, i * turns + (j + 1) % turns);
            let (c, d) = (a + turns, b + turns);
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    let mut stage = Stage::default();
    let (white, lamp) = (stage.diffuse(0.8, 0.0), stage.diffuse(0.0, 3.0));
    stage.square(Vec3::ZERO, Vec3::Y, 0.1, white);
    stage.triangles(positions, triangles, lamp);
    stage.camera(Vec3::new(0.5, 0.4, 0.0), Vec3::ZERO, 1e-3);
    // Half of a sphere's triangles face away: light sampling wastes half its samples, so more frames.
    let ratio = f64::from(radius / distance);
    check("sphere", &stage.finish(), [64, 64], 768, 0.8 * 3.0 * ratio * ratio);
}
