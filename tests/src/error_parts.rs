//! One frame of indirect light against path tracing with many samples: its square error, what that is made of, and how many rays the frame took.

use crate::{
    Parts, context,
    cost::costs,
    evidence::Evidence,
    fair_settings, scene,
    seeds::{path_traced_parts, shaded},
};
use aquifer_lab::{
    film::{Film, luminance},
    stats::error::mse,
};
use aquifer_render::{Context, View};
use aquifer_scene::Scene;
use std::sync::Arc;

/// Seeds of a median.
pub const SEEDS: u64 = 16;
/// Of eight paths each.
const REFERENCE_FRAMES: u32 = 1024;
/// Of all pixels, those of the largest errors.
const FEW: f64 = 0.005;

const SCENES: [&str; 6] = ["sunlit_wall", "door_ajar", "cornell", "sun_room", "glossy", "animated"];

/// Reads `FILE COMMIT DATE [SCENE …]` and tells `each` of every scene that is asked for: its name, what measures frames of it, and where rows go.
///
/// # Panics
/// When anything is wrong.
pub fn of_each_scene(program: &str, mut each: impl FnMut(&str, &dyn Fn(Frame) -> Error, &mut Evidence)) {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, commit, date, only @ ..] = &arguments[..] else {
        eprintln!("{program} FILE COMMIT DATE [SCENE …]");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut evidence = Evidence::open(file, commit, date, &context);
    for name in SCENES.into_iter().filter(|name| only.is_empty() || only.iter().any(|it| it == name)) {
        let scene = scene(name);
        let reference = reference(&context, &scene, name);
        each(name, &|frame| measure(&context, &scene, name, frame, &reference), &mut evidence);
    }
}

/// What is measured.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// A built-in graph.
    pub graph: &'a str,
    /// Its pass that colours.
    pub pass: &'a str,
    /// Frames before the one that is measured.
    pub warm_up: u32,
    /// Further `--set` texts.
    pub settings: &'a [&'a str],
}

/// Medians over seeds.
pub struct Error {
    /// Mean over pixels and channels.
    pub mse: f64,
    /// Of one frame, of all passes.
    pub rays_a_pixel: f64,
    /// What luminance does not have of the square error, as a share.
    pub hue: f64,
    /// What the worst 0.5 % of the pixels have of it, as a share.
    pub few: f64,
}

/// Jagged edges are nobody's error.
fn centred() -> View {
    View { centred: true, ..View::default() }
}

/// Two bounces by path tracing.
fn reference(context: &Context, scene: &Arc<Scene>, name: &str) -> Film {
    let graph = "extends = 'path_tracer.toml'\ntransport = 'indirect:2'";
    let parts = path_traced_parts(scene, graph, centred());
    let settings = [parts.settings, fair_settings(name)].concat();
    Parts { settings: &settings, ..parts }.film(context, REFERENCE_FRAMES)
}

/// A frame of that scene.
fn measure(context: &Context, scene: &Arc<Scene>, name: &str, frame: Frame, reference: &Film) -> Error {
    let text = format!("extends = '{}.toml'\ntransport = 'indirect:2'", frame.graph);
    let color = format!("{}.color", frame.pass);
    let settings = [fair_settings(name), frame.settings].concat();
    let parts = Parts { settings: &settings, keep: &[&color], view: centred(), ..Parts::new(scene, &text) };
    let mut renderer = parts.renderer(context);
    let films: Vec<Film> = (0..SEEDS).map(|seed| shaded(&mut renderer, &color, seed, frame.warm_up)).collect();
    let error = |film| mse(film, reference).expect("films of one size").value();
    let parts_of_error: Vec<[f64; 2]> = films.iter().map(|film| parts_of(film, reference)).collect();
    let rays: f64 = costs(context, &Parts { keep: &[], ..parts })["passes"]
        .as_array()
        .map_or(0.0, |passes| passes.iter().filter_map(|pass| pass["rays a pixel"].as_f64()).sum());
    Error {
        mse: median(films.iter().map(error)),
        rays_a_pixel: (rays * 100.0).round() / 100.0,
        hue: median(parts_of_error.iter().map(|parts| parts[0])),
        few: median(parts_of_error.iter().map(|parts| parts[1])),
    }
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
