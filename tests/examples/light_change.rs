//! How long does ReSTIR GI remember light that is gone? Error of each frame around a jump of the sun, with and without validation
//! (Ouyang et al. 2021, figure 11).
//!
//! ```text
//! cargo run -p aquifer-tests --example light_change -- FILE COMMIT DATE
//! ```
//!
//! The sun of sunlit_wall goes out in the frame after one of validation. A second sun, of a tenth of its light, shines all the
//! time: samples of the light that is gone outweigh whatever is drawn of the light that is left. Errors are mean square errors against path tracing
//! under what is left, medians over seeds; "converged" is the median of frames 50 to 60 after the change with validation.

use aquifer_lab::{film::Film, stats::error::mse};
use aquifer_render::{Context, View};
use aquifer_scene::{Channel, Interpolation, Node, PunctualLight, Scene, Track};
use aquifer_tests::{
    Parts, context,
    evidence::Evidence,
    seeds::{film_of, path_traced_film},
};
use glam::{Quat, Vec3};
use serde_json::{Value, json};
use std::sync::Arc;

/// Graphs, and what is laid over them; with validation first.
const GRAPHS: [(&str, &str); 7] = [
    ("restir_gi_validated", ""),
    ("restir_gi_validated", "pass.initial.set.redraw = true"),
    ("restir_gi_validated", "pass.initial.set.redraw = true\npass.spatial.set.cap = 60.0"),
    ("restir_gi_validated", "pass.initial.set.redraw = true\npass.spatial.set.cap = 30.0\npass.initial.set.validate_every = 3"),
    ("restir_gi", ""),
    ("restir_gi_tuned", ""),
    ("restir_gi_unbiased", ""),
];
/// Frame 30 validates, also where every third does: the worst moment.
const CHANGE: u32 = 31;
const AFTER: u32 = 60;
const STEP: f32 = 1.0 / 60.0;
const SEEDS: u64 = 32;
/// Of eight paths each.
const REFERENCE_FRAMES: u32 = 2048;
/// Light of the sun that stays, as a share of the one that goes out.
const STAYS: f32 = 0.1;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, commit, date] = &arguments[..] else {
        eprintln!("light_change FILE COMMIT DATE");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut evidence = Evidence::open(file, commit, date, &context);
    let scene = going_out();
    let held = View { time: (CHANGE + AFTER) as f32 * STEP, centred: true, ..View::default() };
    let path_tracer = "extends = 'path_tracer.toml'\ntransport = 'indirect:2'";
    let reference = path_traced_film(&context, &scene, path_tracer, REFERENCE_FRAMES, held);
    let traces = GRAPHS.map(|(graph, line)| trace(&context, &scene, graph, line, &reference));
    let converged = median(traces[0][50..=AFTER as usize].to_vec());
    for ((graph, line), errors) in GRAPHS.into_iter().zip(&traces) {
        // For good, that is: how many frames after the change the error is above twice the converged one for the last time.
        let last = |converged: f64| errors.iter().rposition(|error| *error > 2.0 * converged).map_or(0, |frame| frame + 1);
        let own = median(errors[50..=AFTER as usize].to_vec());
        let found: Vec<Value> = errors.iter().map(|error| json!((error / converged * 1e3).round() / 1e3)).collect();
        eprintln!(
            "{graph} {line}: below twice the converged error from frame {} on, its own from {}; {found:?}",
            last(converged),
            last(own)
        );
        evidence.put(
            json!({ "scene": "sunlit_wall", "graph": graph, "line": line, "transport": "indirect:2" }),
            json!({ "seeds": SEEDS, "converged MSE": converged, "own MSE of frames 50 to 60": own, "frames above twice": last(converged), "frames above twice its own": last(own), "error / converged by frame": found }),
        );
    }
}

/// Frame 0 of the result is the one of the change.
fn trace(context: &Context, scene: &Arc<Scene>, graph: &str, line: &str, reference: &Film) -> Vec<f64> {
    let graph = format!("extends = '{graph}.toml'\ntransport = 'indirect:2'\n{line}");
    let view = View { step: STEP, centred: true, ..View::default() };
    let mut renderer = Parts { keep: &["shade.color"], view, ..Parts::new(scene, &graph) }.renderer(context);
    let mut errors = vec![Vec::new(); AFTER as usize + 1];
    for seed in 0..SEEDS {
        renderer.reseed(seed).unwrap_or_else(|error| panic!("{error}"));
        for frame in 0..=CHANGE + AFTER {
            renderer.frame().unwrap_or_else(|error| panic!("{error}"));
            let Some(after) = frame.checked_sub(CHANGE) else { continue };
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

/// sunlit_wall, whose sun shines from below the floor from half a frame before frame `CHANGE` on, and which has a dim second one beside it.
fn going_out() -> Arc<Scene> {
    let mut scene = (aquifer_scenes::by_name("sunlit_wall").expect("a built-in scene").make)();
    let sun = scene.nodes.iter().position(|node| node.light.is_some()).expect("it has a sun");
    let bright = scene.lights[scene.nodes[sun].light.expect("it has one") as usize].clone();
    scene.lights.push(PunctualLight { name: "what stays".into(), intensity: bright.intensity * STAYS, ..bright });
    let second = Node { name: "what stays".into(), light: Some(scene.lights.len() as u32 - 1), ..scene.nodes[sun].clone() };
    scene.nodes.push(second);
    let out = Quat::from_rotation_arc(Vec3::NEG_Z, Vec3::Y);
    let track = Track::Rotation(vec![scene.nodes[sun].rotation, out]);
    let times = vec![0.0, (CHANGE as f32 - 0.5) * STEP];
    scene.animation.push(Channel { node: sun as u32, track, times, interpolation: Interpolation::Step });
    Arc::new(scene.finish().expect("a built-in scene"))
}
