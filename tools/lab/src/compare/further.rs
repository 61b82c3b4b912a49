//! Metrics beyond the two that are judged.

use super::summary::Summary;
use crate::{
    film::{Area, Film},
    metrics::{Metric, Pair},
    stats::SizesDiffer,
};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Further metrics by key, each over the films of all seeds; FLIP, which costs a hundred times the others, of the first film alone. What is
/// undefined (relative to black) or infinite (PSNR of equal images) for a film is left out.
pub fn metrics(films: &[Film], reference: &Film) -> Result<BTreeMap<String, Summary>, SizesDiffer> {
    let area = Area::whole(reference.size);
    let further: Vec<Metric> = Metric::all().filter(|metric| !matches!(metric, Metric::Mse | Metric::RelMse)).collect();
    let of_first = |metric: &Metric| matches!(metric, Metric::FlipLdr | Metric::FlipHdr);
    let measured = films.par_iter().enumerate().map(|(index, film)| {
        let pair = Pair::new(film, reference)?;
        let asked = further.iter().filter(|metric| index == 0 || !of_first(metric));
        asked.map(|&metric| Ok((metric, pair.measure(metric, &area)?.map(|value| value.value)))).collect()
    });
    let measured: Vec<Vec<(Metric, Option<f64>)>> = measured.collect::<Result<_, SizesDiffer>>()?;
    let values = |wanted: Metric| -> Option<Vec<f64>> {
        measured
            .iter()
            .flatten()
            .filter(|(metric, _)| *metric == wanted)
            .map(|(_, value)| value.filter(|value| value.is_finite()))
            .collect()
    };
    Ok(further.into_iter().filter_map(|metric| Some((metric.key().to_owned(), Summary::of(values(metric)?)))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_counts_but_for_flip() {
        let film = |value: f32| Film::new([8, 8], vec![[value; 3]; 64]).unwrap();
        let found = metrics(&[film(0.6), film(0.75), film(1.0)], &film(0.5)).unwrap();
        assert_eq!(found.keys().collect::<Vec<_>>(), ["flip_hdr", "flip_ldr", "mape", "psnr", "smape"]);
        assert_eq!([found["mape"].values.len(), found["flip_hdr"].values.len()], [3, 1]);
        assert!((found["mape"].median - 0.25 / 0.51).abs() < 1e-9);
        assert!(!metrics(&[film(1.0)], &film(1.0)).unwrap().contains_key("psnr"));
        // Against black, what is relative is absent.
        assert_eq!(metrics(&[film(1.0)], &film(0.0)).unwrap().keys().collect::<Vec<_>>(), ["flip_ldr", "psnr"]);
    }
}
