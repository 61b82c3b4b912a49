//! Is unbiased ReSTIR GI unbiased? One row for each scene, domain, rule and motion, against path tracing; rows already in the file are kept.
//!
//! ```text
//! cargo run -p aquifer-tests --example restir_gi_evidence -- docs/evidence/restir_gi.json COMMIT DATE [SCENE]
//! ```

use aquifer_lab::stats::{BlockTest, Rule, Verdict, blocks::BlockComparison};
use aquifer_render::{Context, View};
use aquifer_scene::{Channel, Interpolation, Scene, Track};
use aquifer_tests::{
    context,
    seeds::{Trial, path_traced},
};
use glam::Vec3;
use serde_json::{Value, json};
use std::sync::Arc;

/// Frames of history before the frame that is compared.
const FRAME: u32 = 8;
const SEEDS: u64 = 512;
/// Of eight paths each.
const REFERENCE_FRAMES: u32 = 1024;
/// Seconds a frame, and how far a moving camera goes in that time, metres.
const STEP: f32 = 1.0 / 60.0;
const PACE: f32 = 0.01;

/// Scene, domain that is exact for it, transport.
const SCENES: [(&str, &str, &str); 5] = [
    ("cornell", "gi", "indirect:2"),
    ("glossy", "gi_path", "indirect:2"),
    ("door_ajar", "gi_path", "indirect:2"),
    ("sun_room", "gi_path", "indirect:2"),
    ("cornell", "gi", "indirect:3"),
];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [path, commit, date, only @ ..] = &arguments[..] else {
        eprintln!("restir_gi_evidence FILE COMMIT DATE [SCENE]");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut rows: Vec<Value> = std::fs::read_to_string(path)
        .ok()
        .and_then(|text| serde_json::from_str::<Value>(&text).ok())
        .map_or_else(Vec::new, |file| file["rows"].as_array().cloned().unwrap_or_default());
    for (scene, domain, transport) in SCENES.into_iter().filter(|(scene, ..)| only.is_empty() || only.iter().any(|name| name == scene)) {
        for motion in ["still", "camera moves"] {
            for mis in ["pairwise", "contribution"] {
                let name = json!({ "scene": scene, "domain": domain, "transport": transport, "motion": motion, "mis": mis });
                if rows.iter().any(|row| name.as_object().is_some_and(|name| name.iter().all(|(key, value)| row[key] == *value))) {
                    continue;
                }
                let found = measure(&context, &made(scene, motion != "still"), domain, transport, mis);
                let mut row = name;
                tell(&mut row, &found);
                row["frame"] = json!(FRAME);
                row["commit"] = json!(commit);
                row["adapter"] = json!(context.adapter().name);
                row["date"] = json!(date);
                rows.push(row);
                let text = serde_json::to_string_pretty(&json!({ "rows": rows })).expect("plain data");
                std::fs::write(path, text + "\n").unwrap_or_else(|error| panic!("{path}: {error}"));
            }
        }
    }
}

/// A scene whose first camera may glide to its right.
fn made(name: &str, moves: bool) -> Arc<Scene> {
    let mut scene = (aquifer_scenes::by_name(name).expect("a built-in scene").make)();
    if moves {
        let node = scene.nodes.iter().position(|node| node.camera == Some(0)).expect("it has a camera");
        let start = scene.nodes[node].translation;
        let right = scene.nodes[node].rotation * Vec3::X;
        let track = Track::Translation(vec![start, start + right * (PACE / STEP)]);
        scene.animation.push(Channel { node: node as u32, track, times: vec![0.0, 1.0], interpolation: Interpolation::Linear });
    }
    Arc::new(scene.finish().unwrap_or_else(|error| panic!("{name}: {error}")))
}

fn measure(context: &Context, scene: &Arc<Scene>, domain: &str, transport: &str, mis: &str) -> BlockComparison {
    // The last frame's moment, held.
    let moving = View { step: STEP, ..View::default() };
    let held = View { time: moving.time_at(FRAME), ..View::default() };
    let reference = path_traced(context, scene, transport, REFERENCE_FRAMES, held);
    let graph = format!("extends = 'restir_gi_unbiased.toml'\ntransport = '{transport}'\n[slots]\ndomain = '{domain}'\nmis = '{mis}'");
    let trial = Trial { scene, graph: &graph, settings: &[], shaders: &[], view: moving, frame: FRAME, seeds: SEEDS };
    trial.compare(context, &reference, &BlockTest { block_rule: Rule::Exceeds { alpha: 0.05 }, ..BlockTest::default() })
}

fn tell(row: &mut Value, found: &BlockComparison) {
    let plane = &found.planes[0];
    let percent = |share: f64| (share * 1e5).round() / 1e3;
    let largest = plane.resolved.iter().map(|block| block.difference.value.abs()).fold(0.0, f64::max);
    row["mean difference %"] = json!(percent(plane.overall.value));
    row["standard error %"] = json!(percent(plane.overall.standard_error));
    row["lit blocks"] = json!(plane.lit);
    row["resolved blocks"] = json!(plane.resolved.len());
    row["largest block difference %"] = json!(percent(largest));
    row["verdict"] = json!(match found.verdict {
        Verdict::Passed => "passed",
        Verdict::Failed => "failed",
        Verdict::NotResolved => "not resolved",
    });
}
