//! Direct light by ReSTIR against the path tracer.

use aquifer_lab::stats::{BlockTest, Rule, Verdict, blocks::BlockComparison};
use aquifer_render::{Context, View};
use aquifer_scene::Scene;
use aquifer_tests::{
    context, scene,
    seeds::{Trial, path_traced},
};
use std::sync::Arc;

/// 0.5 % of the whole; 2 % of each block that is resolved to 0.7 %, which must be most of them.
fn fine() -> BlockTest {
    BlockTest { block_rule: Rule::Exceeds { alpha: 0.05 }, resolved_share: 0.8, ..BlockTest::default() }
}

/// Twice that, and less than half of the blocks, for what goes wrong by much when it goes wrong.
pub fn coarse() -> BlockTest {
    BlockTest { overall_band: 0.01, overall_error: 0.01 / 3.3, block_band: 0.04, block_error: 0.014, resolved_share: 0.4, ..fine() }
}

/// Neighbours within 4 pixels: within 30 of 1080 there would be none.
const NEAR: [&str; 2] = ["spatial.radius=4.0", "spatial.rows=0.0"];
/// Eight frames of history.
pub const FRAME: u32 = 8;

/// `restir_di_unbiased` on a scene, for at most so many seeds.
pub fn compare(context: &Context, scene: &Arc<Scene>, changes: &Changes<'_>, test: &BlockTest, seeds: u64) -> BlockComparison {
    let Changes { view, rule, shaders } = changes;
    let moment = View { time: view.time_at(FRAME), step: 0.0, ..view.clone() };
    let reference = path_traced(context, scene, "direct", 192, moment);
    let rule = format!("slots.mis={rule}");
    let settings = [NEAR[0], NEAR[1], &rule];
    let graph = "extends = 'restir_di_unbiased.toml'";
    Trial { scene, graph, settings: &settings, shaders, view: view.clone(), frame: FRAME, seeds }.compare(context, &reference, test)
}

/// All seeds see the same of each pixel: no noise of edges and lamps, which is nothing about reuse. The test of what moves has it.
fn centred() -> View {
    View { centred: true, ..View::default() }
}

/// What differs from the graph as it is, still.
#[derive(Clone, Default)]
pub struct Changes<'a> {
    pub view: View,
    pub rule: &'a str,
    pub shaders: &'a [(&'a str, &'a str)],
}

#[test]
fn pairwise_reuse_agrees_with_the_path_tracer() {
    let Some(context) = context() else { return };
    let found = compare(&context, &scene("cornell"), &Changes { view: centred(), rule: "pairwise", shaders: &[] }, &fine(), 128);
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
}

#[test]
fn reuse_agrees_where_camera_objects_and_lights_move() {
    let Some(context) = context() else { return };
    let view = View { time: 0.3, step: 0.05, ..View::default() };
    let found = compare(&context, &scene("animated"), &Changes { view, rule: "pairwise", shaders: &[] }, &coarse(), 192);
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
}

#[test]
fn the_constant_rule_is_found_at_shadow_edges() {
    let Some(context) = context() else { return };
    let found = compare(&context, &scene("cornell"), &Changes { view: centred(), rule: "constant", shaders: &[] }, &fine(), 128);
    assert_eq!(found.verdict, Verdict::Failed, "{found}");
}
