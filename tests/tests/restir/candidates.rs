//! Candidates however they come: BSDF rays mixed in, presampled lights. Resampled without reuse, they give the path tracer's direct light.

use crate::{
    direct::coarse,
    toy::{module, replaced},
};
use aquifer_lab::stats::{
    Blocks, Verdict,
    blocks::{BlockComparison, Quantity},
    compare_blocks,
};
use aquifer_render::{Context, View};
use aquifer_tests::{
    Parts, context, scene,
    seeds::{SIDE, path_traced},
};

const RIS: &str = "extends = 'ris_only.toml'\nslots.visibility = 'in_target'\ntransport = 'direct'";
const FROM_GRID: &str = "extends = 'ris_only.toml'
transport = 'direct'
slots.proposal = 'regir'
[pass.regir]
[pass.initial]
in.grid = 'regir.grid'";

/// Frames of these graphs are independent, and so are their pixels but for the grid. The path tracer's frames take eight paths each.
fn compare(context: &Context, name: &str, graph: &str, settings: &[&str], shaders: &[(&str, &str)], frames: u32) -> BlockComparison {
    let scene = scene(name);
    let view = View { time: 0.3, ..View::default() };
    let reference = path_traced(context, &scene, "direct", frames * 3 / 8, view.clone());
    let film = Parts { settings, shaders, view, ..Parts::new(&scene, graph) }.film(context, frames);
    let found = compare_blocks(&Blocks::of_film(&film, SIDE, Quantity::Luminance), &reference, &coarse()).unwrap();
    eprintln!("{name}, {settings:?}: {found}");
    found
}

#[test]
fn bsdf_rays_mix_in_without_bias() {
    let Some(context) = context() else { return };
    // Triangles seen by surfaces of roughness from 0.1; the sky with a sun.
    for name in ["glossy", "outdoor"] {
        let found = compare(&context, name, RIS, &["initial.candidates=12", "initial.bsdf_rays=4"], &[], 416);
        assert_eq!(found.verdict, Verdict::Passed, "{name}: {found}");
    }
}

#[test]
fn a_wrong_mixture_is_found() {
    let Some(context) = context() else { return };
    let text = replaced(module("domain/di"), "f32(count - rays) * q +", "f32(count) * q +");
    let found = compare(&context, "glossy", RIS, &["initial.candidates=12", "initial.bsdf_rays=4"], &[("domain/di", &text)], 128);
    assert_eq!(found.verdict, Verdict::Failed, "{found}");
}

/// What light is hidden, and by what, is another for every surface of the box.
#[test]
fn several_winners_share_their_light() {
    let Some(context) = context() else { return };
    let settings = ["initial.candidates=4", "initial.winners=4"];
    let found = compare(&context, "cornell", RIS, &settings, &[], 192);
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
    // The mean over those that are seen, where it is over all of them.
    let counts = replaced(module("restir/ris"), "offer(&kept,", "kept.confidence += f32(s.sum > 0.0);\noffer(&kept,");
    let text = replaced(&counts, "kept.confidence = 1.0;", "kept.sum *= f32(winners) / max(kept.confidence, 1.0);\nkept.confidence = 1.0;");
    let found = compare(&context, "cornell", RIS, &settings, &[("restir/ris", &text)], 192);
    assert_eq!(found.verdict, Verdict::Failed, "{found}");
}

#[test]
fn presampled_lights_give_direct_light() {
    let Some(context) = context() else { return };
    let found = compare(&context, "animated", FROM_GRID, &[], &[], 224);
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
}
