//! Two figures of Ouyang et al. 2021 as numbers: where initial directions come from (figure 14), and what the second bounce brings (figure 8).
//!
//! ```text
//! cargo run -p aquifer-tests --example indirect_figures -- FILE COMMIT DATE
//! ```
//!
//! Resumable: what FILE has from the same commit is not measured again.

use aquifer_lab::{
    film::{Film, luminance},
    stats::Moments,
};
use aquifer_render::{Context, View};
use aquifer_tests::{Parts, context, evidence::Evidence, scene, seeds::shaded};
use glam::Vec3;
use serde_json::{Value, json};

/// Graphs, the frame that is looked at, and how many seeds.
const GRAPHS: [(&str, u32, u64); 3] = [("restir_gi_initial", 0, 512), ("restir_gi_spatial_only", 0, 512), ("restir_gi_unbiased", 32, 64)];
const SOURCES: [&str; 3] = ["hemisphere", "cosine", "bsdf"];
/// Light reaches its floor at a slant; from here to there nothing else is seen (`aquifer render --look 1.4,0.8,2.2:0.8,0,1.6`).
const SLANTED: (&str, [Vec3; 2]) = ("sunlit_wall", [Vec3::new(1.4, 0.8, 2.2), Vec3::new(0.8, 0.0, 1.6)]);
/// Seeds are put into so many batches, whose spread gives the standard error of a variance.
const BATCHES: u64 = 16;

const SCENES: [&str; 3] = ["cornell", "door_ajar", "sunlit_wall"];
/// Frames of eight paths each.
const FRAMES: u64 = 512;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, commit, date] = &arguments[..] else {
        eprintln!("indirect_figures FILE COMMIT DATE");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut evidence = Evidence::open(file, commit, date, &context);
    for (graph, frame, seeds) in GRAPHS {
        for source in SOURCES {
            let key = json!({ "figure": 14, "graph": graph, "source": source });
            measure(&mut evidence, key, || noise(&context, graph, source, frame, seeds));
        }
    }
    for name in SCENES {
        measure(&mut evidence, json!({ "figure": 8, "scene": name }), || second_bounce(&context, name));
    }
}

/// Unless this commit has measured it already.
fn measure(evidence: &mut Evidence, key: Value, found: impl FnOnce() -> Value) {
    let is_it = |row: &Value| key.as_object().is_some_and(|key| key.iter().all(|(name, value)| row[name] == *value));
    if !evidence.rows().any(is_it) {
        let found = found();
        eprintln!("{key}: {found}");
        evidence.put(key, found);
    }
}

/// Variance of a pixel over seeds, of luminance: its mean over the image, as a share of the squared mean.
fn noise(context: &Context, graph: &str, source: &str, frame: u32, seeds: u64) -> Value {
    let text = format!("extends = '{graph}.toml'\ntransport = 'indirect:2'\n");
    let (scene, setting) = (scene(SLANTED.0), format!("initial.source={source}"));
    let [from, at] = SLANTED.1;
    let lens = scene.at(0.0, None).expect("the scene has a camera").camera;
    let view = View { free: lens.looking(from, at), centred: true, ..View::default() };
    let parts = Parts { settings: &[&setting], keep: &["shade.color"], view, ..Parts::new(&scene, &text) };
    let mut renderer = parts.renderer(context);
    let mut means = Moments::default();
    let mut variances = Moments::default();
    for batch in 0..BATCHES {
        let mut pixels = vec![Moments::default(); (parts.size[0] * parts.size[1]) as usize];
        for seed in (batch..seeds).step_by(BATCHES as usize) {
            let film = shaded(&mut renderer, "shade.color", seed, frame);
            pixels.iter_mut().zip(luminances(&film)).for_each(|(pixel, value)| pixel.push(value));
        }
        let over_pixels = |of: fn(&Moments) -> f64| pixels.iter().map(of).sum::<f64>() / pixels.len() as f64;
        means.push(over_pixels(Moments::mean));
        variances.push(over_pixels(Moments::variance));
    }
    let square = means.mean().powi(2);
    json!({ "frame": frame, "seeds": seeds, "variance / mean²": variances.mean() / square, "standard error": variances.standard_error() / square })
}

/// Of indirect light with two bounces: the share that one does not bring.
fn second_bounce(context: &Context, name: &str) -> Value {
    let scene = scene(name);
    let [one, two] = [1, 2].map(|bounces| {
        let text = format!("extends = 'path_tracer_indirect.toml'\ntransport = 'indirect:{bounces}'\n");
        let view = View { centred: true, ..View::default() };
        let settings: &[&str] = &["path_tracer.samples=8"];
        let parts = Parts { settings, keep: &["path_tracer.color"], view, ..Parts::new(&scene, &text) };
        let mut renderer = parts.renderer(context);
        // Not the same paths twice: the two errors are added as those of independent means.
        let seeds = (0..FRAMES).map(|seed| 2 * seed + bounces);
        let mean = |film: &Film| luminances(film).sum::<f64>() / film.pixels() as f64;
        seeds.map(|seed| mean(&shaded(&mut renderer, "path_tracer.color", seed, 0))).collect::<Moments>()
    });
    let ratio = one.mean() / two.mean();
    let error = ratio * (one.standard_error() / one.mean()).hypot(two.standard_error() / two.mean());
    json!({ "second bounce %": 100.0 * (1.0 - ratio), "standard error %": 100.0 * error })
}

fn luminances(film: &Film) -> impl Iterator<Item = f64> + '_ {
    film.color.iter().map(|color| luminance(color.map(f64::from)))
}
