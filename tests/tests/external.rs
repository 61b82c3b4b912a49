//! External truth: images of Mitsuba 3, rendered by the scripts of `tests/external`, against the path tracer.
//!
//! Means agree within 0.5 %, every resolved 8×8 block within 2 %; a block is resolved when both standard errors together are at most 0.7 % of
//! it, and 90 % of the blocks brighter than 2 % of the mean must be. Frames are added until they are; what is not resolved by the last
//! frame fails the test, as not resolved. Scenes that would take minutes are compared in coarser bands; the fine ones are evidence
//! (`docs/external_truth.md`).

use aquifer_lab::stats::{BlockTest, Blocks, Verdict, blocks::Quantity, compare_blocks};
use aquifer_scene::Scene;
use aquifer_tests::{Parts, context, references::mitsuba, scene};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

const GRAPH: &str = "extends = 'path_tracer.toml'\noutput = 'accumulate.image'\n[pass.tonemap]\nremove = true";

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("external/references").join(name)
}

/// Renders up to `most` frames of a built-in scene, and compares.
fn compare(name: &str, transport: &str, most: u32) {
    compare_scene(&scene(name), name, transport, &[], most, &BlockTest::default());
}

/// Bands that 1/25 of the samples resolves.
fn coarse() -> BlockTest {
    BlockTest { overall_band: 0.01, overall_error: 0.01 / 3.3, block_band: 0.1, block_error: 0.035, ..BlockTest::default() }
}

fn compare_scene(scene: &Arc<Scene>, name: &str, transport: &str, settings: &[&str], most: u32, test: &BlockTest) {
    let Some(context) = context() else { return };
    let reference = Blocks::of_film(&mitsuba(&format!("{name}-{}.exr", transport.replace(':', ""))), 8, Quantity::Channels);
    let transport_setting = format!("transport={transport}");
    // Several paths a frame: fewer dispatches for the same samples.
    let settings = [&[transport_setting.as_str(), "path_tracer.samples=4"], settings].concat();
    let parts = Parts { settings: &settings, ..Parts::new(scene, GRAPH) };
    let mut frames = 0;
    let mut film = parts.rolling(&context);
    loop {
        let ours = film.after(most / 8);
        frames += most / 8;
        let found = compare_blocks(&Blocks::of_film(&ours, 8, Quantity::Channels), &reference, test).expect("the same grid");
        let resolved = found
            .planes
            .iter()
            .all(|plane| plane.share() >= found.test.resolved_share && plane.overall.standard_error <= test.overall_error);
        if resolved || frames >= most {
            eprintln!("{name} {transport}, {frames} frames: {found}");
            assert_eq!(found.verdict, Verdict::Passed, "{name} {transport} after {frames} frames: {found}");
            return;
        }
    }
}

#[test]
fn cornell_direct() {
    compare("cornell", "direct", 2048);
}

#[test]
fn cornell_indirect() {
    compare("cornell", "indirect:2", 2048);
}

#[test]
fn cornell_full() {
    compare("cornell", "full:4", 2048);
}

#[test]
fn glossy_direct() {
    compare("glossy", "direct", 2048);
}

#[test]
fn glossy_full() {
    compare("glossy", "full:4", 2048);
}

/// The kinds of `KHR_lights_punctual`, each in a channel of its own: directional red, point green, spot blue. Places, directions and units.
#[test]
fn lamps_direct() {
    let scene = Scene::load(&file("lamps.glb")).unwrap_or_else(|error| panic!("{error}"));
    let scene = Arc::new(scene.finish().unwrap_or_else(|error| panic!("{error}")));
    compare_scene(&scene, "lamps", "direct", &["slots.proposal=uniform"], 512, &coarse());
}

#[test]
fn textured_direct() {
    compare_scene(&scene("textured"), "textured", "direct", &[], 128, &coarse());
}

/// A sun, a spot and point lights through a window and in a room.
#[test]
fn sun_room_direct() {
    compare_scene(&scene("sun_room"), "sun_room", "direct", &["slots.proposal=uniform"], 512, &coarse());
}

/// An environment.
#[test]
fn outdoor_direct() {
    compare_scene(&scene("outdoor"), "outdoor", "direct", &[], 128, &coarse());
}
