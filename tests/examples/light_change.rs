//! How long does ReSTIR GI remember light that is gone? Error of each frame around a jump of the sun, with and without validation
//! (Ouyang et al. 2021, figure 11).
//!
//! ```text
//! cargo run -p aquifer-tests --example light_change -- FILE COMMIT DATE
//! ```
//!
//! The sun of sunlit_wall jumps in the frame after one of validation: the worst moment. Errors are mean square errors against path tracing under the new
//! sun, medians over seeds; "converged" is the median of frames 50 to 60 after the jump with validation.

use aquifer_lab::{film::Film, stats::error::mse};
use aquifer_render::{Context, View};
use aquifer_scene::{Channel, Interpolation, Scene, Track};
use aquifer_tests::{
    Parts, context,
    evidence::Evidence,
    seeds::{film_of, path_traced_film},
};
use glam::{Quat, Vec3};
use serde_json::{Value, json};
use std::sync::Arc;

/// With validation first.
const GRAPHS: [&str; 3] = ["restir_gi_validated", "restir_gi", "restir_gi_unbiased"];
/// Every sixth frame validates, from frame 0 on.
const JUMP: u32 = 31;
const AFTER: u32 = 60;
const STEP: f32 = 1.0 / 60.0;
const SEEDS: u64 = 32;
/// Of eight paths each.
const REFERENCE_FRAMES: u32 = 2048;
/// Towards where the sun shines after the jump: more slanting, so that it reaches less of the wall.
const SHINES: Vec3 = Vec3::new(-0.45, -0.86, -0.24);

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, commit, date] = &arguments[..] else {
        eprintln!("light_change FILE COMMIT DATE");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut evidence = Evidence::open(file, commit, date, &context);
    let scene = jumping();
    let held = View { time: (JUMP + AFTER) as f32 * STEP, centred: true, ..View::default() };
    let path_tracer = "extends = 'path_tracer.toml'\ntransport = 'indirect:2'";
    let reference = path_traced_film(&context, &scene, path_tracer, REFERENCE_FRAMES, held);
    let traces = GRAPHS.map(|graph| trace(&context, &scene, graph, &reference));
    let converged = median(traces[0][50..=AFTER as usize].to_vec());
    for (graph, errors) in GRAPHS.into_iter().zip(&traces) {
        // For good, that is: how many frames after the jump the error is above twice the converged one for the last time.
        let last = errors.iter().rposition(|error| *error > 2.0 * converged).map_or(0, |frame| frame + 1);
        let own = median(errors[50..=AFTER as usize].to_vec());
        let found: Vec<Value> = errors.iter().map(|error| json!((error / converged * 1e3).round() / 1e3)).collect();
        eprintln!("{graph}: below twice the converged error from frame {last} on; {found:?}");
        evidence.put(
            json!({ "scene": "sunlit_wall", "graph": graph, "transport": "indirect:2" }),
            json!({ "seeds": SEEDS, "converged MSE": converged, "own MSE of frames 50 to 60": own, "frames above twice": last, "error / converged by frame": found }),
        );
    }
}

/// Frame 0 of the result is the one of the jump.
fn trace(context: &Context, scene: &Arc<Scene>, graph: &str, reference: &Film) -> Vec<f64> {
    let graph = format!("extends = '{graph}.toml'\ntransport = 'indirect:2'");
    let view = View { step: STEP, centred: true, ..View::default() };
    let mut renderer = Parts { keep: &["shade.color"], view, ..Parts::new(scene, &graph) }.renderer(context);
    let mut errors = vec![Vec::new(); AFTER as usize + 1];
    for seed in 0..SEEDS {
        renderer.reseed(seed).unwrap_or_else(|error| panic!("{error}"));
        for frame in 0..=JUMP + AFTER {
            renderer.frame().unwrap_or_else(|error| panic!("{error}"));
            let Some(after) = frame.checked_sub(JUMP) else { continue };
            let film = film_of(&mut renderer, "shade.color");
            errors[after as usize].push(mse(&film, reference).expect("films of one size").value());
        }
    }
    errors.into_iter().map(median).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// sunlit_wall, whose sun turns at once, half a frame before frame `JUMP`.
fn jumping() -> Arc<Scene> {
    let mut scene = (aquifer_scenes::by_name("sunlit_wall").expect("a built-in scene").make)();
    let sun = scene.nodes.iter().position(|node| node.light.is_some()).expect("it has a sun");
    let before = scene.nodes[sun].rotation;
    let track = Track::Rotation(vec![before, Quat::from_rotation_arc(Vec3::NEG_Z, SHINES.normalize())]);
    let times = vec![0.0, (JUMP as f32 - 0.5) * STEP];
    scene.animation.push(Channel { node: sun as u32, track, times, interpolation: Interpolation::Step });
    Arc::new(scene.finish().expect("a built-in scene"))
}
