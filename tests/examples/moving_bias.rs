//! How much does light that was found in earlier frames bias ReSTIR GI where objects, lights and camera move? Mean of each frame against path tracing at
//! that frame's moment, with and without validation.
//!
//! ```text
//! cargo run -p aquifer-tests --example moving_bias -- FILE COMMIT DATE
//! ```

use aquifer_lab::{
    film::{Film, luminance},
    stats::{Difference, Moments},
};
use aquifer_render::{Context, Renderer, View};
use aquifer_scene::Scene;
use aquifer_tests::{
    Parts, context,
    evidence::Evidence,
    motion::gliding,
    seeds::{film_of, shaded},
};
use serde_json::{Value, json};
use std::sync::Arc;

/// After frame 0, where histories begin.
const FRAMES: [u32; 8] = [1, 2, 4, 8, 16, 24, 32, 48];
const STEP: f32 = 1.0 / 30.0;
const SEEDS: u64 = 128;
/// Of the reference, of eight paths each.
const REFERENCE_SEEDS: u64 = 1024;

/// Surfaces are diffuse, so that light kept at sample points is exact but for motion; sunlit_wall has a few that are not, and its figures hold that too.
const SCENES: [&str; 2] = ["cornell", "sunlit_wall"];
const PLAIN: &str = "extends = 'restir_gi_unbiased.toml'\ntransport = 'indirect:2'\n";
const TRACED: &str = "extends = 'path_tracer.toml'\ntransport = 'indirect:2'\noutput = 'path_tracer.color'\n[pass.accumulate]\nremove = true\n[pass.tonemap]\nremove = true\n";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, commit, date] = &arguments[..] else {
        eprintln!("moving_bias FILE COMMIT DATE");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut evidence = Evidence::open(file, commit, date, &context);
    for name in SCENES {
        let scene = gliding(name, "all moves");
        let truth = FRAMES.map(|frame| truth(&context, &scene, frame));
        for (validation, graph) in [("without", PLAIN.to_owned()), ("with", format!("{PLAIN}{}", validation()))] {
            let found = trace(&context, &scene, &graph);
            let both = FRAMES.iter().zip(found.iter().zip(&truth));
            let rows: Vec<Value> = both.map(|(frame, (ours, truth))| told(*frame, ours, truth)).collect();
            eprintln!("{name}, {validation} validation: {rows:?}");
            evidence.put(json!({ "scene": name, "validation": validation }), json!({ "seeds": SEEDS, "frames": rows }));
        }
    }
}

/// What `restir_gi_validated` adds to the graph that it extends.
fn validation() -> &'static str {
    let (_, text) = aquifer_graphs::files().into_iter().find(|(name, _)| *name == "restir_gi_validated.toml").expect("a built-in graph");
    &text[text.find("[pass.").expect("it sets something of passes")..]
}

fn told(frame: u32, ours: &Moments, truth: &Moments) -> Value {
    let found = Difference::welch(ours, truth).relative_to(truth.mean());
    let percent = |value: f64| (1e4 * value).round() / 100.0;
    json!({ "frame": frame, "bias %": percent(found.value), "standard error %": percent(found.standard_error) })
}

fn mean(film: &Film) -> f64 {
    film.color.iter().map(|color| luminance(color.map(f64::from))).sum::<f64>() / film.pixels() as f64
}

/// Over seeds of one frame each, at the moment of `frame`.
fn truth(context: &Context, scene: &Arc<Scene>, frame: u32) -> Moments {
    let view = View { time: frame as f32 * STEP, ..View::default() };
    let parts = Parts { settings: &["path_tracer.samples=8"], keep: &["path_tracer.color"], view, ..Parts::new(scene, TRACED) };
    let mut renderer = parts.renderer(context);
    (0..REFERENCE_SEEDS).map(|seed| mean(&shaded(&mut renderer, "path_tracer.color", (1 << 40) + seed, 0))).collect()
}

/// The means of each of the frames over seeds.
fn trace(context: &Context, scene: &Arc<Scene>, graph: &str) -> Vec<Moments> {
    let view = View { step: STEP, ..View::default() };
    let mut renderer = Parts { keep: &["shade.color"], view, ..Parts::new(scene, graph) }.renderer(context);
    let mut found = vec![Moments::default(); FRAMES.len()];
    for seed in 0..SEEDS {
        for (moments, mean) in found.iter_mut().zip(means(&mut renderer, seed)) {
            moments.push(mean);
        }
    }
    found
}

fn means(renderer: &mut Renderer, seed: u64) -> Vec<f64> {
    renderer.reseed(seed).unwrap_or_else(|error| panic!("{error}"));
    let mut found = Vec::new();
    for frame in 0..=FRAMES[FRAMES.len() - 1] {
        renderer.frame().unwrap_or_else(|error| panic!("{error}"));
        if FRAMES.contains(&frame) {
            found.push(mean(&film_of(renderer, "shade.color")));
        }
    }
    found
}
