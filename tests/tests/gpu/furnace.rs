//! Furnaces: uniform light in, a known radiance out.
//!
//! In a closed room whose walls all emit E and reflect the share ρ diffusely, the light of paths with k scatterings is E ρᵏ everywhere. Every
//! transport is a partial sum, and the sums add up: emission + direct + indirect:N = full:N.
//!
//! Under a white sky a plane shows its directional albedo, which is integrated here from the specification's formulas in f64.

use crate::stage::Stage;
use aquifer_scene::Material;
use aquifer_tests::{Parts, context, mean_of};
use glam::{Vec3, Vec4};

const GRAPH: &str = "extends = 'path_tracer.toml'\noutput = 'accumulate.image'\n[pass.tonemap]\nremove = true";

#[test]
fn a_closed_room_holds_the_geometric_series() {
    let (emission, albedo) = (0.5_f32, 0.5_f32);
    let mut stage = Stage::default();
    let wall = stage.diffuse(albedo, emission);
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        stage.square(axis, -axis, 1.0, wall);
        stage.square(-axis, axis, 1.0, wall);
    }
    stage.camera(Vec3::new(0.3, 0.2, 0.5), Vec3::new(-0.4, -0.3, -1.0), 1.2);
    let scene = stage.finish();
    let light = |k: i32| f64::from(emission) * f64::from(albedo).powi(k);
    let series = |from: i32, to: i32| (from..=to).map(light).sum::<f64>();
    for (transport, expected) in
        [("emission", light(0)), ("direct", light(1)), ("indirect:2", series(2, 3)), ("full:0", series(0, 1)), ("full:6", series(0, 7))]
    {
        let setting = format!("transport={transport}");
        let parts = Parts { settings: &[&setting], size: [32, 18], ..Parts::new(&scene, GRAPH) };
        let Some(context) = context() else { return };
        mean_of(&parts.film(&context, 128), 1).assert_is(transport, expected, 2e-3, 1e-5);
    }
}

/// f · cos of Appendix B in f64, from the specification's own formulas (not the shader's): v and l unit, z the normal.
fn appendix_b(m: &Material, v: [f64; 3], l: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let h = [v[0] + l[0], v[1] + l[1], v[2] + l[2]];
    let length = dot(h, h).sqrt();
    let (n_h, v_h) = (h[2] / length, dot(v, h) / length);
    let alpha2 = f64::from(m.roughness).powi(4);
    let d = alpha2 / (std::f64::consts::PI * (n_h * n_h * (alpha2 - 1.0) + 1.0).powi(2));
    let root = |a: f64, b: f64| a * (b * b * (1.0 - alpha2) + alpha2).sqrt();
    let visibility = 0.5 / (root(l[2], v[2]) + root(v[2], l[2]));
    let base = f64::from(m.base_color.x);
    let f0 = 0.04;
    let weight = (1.0 - v_h.abs()).powi(5);
    let dielectric_fresnel = f0 + (1.0 - f0) * weight;
    let dielectric = (1.0 - dielectric_fresnel) * base / std::f64::consts::PI + dielectric_fresnel * d * visibility;
    let metal = (base + (1.0 - base) * weight) * d * visibility;
    let metallic = f64::from(m.metallic);
    (dielectric * (1.0 - metallic) + metal * metallic) * l[2]
}

/// Directional albedo by the midpoint rule, in coordinates that crowd towards the mirror direction.
fn albedo(m: &Material, cos_v: f64) -> f64 {
    let v = [(1.0 - cos_v * cos_v).sqrt(), 0.0, cos_v];
    let (rings, turns) = (1500, 720);
    let mut sum = 0.0;
    for i in 0..rings {
        // Half vector angles: l = reflect(v, h), dω_l = 4 v·h dω_h; θ_h = (π/2) t³ crowds near the normal.
        let t = (f64::from(i) + 0.5) / f64::from(rings);
        let theta = std::f64::consts::FRAC_PI_2 * t.powi(3);
        let dtheta = std::f64::consts::FRAC_PI_2 * 3.0 * t * t / f64::from(rings);
        for j in 0..turns {
            let phi = std::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(turns);
            let h = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
            let v_h = v[0] * h[0] + v[2] * h[2];
            let l = [2.0 * v_h * h[0] - v[0], 2.0 * v_h * h[1], 2.0 * v_h * h[2] - v[2]];
            if v_h > 0.0 && l[2] > 0.0 {
                sum += appendix_b(m, v, l) * 4.0 * v_h * theta.sin() * dtheta * std::f64::consts::TAU / f64::from(turns);
            }
        }
    }
    sum
}

#[test]
fn under_a_white_sky_every_bsdf_shows_its_albedo() {
    let Some(context) = context() else { return };
    for (base, metallic, roughness) in
        [(1.0, 0.0, 1.0), (0.8, 0.0, 0.4), (1.0, 1.0, 0.15), (1.0, 1.0, 0.6), (0.5, 0.5, 0.3), (1.0, 1.0, 1.0)]
    {
        let material = Material { base_color: Vec4::new(base, base, base, 1.0), metallic, roughness, ..Material::default() };
        for cos_v in [0.95_f32, 0.3] {
            let mut stage = Stage::default();
            let id = stage.material(material.clone());
            stage.square(Vec3::ZERO, Vec3::Y, 10.0, id);
            stage.sky(1.0);
            stage.camera(5.0 * Vec3::new((1.0 - cos_v * cos_v).sqrt(), cos_v, 0.0), Vec3::ZERO, 1e-4);
            let scene = stage.finish();
            let expected = albedo(&material, f64::from(cos_v));
            // The dielectric mix of Appendix B is not bounded by 1 (its diffuse part is weighted by v·h); a metal is.
            assert!(metallic < 1.0 || expected <= 1.0 + 1e-4, "{material:?} gives back {expected}");
            let parts = Parts { settings: &["transport=direct"], size: [128, 128], ..Parts::new(&scene, GRAPH) };
            let what = format!("base {base} metallic {metallic} roughness {roughness} cos {cos_v}");
            mean_of(&parts.film(&context, 32), 1).assert_is(&what, expected, 2e-3, 5e-4);
        }
    }
}
