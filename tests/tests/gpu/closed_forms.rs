//! Direct light against textbook integrals.

use crate::stage::Stage;
use aquifer_scene::{Alpha, Material, PunctualLight, PunctualShape, Scene};
use aquifer_tests::{Parts, context, mean_of};
use glam::{Vec3, Vec4};
use std::{f32::consts::TAU, sync::Arc};

const GRAPH: &str = "extends = 'path_tracer.toml'\ntransport = 'direct'\noutput = 'accumulate.image'\n[pass.tonemap]\nremove = true";

/// Candidates of the lights' proposal and of the BSDF's rays, mixed.
const MIXED: &str = "extends = 'ris_only.toml'\ntransport = 'direct'\nslots.visibility = 'in_target'\n[pass.initial]\nset.candidates = 4\nset.bsdf_rays = 2";

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
        check("plates", &plates(distance, Alpha::Opaque, 1.0), [32, 32], 2048, 2.0 * squares(1.0 / f64::from(distance)));
    }
}

/// A white square of side 1, and one above it that shines down on it with radiance 2.
fn plates(distance: f32, alpha: Alpha, opacity: f32) -> Arc<Scene> {
    let mut stage = Stage::default();
    let white = stage.diffuse(1.0, 0.0);
    let black = Vec4::new(0.0, 0.0, 0.0, opacity);
    let lamp = stage.material(Material {
        base_color: black,
        metallic: 0.0,
        specular: 0.0,
        emission: Vec3::splat(2.0),
        alpha,
        ..Material::default()
    });
    stage.square(Vec3::ZERO, Vec3::Y, 0.5, white);
    stage.square(Vec3::Y * distance, Vec3::NEG_Y, 0.5, lamp);
    // A plane parallel to the film is imaged evenly: the mean over pixels is the mean over the plate.
    let height = distance * 0.5;
    stage.camera(Vec3::Y * height, Vec3::ZERO, 2.0 * (0.5 / height).atan());
    stage.finish()
}

/// Where a lamp is a hole, nothing shines, however its points are drawn.
#[test]
fn holes_of_lamps_do_not_shine() {
    let Some(context) = context() else { return };
    let full = 2.0 * squares(1.0 / 0.4);
    for graph in [GRAPH, MIXED] {
        let check = |name: &str, scene: &Arc<Scene>, expected: f64| {
            let film = Parts { size: [32, 32], ..Parts::new(scene, graph) }.film(&context, 192);
            mean_of(&film, 0).assert_is(name, expected, 8e-3, 2e-4);
        };
        check("a quarter is there", &plates(0.4, Alpha::Blend, 0.25), 0.25 * full);
        check("opacity above the cutoff", &plates(0.4, Alpha::Mask { cutoff: 0.5 }, 0.75), full);
    }
    let hole = plates(0.4, Alpha::Mask { cutoff: 0.5 }, 0.25);
    for graph in [GRAPH, MIXED] {
        let film = Parts { size: [32, 32], ..Parts::new(&hole, graph) }.film(&context, 4);
        assert_eq!(mean_of(&film, 0).value, 0.0, "opacity below the cutoff");
    }
}

/// Radiance from a white square at the origin that one light shines on from `from`, along `along`.
fn lit_by(shape: PunctualShape, range: Option<f32>, from: Vec3, along: Vec3) -> Arc<Scene> {
    let mut stage = Stage::default();
    let white = stage.diffuse(1.0, 0.0);
    stage.square(Vec3::ZERO, Vec3::Y, 0.1, white);
    stage.punctual(PunctualLight { name: "lamp".into(), intensity: Vec3::splat(3.0), shape, range }, from, along);
    stage.camera(Vec3::new(0.5, 0.4, 0.0), Vec3::ZERO, 1e-4);
    stage.finish()
}

/// KHR_lights_punctual: lux and candela, the cone's edge, the window of the range.
#[test]
fn punctual_lights_follow_their_extension() {
    use std::f64::consts::PI;
    let (from, intensity) = (Vec3::new(0.6, 0.8, 0.0) * 2.0, 3.0);
    let check = |name: &str, shape, range, along: Vec3, expected: f64| {
        check(name, &lit_by(shape, range, from, along), [8, 8], 2, expected);
    };
    check("directional", PunctualShape::Directional, None, -from, intensity * 0.8 / PI);
    let point = intensity * 0.8 / (PI * 4.0);
    check("point", PunctualShape::Point, None, -from, point);
    check("point with a range", PunctualShape::Point, Some(2.5), -from, point * (1.0 - (2.0_f64 / 2.5).powi(4)));
    let (inner, outer) = (0.2_f32, 0.5_f32);
    for (off, share) in [(0.1, 1.0), (0.35, edge(0.35, inner, outer)), (0.45, edge(0.45, inner, outer))] {
        let along = glam::Quat::from_rotation_z(off) * -from;
        check("spot", PunctualShape::Spot { inner, outer }, None, along, point * share);
    }
    let Some(context) = context() else { return };
    let beyond = glam::Quat::from_rotation_z(0.55) * -from;
    for (shape, range, along) in [(PunctualShape::Spot { inner, outer }, None, beyond), (PunctualShape::Point, Some(1.9), -from)] {
        let film = Parts { size: [8, 8], ..Parts::new(&lit_by(shape, range, from, along), GRAPH) }.film(&context, 2);
        assert_eq!(mean_of(&film, 0).value, 0.0, "{shape:?}, {range:?}");
    }
}

/// The extension's smooth edge of a cone, at `off` radians from its axis.
fn edge(off: f32, inner: f32, outer: f32) -> f64 {
    let [off, inner, outer] = [off, inner, outer].map(|angle| f64::from(angle).cos());
    ((off - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2)
}

/// Nothing to hit is no fault: what a camera sees is the sky.
#[test]
fn an_empty_scene_shows_its_sky() {
    let Some(context) = context() else { return };
    let mut stage = Stage::default();
    stage.sky(0.75);
    stage.camera(Vec3::ZERO, Vec3::NEG_Z, 1.0);
    let graph = GRAPH.replace("'direct'", "'full:2'");
    let film = Parts { size: [8, 8], ..Parts::new(&stage.finish(), &graph) }.film(&context, 2);
    mean_of(&film, 0).assert_is("sky", 0.75, 1e-3, 1e-4);
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
