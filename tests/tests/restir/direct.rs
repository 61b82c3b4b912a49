//! Direct light by ReSTIR against the path tracer.

use aquifer_lab::stats::{BlockTest, Rule, Verdict, blocks::BlockComparison};
use aquifer_render::View;
use aquifer_tests::{
    context, scene,
    seeds::{Trial, path_traced},
};

/// 0.5 % of the whole; 2 % of each block that is resolved to 0.7 %. Few seeds: that is less than half of the blocks.
fn test() -> BlockTest {
    let rule = Rule::Exceeds { alpha: 0.05 };
    BlockTest { block_rule: rule, resolved_share: 0.4, ..BlockTest::default() }
}

/// `restir_di_unbiased` on cornell, with eight frames of history; `None` without an adapter.
fn compare(setting: &str, seeds: u64) -> Option<BlockComparison> {
    let context = context()?;
    let scene = scene("cornell");
    let reference = path_traced(&context, &scene, "direct", 192, View::default());
    // Neighbours within 4 pixels: within 30 of 1080 there would be none.
    let settings = ["spatial.radius=4.0", "spatial.rows=0.0", setting];
    let graph = "extends = 'restir_di_unbiased.toml'";
    let trial = Trial { scene: &scene, graph, settings: &settings, shaders: &[], view: View::default(), frame: 8, seeds };
    Some(trial.compare(&context, &reference, &test()))
}

#[test]
fn pairwise_reuse_agrees_with_the_path_tracer() {
    let Some(found) = compare("slots.mis=pairwise", 448) else { return };
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
}

#[test]
fn the_constant_rule_is_found_at_shadow_edges() {
    let Some(found) = compare("slots.mis=constant", 128) else { return };
    assert_eq!(found.verdict, Verdict::Failed, "{found}");
}
