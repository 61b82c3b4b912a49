//! Lights that go out and come up between two frames: what history remembers of them is worth nothing, but was still tried.

use crate::{
    direct::{Changes, FRAME, coarse, compare},
    toy::{module, replaced},
};
use aquifer_lab::stats::Verdict;
use aquifer_render::View;
use aquifer_tests::{Parts, context, vanishing::lamps};

/// 32 bits of a reservoir: light, u, v, weight, confidence.
const RESERVOIR: usize = 5;

fn by_the_frame() -> View {
    View { step: 1.0, centred: true, ..View::default() }
}

#[test]
fn lights_that_go_out_and_come_up_are_counted_right() {
    let Some(context) = context() else { return };
    let found = compare(&context, &lamps(FRAME as f32), &Changes { view: by_the_frame(), rule: "pairwise", shaders: &[] }, &coarse(), 192);
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
}

#[test]
fn remembering_a_light_that_went_out_is_found() {
    let Some(context) = context() else { return };
    let text = replaced(module("lights/scene"), "select(0.0, 0.5 * length(n), is_solid(instance))", "0.5 * length(n)");
    let shaders = [("lights/scene", text.as_str())];
    let found =
        compare(&context, &lamps(FRAME as f32), &Changes { view: by_the_frame(), rule: "pairwise", shaders: &shaders }, &coarse(), 64);
    assert_eq!(found.verdict, Verdict::Failed, "{found}");
}

#[test]
fn confidence_counts_what_went_out_and_stops_at_the_cap() {
    let Some(context) = context() else { return };
    let scene = lamps(FRAME as f32);
    let settings = ["temporal.cap=6.0", "spatial.taps=3", "spatial.radius=4.0", "spatial.rows=0.0"];
    let keep = ["temporal.reservoir", "spatial.reservoir"];
    let graph = "extends = 'restir_di_unbiased.toml'";
    let mut renderer = Parts { settings: &settings, keep: &keep, view: by_the_frame(), ..Parts::new(&scene, graph) }.renderer(&context);
    (0..=FRAME).for_each(|_| renderer.frame().unwrap());
    let mut confidences = |port: &str| -> Vec<f32> {
        renderer.read_f32(port).unwrap().chunks_exact(RESERVOIR).map(|reservoir| reservoir[RESERVOIR - 1]).collect()
    };
    // Eight frames of up to four pixels each are far beyond the cap: one for the new reservoir, six for the old, whatever it held. Where the lamp that
    // went out stood, and along edges, there is less history.
    let temporal = confidences("temporal.reservoir");
    let full = temporal.iter().filter(|confidence| **confidence == 7.0).count();
    assert!(temporal.iter().all(|confidence| (1.0..=7.0).contains(confidence)) && 10 * full > 8 * temporal.len(), "{full} are full");
    let joined = confidences("spatial.reservoir");
    assert!(joined.iter().all(|confidence| (1.0..=28.0).contains(confidence)) && joined.contains(&28.0));
}
