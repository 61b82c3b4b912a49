//! Slot `shading`: what all inputs bring has the mean of what one kept sample brings, and less noise.

use crate::toy::{module, replaced};
use aquifer_lab::stats::{Difference, Moments};
use aquifer_render::{Context, Renderer};
use aquifer_scene::Scene;
use aquifer_scenes::by_name;
use aquifer_tests::{Parts, context};
use std::sync::Arc;

const FRAMES: u32 = 3;

fn cornell() -> Arc<Scene> {
    Arc::new((by_name("cornell").expect("built in").make)().finish().expect("built in"))
}

/// Two passes shade the same frame, one what was kept and one all inputs.
fn renderer(context: &Context, graph: &str, mis: &str, visibility: &str, shaders: &[(&str, &str)]) -> Renderer {
    let text = format!(
        "extends = '{graph}.toml'
slots = {{ magnitude = 'luminance', mis = '{mis}', visibility = '{visibility}' }}
output = 'shade.color'
[pass.accumulate]
remove = true
[pass.tonemap]
remove = true
[pass.spatial]
slots.shading = 'all'
[pass.shade]
in.light = false
[pass.shade_all]
kind = 'shade'
in.surface = 'gbuffer_traced.surface'
in.reservoir = 'spatial.reservoir'
in.light = 'spatial.light'"
    );
    let keep = &["shade.color", "shade_all.color"];
    Parts { keep, shaders, ..Parts::new(&cornell(), &text) }.renderer(context)
}

/// Pixels of one frame after some: what was kept, and all.
fn shaded(renderer: &mut Renderer, seed: u64) -> [Vec<[f32; 3]>; 2] {
    renderer.reseed(seed).unwrap();
    (0..FRAMES).for_each(|_| renderer.frame().unwrap());
    ["shade.color", "shade_all.color"].map(|name| {
        let words = renderer.read_f32(name).unwrap();
        words.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    })
}

fn luminance([r, g, b]: [f32; 3]) -> f64 {
    f64::from(0.2126 * r + 0.7152 * g + 0.0722 * b)
}

/// Largest difference of two channels' shares of a pixel.
fn hue(a: [f32; 3], b: [f32; 3]) -> f64 {
    let shares = |pixel: [f32; 3]| pixel.map(|channel| f64::from(channel) / pixel.iter().map(|channel| f64::from(*channel)).sum::<f64>());
    shares(a).into_iter().zip(shares(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn targets_that_hold_visibility_give_the_same_luminance_pixel_by_pixel() {
    let Some(context) = context() else { return };
    for (graph, mis) in [
        ("restir_di_unbiased", "pairwise"),
        ("restir_di_unbiased", "balance"),
        ("restir_gi_unbiased", "pairwise"),
        ("restir_gi_unbiased", "constant"),
    ] {
        let [kept, all] = shaded(&mut renderer(&context, graph, mis, "in_target", &[]), 1);
        let (mut lit, mut coloured) = (0, 0);
        for (index, (kept, all)) in kept.into_iter().zip(all).enumerate() {
            let (a, b) = (luminance(kept), luminance(all));
            // Weights and reflectances are rounded on their way through memory.
            assert!((a - b).abs() <= 2e-3 * a.max(b) + 1e-7, "{graph}, {mis}, pixel {index}: {kept:?} and {all:?}");
            lit += usize::from(a > 0.0);
            coloured += usize::from(a > 0.0 && hue(kept, all) > 0.01);
        }
        assert!(lit > 1000, "{graph}, {mis}: {lit} pixels are lit");
        // Indirect light has many hues; the lamp has one.
        assert!(!graph.contains("gi") || coloured > lit / 4, "{graph}, {mis}: only {coloured} of {lit} pixels have another hue");
    }
}

/// Of the light of all inputs from that of what was kept, as a share, over seeds.
fn difference(context: &Context, shaders: &[(&str, &str)]) -> Difference {
    let mut renderer = renderer(context, "restir_di_unbiased", "pairwise", "at_shading", shaders);
    let (mut kept, mut difference) = (Moments::default(), Moments::default());
    for seed in 0..48 {
        let [of_kept, of_all] = shaded(&mut renderer, seed).map(|pixels| pixels.into_iter().map(luminance).sum::<f64>());
        kept.push(of_kept);
        difference.push(of_all - of_kept);
    }
    Difference { value: difference.mean(), standard_error: difference.standard_error(), freedom: 47.0 }.relative_to(kept.mean())
}

#[test]
fn rays_at_shading_keep_the_mean() {
    let Some(context) = context() else { return };
    let found = difference(&context, &[]);
    assert!(found.standard_error < 2e-3 && found.score(0.0).abs() < 4.0, "{found:?}");
    let blind = replaced(module("shading/all"), "if (TEST_SHADED && !visible(y.sample, at)) { return; }", "");
    let planted = difference(&context, &[("shading/all", &blind)]);
    eprintln!("all less kept: {found:?}; without the rays: {planted:?}");
    assert!(planted.score(0.0) > 10.0, "{planted:?}");
}

#[test]
fn a_rule_that_cannot_tell_shades_what_was_kept() {
    let Some(context) = context() else { return };
    let [kept, all] = shaded(&mut renderer(&context, "restir_gi_unbiased", "contribution", "in_target", &[]), 1);
    assert!(kept == all && kept.iter().any(|pixel| luminance(*pixel) > 0.0));
}
