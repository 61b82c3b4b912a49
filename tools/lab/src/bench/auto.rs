//! `slots.trace = "auto"`: whichever tracer is faster on this adapter and scene, by a short measurement that is kept.
//!
//! The word is replaced before a graph is checked, so that digests, films and reports name the tracer that was taken.

use super::tracing::{TraceOptions, TraceReport, measure};
use crate::{atomic, stage::StageError};
use aquifer_graph::{Document, Source};
use aquifer_render::Context;
use aquifer_scene::Scene;
use serde::{Deserialize, Serialize};
use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

const SLOT: &str = "trace";
/// The word that stands for the choice.
pub const AUTO: &str = "auto";
/// Rays of each kind: enough for a ratio, too few to wait for.
const SIZE: [u32; 2] = [128, 72];
const ROUNDS: u32 = 3;

/// Does the graph leave the choice of its tracer?
pub fn asked(document: &Document) -> bool {
    document.slots.iter().any(|(slot, filling)| slot.value == SLOT && filling.value.as_deref() == Some(AUTO))
}

/// What takes the word's place.
pub fn choice(tracer: &str) -> Source {
    Source::new(format!("slots.{SLOT}={AUTO}"), format!("slots.{SLOT}={tracer}"))
}

/// The choice as it is kept.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Kept {
    about: String,
    tracer: String,
}

/// The faster tracer, by the geometric mean over camera, bounce and shadow rays; as kept in `cache` for this adapter, scene and shaders, or
/// measured now.
///
/// # Errors
/// Of the measurement. A cache that cannot be written is told to nobody: the next run measures again.
pub fn fastest(context: &Context, scene: &Arc<Scene>, shaders: &[PathBuf], cache: &Path) -> Result<String, StageError> {
    let about = about(context, scene, shaders)?;
    let path = cache.join(format!("tracer-{}.json", &blake3::hash(about.as_bytes()).to_hex()[..32]));
    let kept = fs::read(&path).ok().and_then(|text| serde_json::from_slice::<Kept>(&text).ok());
    if let Some(kept) = kept.filter(|kept| kept.about == about) {
        return Ok(kept.tracer);
    }
    let options = TraceOptions { tracers: Vec::new(), size: SIZE, rounds: ROUNDS, repeats: 1, shaders: shaders.to_vec() };
    let kept = Kept { about, tracer: best(&measure(context, scene, &options)?) };
    if let Ok(text) = serde_json::to_vec_pretty(&kept) {
        let _ = fs::create_dir_all(cache).map(|()| atomic::write(&path, &text));
    }
    Ok(kept.tracer)
}

/// Everything that the choice may hang on.
fn about(context: &Context, scene: &Scene, shaders: &[PathBuf]) -> Result<String, StageError> {
    let library = crate::stage::library(shaders)?;
    let mut text = blake3::Hasher::new();
    for tracer in library.slots().remove(SLOT).unwrap_or_default() {
        text.update(library.text(&format!("{SLOT}/{tracer}")).unwrap_or_default().as_bytes());
    }
    let adapter = context.adapter();
    let triangles: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let shaders = &text.finalize().to_hex()[..16];
    Ok(format!(
        "{}, {}, {}, {triangles} triangles in {} meshes, tracers {shaders}",
        adapter.name,
        adapter.driver,
        scene.name,
        scene.meshes.len()
    ))
}

/// The device's tracers are those whose hits are held against the CPU's.
fn best(report: &TraceReport) -> String {
    let speed = |name: &str| -> f64 {
        let all = report.kinds.iter().flat_map(|kind| &kind.tracers).filter(|tracer| tracer.name == name);
        all.map(|tracer| tracer.of_obvhs.median.ln()).sum()
    };
    let names = report.kinds.first().into_iter().flat_map(|kind| &kind.tracers).filter(|tracer| tracer.differing.is_some());
    let best = names.map(|tracer| &tracer.name).max_by(|a, b| speed(a).total_cmp(&speed(b)));
    best.cloned().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::{
        rays::RayKind,
        tracing::{KindReport, TracerReport},
        turns::Middle,
    };
    use aquifer_graph::Shelf;

    #[test]
    fn the_word_is_found_and_replaced() {
        let read = |text: &str| Document::parse(Source::new("test.toml", text), &Shelf::default()).unwrap();
        let mut document = read("title = 'x'\n[slots]\ntrace = 'auto'\n");
        assert!(asked(&document) && !asked(&read("title = 'x'\n[slots]\ntrace = 'bvh2'\n")) && !asked(&read("title = 'x'\n")));
        document.apply([choice("cwbvh")]).unwrap();
        assert!(!asked(&document));
    }

    #[test]
    fn the_best_of_all_kinds_wins_and_the_cpu_does_not_take_part() {
        let tracer = |name: &str, speed: f64, device: bool| {
            let middle = Middle { low: speed, median: speed, high: speed };
            TracerReport { name: name.into(), mrays_per_second: middle, of_obvhs: middle, differing: device.then_some(0.0) }
        };
        let kind = |kind, a: f64, b: f64| {
            let tracers = vec![tracer("a", a, true), tracer("b", b, true), tracer("obvhs, 1 threads", 9.0, false)];
            KindReport { kind, rays: 1, hits: 1.0, tracers }
        };
        let report = |kinds| TraceReport { adapter: "x".into(), threads: 2, triangles: 1, instances: 1, size: SIZE, rounds: ROUNDS, kinds };
        let split = vec![kind(RayKind::Camera, 0.8, 0.5), kind(RayKind::Bounce, 0.3, 0.4), kind(RayKind::Shadow, 0.3, 0.4)];
        // 0.8 · 0.3 · 0.3 = 0.072 against 0.5 · 0.4 · 0.4 = 0.080.
        assert_eq!(best(&report(split)), "b");
    }
}
