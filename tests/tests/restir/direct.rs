//! Direct light by ReSTIR against the path tracer: the mean of one frame over independent seeds.

use aquifer_lab::{
    film::Film,
    stats::{
        BlockTest, Blocks, Rule, Verdict,
        blocks::{BlockComparison, BlockMoments, Quantity},
        compare_blocks,
    },
};
use aquifer_render::Context;
use aquifer_scene::Scene;
use aquifer_tests::{Parts, context, scene};
use std::sync::Arc;

const SIZE: [u32; 2] = [64, 36];
const SIDE: u32 = 8;
/// The frame that is compared: eight frames of history.
const FRAME: u32 = 8;
/// Neighbours within 4 pixels: within 30 of 1080 there would be none.
const NEAR: [&str; 2] = ["spatial.radius=4.0", "spatial.rows=0.0"];

/// 0.5 % of the whole; 2 % of each block that is resolved to 0.7 %. Few seeds: that is less than half of the blocks.
fn test() -> BlockTest {
    let rule = Rule::Exceeds { alpha: 0.05 };
    BlockTest { block_rule: rule, resolved_share: 0.4, ..BlockTest::default() }
}

/// Direct light by path tracing, over the film's pixels.
fn reference(context: &Context, scene: &Arc<Scene>) -> Blocks {
    let graph = "extends = 'path_tracer.toml'\ntransport = 'direct'";
    let parts = Parts { size: SIZE, settings: &["path_tracer.samples=8"], seed: 1 << 40, ..Parts::new(scene, graph) };
    Blocks::of_film(&parts.film(context, 192), SIDE, Quantity::Luminance)
}

/// Adds seeds until the comparison is resolved or has failed, or `seeds` are spent.
fn compare(context: &Context, scene: &Arc<Scene>, graph: &str, settings: &[&str], seeds: u64) -> BlockComparison {
    let reference = reference(context, scene);
    let settings: Vec<&str> = NEAR.iter().chain(settings).copied().collect();
    let parts = Parts { size: SIZE, settings: &settings, keep: &["shade.color"], ..Parts::new(scene, graph) };
    let mut renderer = parts.renderer(context);
    let mut moments = BlockMoments::new(SIZE, SIDE, Quantity::Luminance);
    let begin = std::time::Instant::now();
    for seed in 0..seeds {
        renderer.reseed(seed).unwrap();
        (0..=FRAME).for_each(|_| renderer.frame().unwrap());
        let words = renderer.read_f32("shade.color").unwrap();
        let color = words.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        moments.push(&Film::new(SIZE, color).unwrap()).unwrap();
        let looks = seed >= 31 && (seed + 1) % 32 == 0;
        if looks && compare_blocks(&moments.blocks(), &reference, &test()).unwrap().verdict != Verdict::NotResolved {
            eprintln!("{} seeds, {:.1?}", seed + 1, begin.elapsed());
            break;
        }
    }
    let found = compare_blocks(&moments.blocks(), &reference, &test()).unwrap();
    eprintln!("{settings:?}: {found}");
    found
}

#[test]
fn pairwise_reuse_agrees_with_the_path_tracer() {
    let Some(context) = context() else { return };
    let graph = "extends = 'restir_di_unbiased.toml'";
    let found = compare(&context, &scene("cornell"), graph, &[], 448);
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
}

#[test]
fn the_constant_rule_is_found_at_shadow_edges() {
    let Some(context) = context() else { return };
    let graph = "extends = 'restir_di_unbiased.toml'";
    let found = compare(&context, &scene("cornell"), graph, &["slots.mis=constant"], 128);
    assert_eq!(found.verdict, Verdict::Failed, "{found}");
}
