//! Presampled lights: contribution weights without a known density.
//!
//! For any set A of light points that reach the receiver, E[W · 1_A] is A's measure by uv: a property that needs neither the density of the samples nor
//! the light that they carry.

use crate::stage::Stage;
use aquifer_lab::stats::{Difference, Moments, multiple::sidak};
use aquifer_render::Context;
use aquifer_scene::Scene;
use aquifer_tests::{Parts, context};
use glam::Vec3;
use std::sync::Arc;

/// Sets: four groups of lights, each cut into four by four squares of uv.
const GROUPS: usize = 4;
const BINS: usize = 16 * GROUPS;
const WORDS: usize = 8;
const FRAMES: usize = 32;

/// Each invocation is a receiver somewhere in the scene: which set its sample is in, with what weight, and how many lights of each group it sees the front
/// of.
const KERNEL: &str = "
import package::base::rng::{rng_bits, rng_next4};
import package::frame::frame::{NOW};
import package::frame::random::{rng_for};
import package::scene::bounds::{bounds};
import package::slot::lights::{arrive, light_count, light_point};
import package::slot::proposal::{propose};
struct Drawn { measure: vec4<f32>, bin: u32, weight: f32 }
/// @extent fixed 16384
@group(1) @binding(0) var<storage, read_write> drawn: array<Drawn>;
fn reaches(light: u32, uv: vec2<f32>, receiver: vec3<f32>) -> bool {
    return any(arrive(light_point(light, uv, NOW), receiver).value > vec3<f32>(0.0));
}
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&drawn)) { return; }
    var rng = rng_for(id.xy);
    let receiver = mix(bounds.low, bounds.high, rng_next4(&rng).xyz);
    let c = propose(receiver, rng_bits(&rng));
    let square = min(vec2<u32>(c.uv * 4.0), vec2<u32>(3u));
    var d: Drawn;
    d.bin = 16u * (c.light % 4u) + 4u * square.y + square.x;
    if (c.weight > 0.0 && reaches(c.light, c.uv, receiver)) { d.weight = c.weight; }
    for (var light = 0u; light < light_count(); light++) {
        if (reaches(light, vec2<f32>(0.5), receiver)) { d.measure += select(vec4<f32>(0.0), vec4<f32>(1.0 / 16.0), vec4<u32>(0u, 1u, 2u, 3u) == vec4<u32>(light % 4u)); }
    }
    drawn[id.x] = d;
}
";

/// Four lamps of about the same power on the walls of a room, facing in, and a sky: each set is drawn often enough to tell.
fn lamps() -> Arc<Scene> {
    let mut stage = Stage::default();
    let floor = stage.diffuse(0.5, 0.0);
    stage.square(Vec3::ZERO, Vec3::Y, 3.0, floor);
    for (i, out) in [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z].into_iter().enumerate() {
        let lamp = stage.diffuse(0.5, 3.0 + i as f32);
        stage.square(2.0 * out + 1.5 * Vec3::Y, -out, 0.5 + 0.1 * i as f32, lamp);
    }
    stage.sky(0.01);
    stage.camera(Vec3::new(0.0, 1.0, 3.0), Vec3::Y, 1.0);
    stage.finish()
}

/// For every set, and last for their mean: the mean of W · 1_A less A's measure, over the measure, a frame.
fn deviations(context: &Context, grid: Option<&str>) -> Vec<Moments> {
    let scene = lamps();
    let graph = "transport = 'emission'\noutput = 'test_draw.drawn'\nslots.proposal = 'regir'\n[pass.regir]\n[pass.test_draw]\nin.grid = 'regir.grid'";
    let mut shaders = vec![("pass/test_draw", KERNEL)];
    shaders.extend(grid.map(|text| ("pass/regir", text)));
    let mut renderer = Parts { shaders: &shaders, ..Parts::new(&scene, graph) }.renderer(context);
    let mut found = vec![Moments::default(); BINS + 1];
    for _ in 0..FRAMES {
        renderer.frame().unwrap();
        let words = renderer.read_f32("test_draw.drawn").unwrap();
        let (mut weights, mut measures) = ([0.0; BINS], [0.0; GROUPS]);
        for drawn in words.chunks_exact(WORDS) {
            weights[drawn[GROUPS].to_bits() as usize] += f64::from(drawn[GROUPS + 1]);
            measures.iter_mut().zip(drawn).for_each(|(sum, measure)| *sum += f64::from(*measure));
        }
        // Receivers of a cell share its samples: one number a frame.
        let mut shares: Vec<f64> = weights.iter().enumerate().map(|(bin, sum)| sum / measures[bin / 16] - 1.0).collect();
        shares.push(shares.iter().sum::<f64>() / BINS as f64);
        found.iter_mut().zip(shares).for_each(|(moments, share)| moments.push(share));
    }
    found
}

fn difference(moments: &Moments) -> Difference {
    Difference { value: moments.mean(), standard_error: moments.standard_error(), freedom: (moments.count() - 1) as f64 }
}

#[test]
fn weights_average_to_the_measure() {
    let Some(context) = context() else { return };
    let found = deviations(&context, None);
    let all: Vec<Difference> = found.iter().map(difference).collect();
    let worst = |value: fn(&Difference) -> f64| all.iter().map(value).fold(0.0, f64::max);
    eprintln!("{BINS} sets: |W·1_A / A − 1| ≤ {:.4}, standard errors ≤ {:.4}", worst(|d| d.value.abs()), worst(|d| d.standard_error));
    eprintln!("their mean: {:+.4} ± {:.4}", all[BINS].value, all[BINS].standard_error);
    assert!(worst(|d| d.standard_error) < 0.05 && all[BINS].standard_error < 0.005, "resolves too little");
    let alpha = sidak(0.01, all.len());
    assert!(all.iter().all(|found| found.p_different() > alpha), "{all:?}");
}

#[test]
fn a_target_that_forgets_receivers_off_the_centre_is_found() {
    let Some(context) = context() else { return };
    let text = aquifer_shaders::modules().into_iter().find(|(path, _)| path == "pass/regir").expect("in the tree").1;
    let wrong = text.replace("dot(d, p.normal) + reach", "dot(d, p.normal)");
    assert_ne!(text, wrong);
    let found = deviations(&context, Some(&wrong));
    let mean = difference(&found[BINS]);
    eprintln!("receivers off the centre forgotten: {:+.4} ± {:.4}", mean.value, mean.standard_error);
    assert!(mean.score(0.0) <= -5.0, "{mean:?}");
}
