//! Is unbiased ReSTIR DI unbiased? One row for each scene, motion and rule: frame 8 over independent seeds against path tracing.
//!
//! ```text
//! cargo run -p aquifer-tests --example restir_di_evidence -- FILE FOLDER COMMIT DATE MINUTES [SCENE]
//! ```
//!
//! FOLDER keeps references and what seeds have shown so far: a run that was stopped goes on where it was. Seeds are added to all rows in turn, twice as
//! many each time, until a row is resolved or has failed, has its 4,000 seeds, or the time is over.

use aquifer_lab::{
    film::Film,
    stats::{
        BlockTest, Blocks, Rule, Verdict,
        blocks::{BlockComparison, BlockMoments, Quantity},
        compare_blocks,
        difference::largest_error,
    },
};
use aquifer_render::{Context, View};
use aquifer_scene::{Channel, Interpolation, Scene, Track};
use aquifer_tests::{
    Parts, context,
    seeds::{SIDE, add_seeds, path_traced_film},
};
use glam::{Quat, Vec3};
use serde_json::{Value, json};
use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, Instant},
};

const SCENES: [&str; 4] = ["cornell", "many_lights", "sun_room", "glossy"];
const RULES: [&str; 3] = ["pairwise", "balance", "contribution"];
const MOTIONS: [&str; 2] = ["still", "all moves"];
/// The frame that is compared; those before are its history.
const FRAME: u32 = 8;
const FEWEST_SEEDS: u64 = 32;
const MOST_SEEDS: u64 = 4000;
/// Of eight paths each.
const REFERENCE_FRAMES: u32 = 512;
/// Seconds a frame.
const STEP: f32 = 1.0 / 30.0;
/// Metres a second, of cameras, lamps and every other thing.
const PACE: f32 = 0.5;

/// 0.2 % of the whole, shown as equivalence; 1 % of every block that is resolved to 0.3 %; 80 % of the blocks.
fn test() -> BlockTest {
    BlockTest {
        overall_band: 0.002,
        overall_rule: Rule::Equivalent { alpha: 0.05 },
        overall_error: largest_error(0.002),
        block_band: 0.01,
        block_rule: Rule::Exceeds { alpha: 0.05 },
        block_error: 0.003,
        resolved_share: 0.8,
        ..BlockTest::default()
    }
}

/// What a row is about.
#[derive(Clone, Copy)]
struct Case {
    scene: &'static str,
    motion: &'static str,
    mis: &'static str,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, folder, commit, date, minutes, only @ ..] = &arguments[..] else {
        eprintln!("restir_di_evidence FILE FOLDER COMMIT DATE MINUTES [SCENE]");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let folder = PathBuf::from(folder);
    fs::create_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let minutes: u64 = minutes.parse().expect("MINUTES is a whole number");
    let end = Instant::now() + Duration::from_secs(60 * minutes);
    let asked = |scene: &&str| only.is_empty() || only.iter().any(|name| name == scene);
    let mut goal = FEWEST_SEEDS;
    while goal < 2 * MOST_SEEDS {
        for scene in SCENES.into_iter().filter(asked) {
            for case in MOTIONS.iter().flat_map(|motion| RULES.map(|mis| Case { scene, motion, mis })) {
                if Instant::now() > end {
                    return;
                }
                let Some((seeds, found)) = measure(&context, &case, &folder, goal.min(MOST_SEEDS), end) else { continue };
                let about = json!({ "commit": commit, "adapter": context.adapter().name, "date": date });
                write(Path::new(file), &case, seeds, &found, &about);
            }
        }
        goal *= 2;
    }
}

/// Adds seeds up to `goal`; `None` where the row was settled before.
fn measure(context: &Context, case: &Case, folder: &Path, goal: u64, end: Instant) -> Option<(u64, BlockComparison)> {
    let Case { scene: name, motion, mis } = *case;
    let kept = folder.join(format!("{name}-{}-{mis}.json", motion.replace(' ', "-")));
    let read = || serde_json::from_str::<BlockMoments>(&fs::read_to_string(&kept).ok()?).ok();
    let moving = View { step: STEP, ..View::default() };
    let scene = made(name, motion != "still");
    let mut moments = read().unwrap_or_else(|| BlockMoments::new([64, 36], SIDE, Quantity::Luminance));
    if moments.count() >= goal {
        return None;
    }
    let reference = reference(context, &scene, &moving, &folder.join(format!("{name}-{}.exr", motion.replace(' ', "-"))));
    let settled = |moments: &BlockMoments| {
        let found = compare_blocks(&moments.blocks(), &reference, &test()).expect("grids of one size");
        (found.verdict != Verdict::NotResolved && moments.count() >= FEWEST_SEEDS, found)
    };
    if settled(&moments).0 {
        return None;
    }
    let graph = format!("extends = 'restir_di_unbiased.toml'\n[slots]\nmis = '{mis}'\n[pass.spatial]\nset.radius = 4.0\nset.rows = 0.0");
    let mut renderer = Parts { keep: &["shade.color"], view: moving, ..Parts::new(&scene, &graph) }.renderer(context);
    while moments.count() < goal && Instant::now() < end {
        let from = moments.count();
        add_seeds(&mut renderer, FRAME, from..goal.min(from + FEWEST_SEEDS), &mut moments);
        fs::write(&kept, serde_json::to_string(&moments).expect("plain data"))
            .unwrap_or_else(|error| panic!("{}: {error}", kept.display()));
        if settled(&moments).0 {
            break;
        }
    }
    let found = settled(&moments).1;
    eprintln!("{name}, {motion}, {mis}, {} seeds: {found}", moments.count());
    Some((moments.count(), found))
}

fn reference(context: &Context, scene: &Arc<Scene>, moving: &View, path: &Path) -> Blocks {
    let film = Film::read(path).unwrap_or_else(|_| {
        let held = View { time: moving.time_at(FRAME), ..View::default() };
        let film = path_traced_film(context, scene, "direct", REFERENCE_FRAMES, held);
        film.write(path).unwrap_or_else(|error| panic!("{error}"));
        film
    });
    Blocks::of_film(&film, SIDE, Quantity::Luminance)
}

/// A scene, of which cameras, lamps and every other mesh may glide and the sun turn.
fn made(name: &str, moves: bool) -> Arc<Scene> {
    let mut scene = (aquifer_scenes::by_name(name).expect("a built-in scene").make)();
    for node in 0..if moves { scene.nodes.len() } else { 0 } {
        let it = &scene.nodes[node];
        let emits =
            it.mesh.is_some_and(|mesh| scene.meshes[mesh as usize].materials.iter().any(|&id| scene.materials[id as usize].emits()));
        if it.camera.is_some() || it.light.is_some() || emits || (it.mesh.is_some() && node % 2 == 1) {
            let way = Quat::from_rotation_y(node as f32) * Vec3::X * PACE;
            let (place, turn) = (it.translation, it.rotation);
            let tracks = [
                Some(Track::Translation(vec![place, place + way])),
                it.light.map(|_| Track::Rotation(vec![turn, Quat::from_rotation_y(0.2) * turn])),
            ];
            let channel = |track| Channel { node: node as u32, track, times: vec![0.0, 1.0], interpolation: Interpolation::Linear };
            scene.animation.extend(tracks.into_iter().flatten().map(channel));
        }
    }
    Arc::new(scene.finish().unwrap_or_else(|error| panic!("{name}: {error}")))
}

/// The row, in place of the one of the same case.
fn write(path: &Path, case: &Case, seeds: u64, found: &BlockComparison, about: &Value) {
    let old = fs::read_to_string(path).ok().and_then(|text| serde_json::from_str::<Value>(&text).ok());
    let mut rows = old.map_or_else(Vec::new, |file| file["rows"].as_array().cloned().unwrap_or_default());
    let plane = &found.planes[0];
    let percent = |share: f64| (share * 1e5).round() / 1e3;
    let largest = plane.resolved.first().map(|block| percent(block.difference.value.abs()));
    let mut row = json!({
        "scene": case.scene, "motion": case.motion, "mis": case.mis, "frame": FRAME, "seeds": seeds,
        "mean difference %": percent(plane.overall.value), "standard error %": percent(plane.overall.standard_error),
        "lit blocks": plane.lit, "resolved blocks": plane.resolved.len(), "largest block difference %": largest,
        "verdict": found.verdict.to_string(),
    });
    for (key, value) in about.as_object().expect("an object") {
        row[key] = value.clone();
    }
    let same = |other: &Value| ["scene", "motion", "mis"].iter().all(|key| other[key] == row[key]);
    match rows.iter().position(same) {
        Some(at) => rows[at] = row,
        None => rows.push(row),
    }
    let text = serde_json::to_string_pretty(&json!({ "rows": rows })).expect("plain data");
    fs::write(path, text + "\n").unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}
