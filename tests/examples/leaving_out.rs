//! Does leaving out change any bit? Every built-in graph on every built-in scene; what is in the file already is kept. And what it saves, on a scene that
//! needs little and on scenes that need much.

use aquifer_graph::{Document, Shelf, Source};
use aquifer_lab::explain::{Request, explain};
use aquifer_render::{Context, ContextOptions};
use aquifer_tests::{
    Kept,
    evidence::Evidence,
    leaving_out::{Differs, Pair},
    scene,
};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Graphs and scenes whose time and memory are told.
const COSTS: [(&str, &str); 6] = [
    ("path_tracer", "cornell"),
    ("restir_di_unbiased", "cornell"),
    ("restir_gi_validated", "cornell"),
    ("path_tracer", "textured"),
    ("restir_di_unbiased", "textured"),
    ("restir_di_unbiased", "animated"),
];
const SIZE: [u32; 2] = [256, 144];
const ROUNDS: u32 = 15;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [what, path, commit, date, minutes, only @ ..] = args.as_slice() else {
        return Err("usage: leaving_out pairs|costs FILE COMMIT DATE MINUTES [GRAPH@SCENE …]".into());
    };
    let end = Instant::now() + Duration::from_secs(60 * minutes.parse::<u64>()?);
    let context = Context::new(&ContextOptions::default())?;
    let key = |graph: &str, scene: &str| json!({ "graph": graph, "scene": scene });
    let mut file = Evidence::open(path, commit, date, &context);
    let files = aquifer_graphs::files();
    let graphs = files.iter().map(|(name, _)| name.trim_end_matches(".toml"));
    let every = graphs.flat_map(|graph| aquifer_scenes::all().iter().map(move |generator| (graph, generator.name)));
    let rows: Vec<(&str, &str)> = if what == "costs" { COSTS.to_vec() } else { every.collect() };
    for (graph, scene) in rows {
        let wanted = only.is_empty() || only.contains(&format!("{graph}@{scene}"));
        if wanted && Instant::now() < end && !file.has(&key(graph, scene)) {
            let found = if what == "costs" { cost(&context, graph, scene)? } else { pair(&context, graph, scene) };
            file.put(key(graph, scene), found);
        }
    }
    Ok(())
}

fn pair(context: &Context, graph: &str, name: &str) -> Value {
    let (scene, text) = (scene(name), format!("extends = '{graph}.toml'"));
    let pair = Pair { scene: &scene, graph: &text };
    let told = |found: &Option<Differs>| found.as_ref().map(|found| json!({ "resource": found.resource, "ulps": found.ulps }));
    let resources = pair.first_difference(context, Kept::Resources);
    let all = pair.first_difference(context, Kept::All);
    let agree = all.as_ref().map(|_| pair.means_agree(context, Kept::All));
    json!({ "with resources": told(&resources), "with everything": told(&all), "means agree": agree })
}

fn cost(context: &Context, graph: &str, name: &str) -> Result<Value, Box<dyn std::error::Error>> {
    let scene = scene(name);
    let text = format!("extends = '{graph}.toml'");
    let document = Document::parse(Source::new("costs", text), &Shelf::new("", aquifer_graphs::files()))?;
    let found = explain(&Request { context, scene: &scene, document: &document, folders: &[], size: SIZE, rounds: ROUNDS })?;
    let [frame, ratio] = [found.frame_ms.map(|ways| json!(ways)), found.slowdown.map(|ratio| json!(ratio))];
    Ok(json!({
        "size": format!("{}x{}", SIZE[0], SIZE[1]), "bytes": found.bytes, "frame ms": frame, "ratio": ratio,
        "pieces": found.pieces.len(), "ports": found.left_out.len(), "arrays": found.arrays.len(),
    }))
}
