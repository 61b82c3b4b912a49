//! Where the error of ReSTIR GI lies, and what it costs: beside one path a pixel, how much lower is the square error of one frame after 32, for how
//! many more rays; which part of it is colour alone, and which part sits in a few pixels.
//!
//! ```text
//! cargo run -p aquifer-tests --example error_parts -- FILE COMMIT DATE [SCENE]
//! ```
//!
//! A reservoir keeps one sample, whose luminance is averaged over all that were merged into it; its hue is not. And light that is found in fewer than
//! one of the paths that a reservoir stands for is not averaged at all: it shines seldom, and then in many pixels and frames.

use aquifer_lab::{
    film::{Film, luminance},
    stats::error::mse,
};
use aquifer_render::{Context, View};
use aquifer_scene::Scene;
use aquifer_tests::{
    Parts, context,
    cost::costs,
    evidence::Evidence,
    fair_settings, scene,
    seeds::{path_traced_parts, shaded},
};
use serde_json::{Value, json};
use std::sync::Arc;

const SCENES: [&str; 6] = ["sunlit_wall", "door_ajar", "cornell", "sun_room", "glossy", "animated"];
/// The pass that colours, frames before the one that is measured.
const GRAPHS: [(&str, &str, u32); 3] =
    [("path_tracer_indirect", "path_tracer", 0), ("restir_gi_unbiased", "shade", 32), ("restir_gi", "shade", 32)];
const SEEDS: u64 = 16;
/// Of eight paths each.
const REFERENCE_FRAMES: u32 = 1024;
/// Of all pixels, those of the largest errors.
const FEW: f64 = 0.005;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, commit, date, only @ ..] = &arguments[..] else {
        eprintln!("error_parts FILE COMMIT DATE [SCENE]");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut evidence = Evidence::open(file, commit, date, &context);
    for name in SCENES.into_iter().filter(|name| only.is_empty() || only.iter().any(|it| it == name)) {
        let scene = scene(name);
        let reference = reference(&context, &scene, name);
        let mut one_path = None;
        for (graph, pass, warm_up) in GRAPHS {
            let mut found = measure(&context, &scene, name, (graph, pass, warm_up), &reference);
            let [error, rays] = ["MSE", "rays a pixel"].map(|key| found[key].as_f64().unwrap_or_default());
            let (its_error, its_rays) = *one_path.get_or_insert((error, rays));
            found["lower error"] = json!(its_error / error);
            found["more rays"] = json!(rays / its_rays);
            eprintln!("{name}, {graph}: {found}");
            evidence.put(json!({ "scene": name, "graph": graph, "transport": "indirect:2" }), found);
        }
    }
}

/// Jagged edges are nobody's error.
fn centred() -> View {
    View { centred: true, ..View::default() }
}

fn reference(context: &Context, scene: &Arc<Scene>, name: &str) -> Film {
    let graph = "extends = 'path_tracer.toml'\ntransport = 'indirect:2'";
    let parts = path_traced_parts(scene, graph, centred());
    let settings = [parts.settings, fair_settings(name)].concat();
    Parts { settings: &settings, ..parts }.film(context, REFERENCE_FRAMES)
}

fn measure(context: &Context, scene: &Arc<Scene>, name: &str, (graph, pass, warm_up): (&str, &str, u32), reference: &Film) -> Value {
    let text = format!("extends = '{graph}.toml'\ntransport = 'indirect:2'");
    let color = format!("{pass}.color");
    let parts = Parts { settings: fair_settings(name), keep: &[&color], view: centred(), ..Parts::new(scene, &text) };
    let mut renderer = parts.renderer(context);
    let films: Vec<Film> = (0..SEEDS).map(|seed| shaded(&mut renderer, &color, seed, warm_up)).collect();
    let error = |film| mse(film, reference).expect("films of one size").value();
    let parts_of_error: Vec<[f64; 2]> = films.iter().map(|film| parts_of(film, reference)).collect();
    let rays: f64 = costs(context, &Parts { keep: &[], ..parts })["passes"]
        .as_array()
        .map_or(0.0, |passes| passes.iter().filter_map(|pass| pass["rays a pixel"].as_f64()).sum());
    json!({
        "seeds": SEEDS, "MSE": median(films.iter().map(error)), "rays a pixel": (rays * 100.0).round() / 100.0,
        "share of hue": median(parts_of_error.iter().map(|parts| parts[0])),
        "share of few pixels": median(parts_of_error.iter().map(|parts| parts[1])),
    })
}

/// Shares of the square error: what luminance does not have, and what the worst pixels have.
fn parts_of(film: &Film, reference: &Film) -> [f64; 2] {
    let off: Vec<[f64; 3]> =
        film.color.iter().zip(&reference.color).map(|(a, b)| [0, 1, 2].map(|c| f64::from(a[c]) - f64::from(b[c]))).collect();
    let mut squares: Vec<f64> = off.iter().map(|off| off.iter().map(|it| it * it).sum::<f64>() / 3.0).collect();
    let gray: f64 = off.iter().map(|&off| luminance(off).powi(2)).sum();
    let all: f64 = squares.iter().sum();
    squares.sort_by(|a, b| b.total_cmp(a));
    let few = (FEW * squares.len() as f64).ceil() as usize;
    [1.0 - gray / all, squares[..few].iter().sum::<f64>() / all]
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
