//! Reconnection: hemisphere samples of one point, carried to another, integrate as that one's own do; and what reservoirs keep of them is the same,
//! packed or not.

use aquifer_lab::stats::{Difference, Moments};
use aquifer_tests::{Parts, context, scene};

const KERNEL: &str = include_str!("reconnection.wgsl");
const CASES: usize = 6;

/// For every case of the kernel, by how much carried samples differ from own ones; `None` without an adapter.
fn differences(jacobian: &str) -> Option<Vec<Difference>> {
    let context = context()?;
    let scene = scene("cornell");
    let graph = "transport = 'emission'\noutput = 'reconnection.estimates'\n[slots]\ndomain = 'gi'\n[pass.reconnection]";
    let setting = format!("reconnection.jacobian={jacobian}");
    let parts = Parts { shaders: &[("pass/reconnection", KERNEL)], settings: &[&setting], ..Parts::new(&scene, graph) };
    let mut renderer = parts.renderer(&context);
    renderer.frame().unwrap();
    let words = renderer.read_f32("reconnection.estimates").unwrap();
    let of = |case: usize| {
        let pairs = words.chunks_exact(2).skip(case).step_by(CASES);
        let apart: Moments = pairs.clone().map(|pair| f64::from(pair[0]) - f64::from(pair[1])).collect();
        let own: Moments = pairs.map(|pair| f64::from(pair[1])).collect();
        Difference::normal(apart.mean(), apart.standard_error()).relative_to(own.mean())
    };
    let found: Vec<Difference> = (0..CASES).map(of).collect();
    for (case, found) in found.iter().enumerate() {
        eprintln!("Jacobian {jacobian}, case {case}: {:+.3} % ± {:.3} %", 100.0 * found.value, 100.0 * found.standard_error);
    }
    Some(found)
}

#[test]
fn carried_samples_integrate_as_own_ones() {
    let Some(found) = differences("on") else { return };
    for (case, found) in found.iter().enumerate() {
        assert!(found.standard_error < 0.03, "case {case} resolves only {}", found.standard_error);
        assert!(found.score(0.0).abs() < 4.0, "case {case}: {found:?}");
    }
}

#[test]
fn other_jacobians_do_not() {
    for jacobian in ["off", "inverted"] {
        let Some(found) = differences(jacobian) else { return };
        for (case, found) in found.iter().enumerate() {
            assert!(found.score(0.0).abs() > 10.0, "{jacobian}, case {case}: {found:?}");
        }
    }
}

/// The same path ends as they are: 80 bytes, with what their alignment leaves open, where the tree's are 40.
const UNPACKED: &str = "
struct PathEnd { position: vec3<f32>, size: f32, normal: vec3<f32>, radiance: vec3<f32>, seed: vec2<u32>, back: vec3<f32>, distance: f32 }
struct Cached { end: PathEnd }
fn keep(e: PathEnd) -> Cached { return Cached(e); }
fn recall(c: Cached) -> PathEnd { return c.end; }
";

#[test]
fn packing_changes_no_radiance() {
    let Some(context) = context() else { return };
    let scene = scene("cornell");
    let graph = "extends = 'restir_gi_initial.toml'";
    let image = |shaders: &[(&str, &str)]| {
        let mut renderer = Parts { shaders, keep: &["shade.color"], ..Parts::new(&scene, graph) }.renderer(&context);
        renderer.frame().unwrap();
        renderer.read_f32("shade.color").unwrap()
    };
    let (packed, whole) = (image(&[]), image(&[("cached", UNPACKED)]));
    let mut lit = 0;
    for (packed, whole) in packed.chunks_exact(4).zip(whole.chunks_exact(4)) {
        let largest = whole[0].max(whole[1]).max(whole[2]);
        lit += u32::from(largest > 0.0);
        // Half a step of 16 bits in the share of blue, as a part of the largest channel: 0.5 / 65,535 / 0.0722, and rounding of positions.
        let apart = (0..3).map(|channel| (packed[channel] - whole[channel]).abs()).fold(0.0, f32::max);
        assert!(apart <= 2e-4 * largest, "{packed:?} and {whole:?}");
    }
    assert!(lit > 1000, "only {lit} pixels are lit");
}

#[test]
fn radiance_of_any_magnitude_survives() {
    const KERNEL: &str = "
import package::base::pack::{pack_radiance, unpack_radiance};
/// @extent fixed 240
@group(1) @binding(0) var<storage, read_write> errors: array<f32>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= 240u) { return; }
    let colours = array<vec3<f32>, 4>(vec3<f32>(1.0), vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(0.3, 0.9, 0.01));
    let c = colours[id.x % 4u] * pow(10.0, f32(id.x / 4u) - 30.0);
    let apart = abs(unpack_radiance(pack_radiance(c)) - c);
    errors[id.x] = max(apart.x, max(apart.y, apart.z)) / max(c.x, max(c.y, c.z));
}
";
    let Some(context) = context() else { return };
    let scene = scene("cornell");
    let graph = "transport = 'emission'\noutput = 'pack.errors'\n[pass.pack]";
    let mut renderer = Parts { shaders: &[("pass/pack", KERNEL)], ..Parts::new(&scene, graph) }.renderer(&context);
    renderer.frame().unwrap();
    let errors = renderer.read_f32("pack.errors").unwrap();
    for (i, error) in errors.iter().enumerate() {
        assert!(*error <= 2e-4, "10^{}, colour {}: {error}", i as i32 / 4 - 30, i % 4);
    }
}
