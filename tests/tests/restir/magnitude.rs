//! Slot `magnitude`: what the fillings are, and that each leaves the least error of its kind.

use aquifer_lab::{
    film::luminance,
    stats::{Difference, Moments},
};
use aquifer_render::Context;
use aquifer_tests::{Parts, context, scene, seeds::shaded};

const KERNEL: &str = include_str!("magnitude.wgsl");

/// Colours and the magnitudes that a filling has for them.
fn magnitudes(context: &Context, filling: &str) -> Vec<([f64; 3], f64)> {
    let graph = format!("transport = 'emission'\noutput = 'magnitude.found'\n[slots]\nmagnitude = '{filling}'\n[pass.magnitude]");
    let scene = scene("cornell");
    let mut renderer = Parts { shaders: &[("pass/magnitude", KERNEL)], ..Parts::new(&scene, &graph) }.renderer(context);
    renderer.frame().unwrap();
    let words = renderer.read_f32("magnitude.found").unwrap();
    words.chunks_exact(4).map(|word| ([0, 1, 2].map(|channel| f64::from(word[channel])), f64::from(word[3]))).collect()
}

fn norm(color: [f64; 3]) -> f64 {
    (color.iter().map(|channel| channel * channel).sum::<f64>() / 3.0).sqrt()
}

#[test]
fn magnitudes_are_those_of_their_formulas_over_forty_decades() {
    let Some(context) = context() else { return };
    for (filling, formula) in [("luminance", luminance as fn([f64; 3]) -> f64), ("norm", norm)] {
        let found = magnitudes(&context, filling);
        let decades = found
            .iter()
            .map(|(color, _)| color[0])
            .fold((f64::MAX, 0.0_f64), |(low, high), red| if red > 0.0 { (low.min(red), high.max(red)) } else { (low, high) });
        assert!(decades.0 < 1e-19 && decades.1 > 1e18, "{decades:?}");
        for (color, magnitude) in found {
            let expected = formula(color);
            assert!((magnitude - expected).abs() <= 1e-5 * expected, "{filling} of {color:?}: {magnitude}, not {expected}");
        }
    }
}

/// What pixels show over seeds: red, green, blue, luminance; and each seed's mean of luminance. Of one among hundreds of paths, or little were left to choose.
fn pixels(context: &Context, filling: &str) -> (Vec<[Moments; 4]>, Vec<f64>) {
    const SEEDS: u64 = 24;
    let graph = format!("extends = 'restir_gi_spatial_only.toml'\n[slots]\nmagnitude = '{filling}'");
    let scene = scene("cornell");
    let mut renderer =
        Parts { keep: &["shade.color"], settings: &["initial.candidates=24"], ..Parts::new(&scene, &graph) }.renderer(context);
    let mut pixels = vec![[Moments::default(); 4]; 64 * 36];
    let mut means = Vec::new();
    for seed in 0..SEEDS {
        let film = shaded(&mut renderer, "shade.color", seed, 0);
        means.push(film.color.iter().map(|color| luminance(color.map(f64::from))).collect::<Moments>().mean());
        for (pixel, color) in pixels.iter_mut().zip(film.color) {
            let [r, g, b] = color.map(f64::from);
            pixel.iter_mut().zip([r, g, b, luminance([r, g, b])]).for_each(|(moments, value)| moments.push(value));
        }
    }
    (pixels, means)
}

/// Variance of a pixel, over channels, or of luminance; summed over pixels.
fn variance(pixels: &[[Moments; 4]], channels: std::ops::Range<usize>) -> f64 {
    let of = |moments: &Moments| moments.standard_error().powi(2) * moments.count() as f64;
    pixels.iter().flat_map(|pixel| &pixel[channels.clone()]).map(of).sum()
}

#[test]
fn norms_leave_the_least_error_over_channels_and_luminances_the_least_noise_of_luminance() {
    let Some(context) = context() else { return };
    let [(by_luminance, means), (by_norm, norm_means)] = ["luminance", "norm"].map(|filling| pixels(&context, filling));
    let channels = variance(&by_luminance, 0..3) / variance(&by_norm, 0..3);
    let gray = variance(&by_luminance, 3..4) / variance(&by_norm, 3..4);
    // The mean is the same: targets steer what is kept, not what it is worth. Pixels share samples: one number a seed.
    let apart: Moments = means.iter().zip(&norm_means).map(|(a, b)| a - b).collect();
    let mean: Moments = norm_means.into_iter().collect();
    let apart = Difference { value: apart.mean(), standard_error: apart.standard_error(), freedom: apart.count() as f64 - 1.0 }
        .relative_to(mean.mean());
    eprintln!(
        "by luminance, the variance over channels is {channels:.2} times as large as by norm, that of luminance {gray:.2} times; means {apart:?}"
    );
    assert!(channels > 1.15, "{channels}");
    assert!(gray < 0.95, "{gray}");
    assert!(apart.standard_error < 0.01 && apart.score(0.0).abs() < 4.5, "{apart:?}");
}
