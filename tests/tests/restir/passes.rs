//! The passes `initial`, `temporal`, `spatial` and `shade` as they are, on the toy domain: what every kind of pixel shows after some frames.

use crate::toy::{PIXELS, module, replaced, sized};
use aquifer_lab::stats::{Difference, Moments};
use aquifer_render::Context;
use aquifer_tests::context;

const SIZE: [u32; 2] = [9 * 24, 48];
/// Frames 0 to 3: three of history, of targets that are not this frame's.
const FRAME: u32 = 3;
const SEEDS: u64 = 48;

/// The `balance` heuristic takes permuted histories and even taps.
fn graph(mis: &str, visibility: &str) -> String {
    let (permute, pattern) = if mis == "balance" { (true, "even") } else { (false, "random") };
    format!(
        "extends = 'restir_di.toml'
slots = {{ domain = 'toy', mis = '{mis}', visibility = '{visibility}' }}
[pass.gbuffer_traced]
kind = 'toy_gbuffer'
[pass.initial]
set.candidates = 4
[pass.temporal]
set.permute = {permute}
[pass.spatial]
set.pattern = '{pattern}'
set.radius = 5.0
set.rows = 0.0
set.taps = 4"
    )
}

/// Relative difference from the closed form, for every kind of pixel that sees anything.
fn differences(context: &Context, mis: &str, visibility: &str, shaders: &[(&str, &str)]) -> Vec<(usize, Difference)> {
    let mut renderer = sized(context, &graph(mis, visibility), shaders, &["shade.color"], SIZE);
    let mut moments = [Moments::default(); PIXELS.len()];
    for seed in 0..SEEDS {
        renderer.reseed(seed).unwrap();
        (0..=FRAME).for_each(|_| renderer.frame().unwrap());
        let color = renderer.read_f32("shade.color").unwrap();
        for (kind, moments) in moments.iter_mut().enumerate() {
            // Pixels share samples: one number a seed.
            let values = color.chunks_exact(4).skip(kind).step_by(PIXELS.len()).map(|pixel| f64::from(pixel[0]));
            moments.push(values.collect::<Moments>().mean());
        }
    }
    let relative = |(kind, moments): (usize, &Moments)| {
        let truth = PIXELS[kind].integral(FRAME);
        (
            kind,
            Difference { value: moments.mean() - truth, standard_error: moments.standard_error(), freedom: (SEEDS - 1) as f64 }
                .relative_to(truth),
        )
    };
    moments.iter().enumerate().filter(|(kind, _)| PIXELS[*kind].integral(FRAME) > 0.0).map(relative).collect()
}

/// The largest distance from the closed form, in standard errors, and the largest standard error.
fn worst(what: &str, found: &[(usize, Difference)]) -> (f64, f64) {
    for (kind, found) in found {
        eprintln!("{what}, pixel {kind}: {:+.3} % ± {:.3} %", 100.0 * found.value, 100.0 * found.standard_error);
    }
    let largest = |value: fn(&Difference) -> f64| found.iter().map(|(_, found)| value(found)).fold(0.0, f64::max);
    (largest(|found| found.score(0.0).abs()), largest(|found| found.standard_error))
}

#[test]
fn passes_keep_the_closed_form_over_frames() {
    let Some(context) = context() else { return };
    for (mis, visibility) in
        [("pairwise", "at_shading"), ("pairwise", "in_target"), ("contribution", "in_target"), ("balance", "at_shading")]
    {
        let (score, error) = worst(&format!("{mis}, {visibility}"), &differences(&context, mis, visibility, &[]));
        assert!(error < 0.01, "{mis}, {visibility}: resolves only {error}");
        assert!(score < 4.5, "{mis}, {visibility}: {score} standard errors");
    }
}

#[test]
fn bugs_of_passes_show() {
    let Some(context) = context() else { return };
    let bugs = [
        (
            "neighbours rejected because of their samples",
            "pass/spatial",
            "if (other == NOWHERE) {",
            "if (other == NOWHERE || current[other].weight.value <= 0.0) {",
        ),
        (
            "history's p̂ W kept from last frame",
            "restir/inputs",
            "return Candidate(y.sample, y.p_hat,",
            "return Candidate(y.sample, p_hat(r.sample, src),",
        ),
    ];
    for (name, path, what, by) in bugs {
        let text = replaced(module(path), what, by);
        let (score, _) = worst(name, &differences(&context, "pairwise", "in_target", &[(path, &text)]));
        assert!(score >= 5.0, "{name} does not show: {score} standard errors");
    }
}
