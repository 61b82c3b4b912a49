//! Known answers: synthetic estimators whose bias, variance and correlation are known, through the meters.

use super::{
    bias::{bias, bias_squared, verdict_of},
    correlation::{accumulation_gain, correlation},
    report::{BiasFigures, BiasVerdict},
};
use crate::{
    film::Film,
    stats::{multiple::plausible_count, rng::SplitMix},
};

const SIZE: [u32; 2] = [16, 9];
const PIXELS: usize = 144;
const SEEDS: usize = 16;

/// The truth: a ramp of mean 1.
fn truth(i: usize) -> f64 {
    0.5 + i as f64 / (PIXELS - 1) as f64
}

/// The truth times `1 + offset`, with relative noise.
fn render(rng: &mut SplitMix, offset: f64, deviation: f64) -> Film {
    let pixel = |i: usize| [0, 1, 2].map(|_| (truth(i) * (1.0 + offset + deviation * rng.normal())) as f32);
    Film::new(SIZE, (0..PIXELS).map(pixel).collect()).unwrap()
}

/// The truth with noise that its variance tells.
fn reference(rng: &mut SplitMix, deviation: f64) -> Film {
    let variance = (0..PIXELS).map(|i| [((truth(i) * deviation).powi(2)) as f32; 3]).collect();
    Film { variance: Some(variance), ..render(rng, 0.0, deviation) }
}

fn measured(rng: &mut SplitMix, offset: f64, deviation: f64, reference_deviation: f64) -> BiasFigures {
    let reference = reference(rng, reference_deviation);
    let films: Vec<Film> = (0..SEEDS).map(|_| render(rng, offset, deviation)).collect();
    bias(&films, &reference).unwrap()
}

/// Mean of the squared truth: what relative offsets and deviations are multiplied by.
fn square() -> f64 {
    (0..PIXELS).map(|i| truth(i).powi(2)).sum::<f64>() / PIXELS as f64
}

fn covers(interval: Option<[f64; 2]>, value: f64) -> bool {
    interval.is_some_and(|[low, high]| (low..=high).contains(&value))
}

#[test]
fn an_offset_and_noise_lie_within_their_intervals() {
    let mut rng = SplitMix::new(91);
    let runs: Vec<BiasFigures> = (0..60).map(|_| measured(&mut rng, 0.05, 0.2, 0.02)).collect();
    let bias = runs.iter().filter(|run| covers(run.bias_squared_interval, 0.05_f64.powi(2) * square())).count();
    let variance = runs.iter().filter(|run| covers(run.variance_interval, 0.2_f64.powi(2) * square())).count();
    // Percentile intervals of 16 seeds are somewhat narrow: 90 % is what they must have.
    assert!(bias >= 51 && variance >= 51, "{bias} and {variance} of 60");
    let mean = runs.iter().map(|run| run.bias_squared).sum::<f64>() / 60.0;
    assert!((mean / (0.05_f64.powi(2) * square()) - 1.0).abs() < 0.05, "{mean}");
}

#[test]
fn the_noise_of_renders_and_reference_is_no_bias() {
    let mut rng = SplitMix::new(92);
    let runs: Vec<f64> = (0..100).map(|_| squared(&mut rng)).collect();
    let moments = runs.iter().copied().collect::<crate::stats::Moments>();
    assert!(moments.mean().abs() < 4.0 * moments.standard_error(), "{moments:?}");
    // The test would see a hundredth of the variance left in.
    assert!(0.01 * 0.3_f64.powi(2) * square() > 4.0 * moments.standard_error());
}

fn squared(rng: &mut SplitMix) -> f64 {
    let reference = reference(rng, 0.1);
    let films: Vec<Film> = (0..SEEDS).map(|_| render(rng, 0.0, 0.3)).collect();
    bias_squared(&films, &reference).unwrap()
}

/// Noise of a channel at which the mean luminance of 16 renders of 144 pixels is known to 0.06 %, the band over 3.3: luminance has 0.75 of
/// the noise of a channel, √(16 · 144) = 48, and the root mean square of the truth is 1.04.
const RESOLVED: f64 = 0.0006 * 48.0 / 0.75 / 1.04;

#[test]
fn equal_expectations_are_rarely_called_biased() {
    let mut rng = SplitMix::new(93);
    let verdicts: Vec<BiasVerdict> = (0..1000).map(|_| quick_verdict(&mut rng, 0.0)).collect();
    let biased = verdicts.iter().filter(|verdict| **verdict == BiasVerdict::Biased).count();
    let unbiased = verdicts.iter().filter(|verdict| **verdict == BiasVerdict::Unbiased).count();
    // 6.5 % is the upper end for 1,000 runs at a level of 5 %. Equivalence is shown when |t| < 3.33 − 1.75: nearly nine times of ten.
    assert!(biased <= 65 && unbiased >= 850, "{biased} biased and {unbiased} unbiased of 1000");
}

#[test]
fn planted_biases_of_half_a_percent_are_found() {
    let mut rng = SplitMix::new(94);
    let found = (0..200).filter(|_| quick_verdict(&mut rng, 0.005) == BiasVerdict::Biased).count();
    assert!(found >= 180, "{found} of 200");
}

/// The verdict alone: what the meters say of the mean.
fn quick_verdict(rng: &mut SplitMix, offset: f64) -> BiasVerdict {
    let reference = reference(rng, RESOLVED / 64.0);
    let films: Vec<Film> = (0..SEEDS).map(|_| render(rng, offset, RESOLVED)).collect();
    verdict_of(&films, &reference)
}

#[test]
fn averages_fall_as_one_over_n_only_where_frames_are_independent() {
    let mut rng = SplitMix::new(95);
    let gain = |correlation: f64, rng: &mut SplitMix| {
        let runs: Vec<Vec<Film>> = (0..SEEDS).map(|_| averages(rng, correlation, 16)).collect();
        let means = [1, 2, 4, 8, 16].map(|n| (n, runs.iter().map(|run| run[n as usize - 1].clone()).collect()));
        accumulation_gain(&means).last().unwrap().1
    };
    assert!((gain(0.0, &mut rng) - 1.0).abs() < 0.1);
    // AR(1) with ρ = 0.8: 16 Var(mean of 16) / Var = (1 + ρ)/(1 − ρ) − 2ρ(1 − ρ¹⁶)/(16 (1 − ρ)²) = 6.56.
    assert!((gain(0.8, &mut rng) * 6.56 - 1.0).abs() < 0.15);
}

#[test]
fn correlation_in_time_and_space_is_measured() {
    let mut rng = SplitMix::new(96);
    let runs: Vec<Vec<Film>> = (0..SEEDS).map(|_| frames(&mut rng, 0.6, 4)).collect();
    let by_frame: Vec<Vec<Film>> = (0..4).map(|k| runs.iter().map(|run| run[k].clone()).collect()).collect();
    let found = correlation(&by_frame);
    for (lag, value) in found.temporal.iter().enumerate() {
        assert!((value - 0.6_f64.powi(lag as i32 + 1)).abs() < 0.06, "{:?}", found.temporal);
    }
    assert!(found.spatial.iter().all(|value| value.abs() < 0.06), "{:?}", found.spatial);
    // Every pixel takes its left neighbour's noise for half of its own: correlation ½ at distance 1 across, 0 down: ¼ of both.
    let smeared: Vec<Film> = runs.iter().map(|run| smear(&run[0])).collect();
    let found = correlation(&[smeared]);
    assert!((found.spatial[0] - 0.25).abs() < 0.06 && found.spatial[1].abs() < 0.06, "{:?}", found.spatial);
}

/// Successive frames whose noise is AR(1).
fn frames(rng: &mut SplitMix, correlation: f64, count: usize) -> Vec<Film> {
    let mut noise: Vec<f64> = (0..3 * PIXELS).map(|_| rng.normal()).collect();
    let mut films = Vec::new();
    for _ in 0..count {
        let color = (0..PIXELS).map(|i| [0, 1, 2].map(|c| (5.0 + noise[3 * i + c]) as f32)).collect();
        films.push(Film::new(SIZE, color).unwrap());
        for value in &mut noise {
            *value = correlation * *value + (1.0 - correlation * correlation).sqrt() * rng.normal();
        }
    }
    films
}

/// Running means of such frames.
fn averages(rng: &mut SplitMix, correlation: f64, count: usize) -> Vec<Film> {
    let mut sum = vec![[0.0_f32; 3]; PIXELS];
    let mut means = Vec::new();
    for (k, film) in frames(rng, correlation, count).into_iter().enumerate() {
        sum.iter_mut().flatten().zip(film.color.iter().flatten()).for_each(|(sum, value)| *sum += value);
        means.push(Film::new(SIZE, sum.iter().map(|sum| sum.map(|sum| sum / (k + 1) as f32)).collect()).unwrap());
    }
    means
}

fn smear(film: &Film) -> Film {
    let width = SIZE[0] as usize;
    let left = |i: usize| if i.is_multiple_of(width) { i + width - 1 } else { i - 1 };
    let color = (0..PIXELS).map(|i| [0, 1, 2].map(|c| 0.5 * (film.color[i][c] + film.color[left(i)][c]))).collect();
    Film::new(SIZE, color).unwrap()
}

#[test]
fn false_alarms_of_pixels_are_counted() {
    let mut rng = SplitMix::new(97);
    let share = measured(&mut rng, 0.0, 0.3, 0.02).pixels_rejected;
    assert!(plausible_count((share * 432.0).round() as u64, 432, 0.01), "{share}");
    assert!(measured(&mut rng, 0.5, 0.3, 0.02).pixels_rejected > 0.9);
}
