//! How much of the error is bias.
//!
//! With renders xᵢ of independent seeds, a truth t that is known as r with variance v, and ⟨·,·⟩ the mean over pixels and channels, every pair
//! i ≠ j has E⟨xᵢ − r, xⱼ − r⟩ = bias² + v, for xᵢ and xⱼ share nothing but r. Their mean less v is the squared bias, without the noise of any
//! render in it, and what is left of E⟨xᵢ − r, xᵢ − r⟩ is the variance. Both may come out below zero by chance.

use super::report::{BiasFigures, BiasVerdict};
use crate::{
    film::{Film, luminance},
    stats::{
        Difference, Estimate, Moments, Rule, SizesDiffer, Verdict,
        bootstrap::{Bootstrap, Method},
        ensemble::Ensemble,
        error::mse,
    },
};

/// The largest relative difference of means that counts as none.
pub const BAND: f64 = 0.002;
/// Chance of a wrong verdict.
const ALPHA: f64 = 0.05;
/// Level of each pixel's t-test.
const PIXEL_ALPHA: f64 = 0.01;

/// Bias and variance of one render, from at least two.
///
/// # Errors
/// For films of different sizes.
pub fn bias(films: &[Film], reference: &Film) -> Result<BiasFigures, SizesDiffer> {
    let products = Products::new(films, reference)?;
    let interval = |statistic: &dyn Fn(&[usize]) -> f64| {
        let bootstrap = Bootstrap { method: Method::Percentile, ..Bootstrap::default() };
        let found = bootstrap.of_indices(&[films.len()], |chosen| statistic(&chosen[0]));
        [found.low, found.high].iter().all(|end| end.is_finite()).then_some([found.low, found.high])
    };
    let all: Vec<usize> = (0..films.len()).collect();
    let difference = mean_difference(films, reference);
    let mut ensemble = Ensemble::default();
    films.iter().try_for_each(|film| ensemble.push(film))?;
    Ok(BiasFigures {
        seeds: films.len() as u64,
        bias_squared: products.bias_squared(&all),
        bias_squared_interval: interval(&|chosen| products.bias_squared(chosen)),
        variance: products.variance(&all),
        variance_interval: interval(&|chosen| products.variance(chosen)),
        mean_difference: difference.value,
        mean_error: difference.standard_error,
        band: BAND,
        verdict: verdict(difference),
        pixels_rejected: rejected(&t_values(&ensemble.film(), reference), films.len()),
        ..BiasFigures::default()
    })
}

/// ⟨xᵢ − r, xⱼ − r⟩ of all pairs, less the reference's variance.
struct Products {
    count: usize,
    values: Vec<f64>,
}

impl Products {
    fn new(films: &[Film], reference: &Film) -> Result<Self, SizesDiffer> {
        let count = films.len();
        let mut values = vec![0.0; count * count];
        let deviations = |film: &Film| -> Vec<f64> {
            film.color.iter().flatten().zip(reference.color.iter().flatten()).map(|(x, r)| f64::from(*x) - f64::from(*r)).collect()
        };
        let deviations: Vec<Vec<f64>> = films.iter().map(deviations).collect();
        for i in 0..count {
            // The diagonal is the mean square error, whose own code knows the reference's variance and checks sizes.
            let own = mse(&films[i], reference)?;
            values[i * count + i] = own.value();
            for j in 0..i {
                let product = deviations[i].iter().zip(&deviations[j]).map(|(a, b)| a * b).sum::<f64>() / deviations[i].len() as f64;
                (values[i * count + j], values[j * count + i]) = (product - own.reference, product - own.reference);
            }
        }
        Ok(Self { count, values })
    }

    /// Mean over pairs of different renders; a resampled list holds some twice, and those are no pair.
    fn bias_squared(&self, chosen: &[usize]) -> f64 {
        let pairs = chosen.iter().flat_map(|&i| chosen.iter().map(move |&j| (i, j))).filter(|(i, j)| i != j);
        let (sum, count) = pairs.fold((0.0, 0_u32), |(sum, count), (i, j)| (sum + self.values[i * self.count + j], count + 1));
        sum / f64::from(count)
    }

    fn variance(&self, chosen: &[usize]) -> f64 {
        let own = chosen.iter().map(|&i| self.values[i * self.count + i]).sum::<f64>() / chosen.len() as f64;
        own - self.bias_squared(chosen)
    }
}

/// Mean luminance of the renders against the reference's, relative to it.
fn mean_difference(films: &[Film], reference: &Film) -> Difference {
    let mean = |film: &Film| film.color.iter().map(|color| luminance(color.map(f64::from))).sum::<f64>() / film.pixels() as f64;
    let ours: Moments = films.iter().map(mean).collect();
    // Channels of one pixel vary together: the errors of a pixel add, those of different pixels do not.
    let error = |variance: &[f32; 3]| luminance(variance.map(|v| f64::from(v).sqrt())).powi(2);
    let noise = reference.variance.iter().flatten().map(error).sum::<f64>().sqrt() / reference.pixels() as f64;
    let truth = Estimate { mean: mean(reference), standard_error: noise, freedom: f64::INFINITY };
    Difference::welch(&ours, truth).relative_to(truth.mean)
}

/// The squared bias alone.
///
/// # Errors
/// For films of different sizes.
pub fn bias_squared(films: &[Film], reference: &Film) -> Result<f64, SizesDiffer> {
    let all: Vec<usize> = (0..films.len()).collect();
    Ok(Products::new(films, reference)?.bias_squared(&all))
}

/// The equivalence test's word alone.
pub fn verdict_of(films: &[Film], reference: &Film) -> BiasVerdict {
    verdict(mean_difference(films, reference))
}

fn verdict(difference: Difference) -> BiasVerdict {
    match difference.judge(BAND, Rule::Equivalent { alpha: ALPHA }) {
        Verdict::Passed => BiasVerdict::Unbiased,
        Verdict::Failed => BiasVerdict::Biased,
        Verdict::NotResolved => BiasVerdict::NotResolved,
    }
}

/// How many standard errors the mean of renders is from the reference, in every channel of every pixel; 0 where neither varies.
pub fn t_values(mean: &Film, reference: &Film) -> Film {
    let of = |film: &Film, i: usize, c: usize| film.variance.as_ref().map_or(0.0, |variance| variance[i][c]);
    let t = |i: usize, c: usize| {
        let error = (of(mean, i, c) + of(reference, i, c)).sqrt();
        if error > 0.0 { (mean.color[i][c] - reference.color[i][c]) / error } else { 0.0 }
    };
    Film { size: mean.size, color: (0..mean.pixels()).map(|i| [0, 1, 2].map(|c| t(i, c))).collect(), ..Film::default() }
}

/// Share of t values that reject "no bias", of those that vary at all.
fn rejected(t: &Film, renders: usize) -> f64 {
    let freedom = renders.saturating_sub(1).max(1) as f64;
    let rejects = |t: f32| Difference { value: t.into(), standard_error: 1.0, freedom }.p_different() <= PIXEL_ALPHA;
    let varying: Vec<f32> = t.color.iter().flatten().copied().filter(|t| *t != 0.0).collect();
    varying.iter().filter(|t| rejects(**t)).count() as f64 / varying.len().max(1) as f64
}
