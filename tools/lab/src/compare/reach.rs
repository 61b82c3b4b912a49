//! Equal error: the time at which a graph's error, averaged over a growing budget, falls to a given one.
//!
//! Between two measured budgets error is taken for a power of time, as the error of averages is; beyond the largest nothing is said. Intervals
//! resample the seeds, whose curves stay whole.

use super::{
    report::{Cell, EqualError, Point, Ratio, Reach},
    summary::median,
};
use crate::stats::bootstrap::Bootstrap;

/// The time of every graph with a curve to reach `asked`, or what all of them reach; the first graph is the baseline. `None` without curves.
pub fn equal_error(cells: &[Cell], names: &[String], asked: Option<f64>) -> Option<EqualError> {
    let of_graph = |graph: usize| cells.iter().position(|cell| cell.graph == graph && cell.curve.len() > 1);
    let curves: Vec<usize> = (0..names.len()).filter_map(of_graph).collect();
    let mse = asked.or_else(|| common(curves.iter().map(|&cell| &cells[cell])))?;
    let baseline = curves.iter().copied().find(|&cell| cells[cell].graph == 0);
    let reaches: Vec<Reach> = curves.iter().map(|&cell| reach(cells, cell, baseline, names, mse)).collect();
    (!reaches.is_empty()).then_some(EqualError { mse, reaches })
}

/// The error that the worst of them has at half of its largest budget: chance will hardly keep any from it at the whole.
fn common<'a>(cells: impl Iterator<Item = &'a Cell>) -> Option<f64> {
    let half = |cell: &Cell| {
        let most = cell.curve.last()?.frame;
        cell.curve.iter().rfind(|point| 2 * point.frame <= most).map(|point| point.mse.median)
    };
    cells.filter_map(half).filter(|mse| *mse > 0.0).reduce(f64::max)
}

fn reach(cells: &[Cell], cell: usize, baseline: Option<usize>, names: &[String], mse: f64) -> Reach {
    let curve = &cells[cell].curve;
    let seeds = seeds(curve);
    let found = Bootstrap::default().of_indices(&[seeds], |chosen| time_to(curve, mse, &chosen[0]));
    let time_ms = Some(found.estimate).filter(|time| time.is_finite());
    let interval = time_ms.and(finite([found.low, found.high]));
    let at_once = error(&curve[0], &(0..seeds).collect::<Vec<_>>()) <= mse;
    let against = baseline.filter(|&baseline| baseline != cell);
    let speed_up = against.and_then(|baseline| speed_up(&cells[baseline].curve, curve, mse));
    let mut reach = Reach { cell, time_ms, interval, at_once, speed_up, sentence: String::new() };
    reach.sentence = sentence(&reach, &names[cells[cell].graph], &names[0], curve);
    reach
}

fn speed_up(baseline: &[Point], other: &[Point], mse: f64) -> Option<Ratio> {
    let sizes = [seeds(baseline), seeds(other)];
    let found = Bootstrap::default().of_indices(&sizes, |chosen| time_to(baseline, mse, &chosen[0]) / time_to(other, mse, &chosen[1]));
    found
        .estimate
        .is_finite()
        .then(|| Ratio { value: found.estimate, interval: finite([found.low, found.high]) })
        .filter(|ratio| ratio.value > 0.0)
}

fn finite(ends: [f64; 2]) -> Option<[f64; 2]> {
    ends.iter().all(|end| end.is_finite()).then_some(ends)
}

/// Seeds that every point has.
fn seeds(curve: &[Point]) -> usize {
    curve.iter().map(|point| point.mse.values.len()).min().unwrap_or(0)
}

fn error(point: &Point, seeds: &[usize]) -> f64 {
    median(&seeds.iter().map(|&seed| point.mse.values[seed]).collect::<Vec<_>>())
}

fn time(point: &Point, seeds: &[usize]) -> f64 {
    let times: Option<Vec<f64>> = seeds.iter().map(|&seed| point.times_ms.get(seed).copied()).collect();
    times.map_or(point.time_ms, |times| median(&times))
}

/// Milliseconds at which the median of these seeds comes down to `mse`; that of the first point where it is there already, infinite where it
/// never is.
fn time_to(curve: &[Point], mse: f64, seeds: &[usize]) -> f64 {
    let Some(there) = curve.iter().position(|point| error(point, seeds) <= mse) else { return f64::INFINITY };
    let at = |index: usize| (time(&curve[index], seeds), error(&curve[index], seeds));
    let (late, low) = at(there);
    if there == 0 {
        return late;
    }
    let (early, high) = at(there - 1);
    // An error that the reference's noise hides has no logarithm.
    let share = if low > 0.0 && low < high { (high / mse).ln() / (high / low).ln() } else { 1.0 };
    early * (late / early).powf(share)
}

fn sentence(reach: &Reach, name: &str, baseline: &str, curve: &[Point]) -> String {
    let Some(time) = reach.time_ms else {
        let most = curve.last().map_or(0.0, |point| point.time_ms);
        return format!("`{name}` does not reach it in {most:.1} ms");
    };
    let least = if reach.at_once { "at most " } else { "" };
    let against = match reach.speed_up {
        None => String::new(),
        Some(Ratio { value, interval }) => {
            let (factor, word, ends) = match value >= 1.0 {
                true => (value, "sooner", interval),
                false => (1.0 / value, "later", interval.map(|[low, high]| [1.0 / high, 1.0 / low])),
            };
            let ends = ends.map(|[low, high]| format!(" (95 %: {low:.2} to {high:.2})")).unwrap_or_default();
            format!(", {factor:.2}{ends} times {word} than `{baseline}`")
        }
    };
    format!("`{name}` reaches it in {least}{time:.1} ms{against}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{compare::summary::Summary, stats::rng::SplitMix};

    /// Error falls as 1/time from `error` in `ms` milliseconds, with the noise of 16 seeds.
    fn cell(rng: &mut SplitMix, graph: usize, error: f64, ms: f64, spread: f64) -> Cell {
        let point = |frame: u32| {
            let n = f64::from(frame);
            let mut values = |value: f64, spread: f64| (0..16).map(|_| value * (spread * rng.normal()).exp()).collect::<Vec<f64>>();
            let (errors, times) = (values(error / n, spread), values(ms * n, 0.1 * spread));
            Point { frame, time_ms: median(&times), times_ms: times, mse: Summary::of(errors), ..Point::default() }
        };
        let curve = [1, 2, 4, 8, 16, 24].map(point).to_vec();
        Cell { graph, curve, ..Cell::default() }
    }

    fn names() -> Vec<String> {
        ["a", "b"].map(String::from).to_vec()
    }

    #[test]
    fn a_power_of_time_is_met_exactly() {
        let mut rng = SplitMix::new(61);
        let cells = [cell(&mut rng, 0, 6.0, 10.0, 0.0), cell(&mut rng, 1, 3.0, 4.0, 0.0)];
        let found = equal_error(&cells, &names(), Some(0.5)).unwrap();
        let [a, b] = [&found.reaches[0], &found.reaches[1]];
        assert!((a.time_ms.unwrap() - 120.0).abs() < 1e-9 && (b.time_ms.unwrap() - 24.0).abs() < 1e-9, "{found:?}");
        assert!((b.speed_up.unwrap().value - 5.0).abs() < 1e-9 && a.speed_up.is_none());
        assert_eq!(b.sentence, "`b` reaches it in 24.0 ms, 5.00 (95 %: 5.00 to 5.00) times sooner than `a`");
        // Unasked, it is what the worst has at a third of its frames: the largest measured that is not above half.
        assert!((equal_error(&cells, &names(), None).unwrap().mse - 0.75).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_reached_or_there_at_once_is_said() {
        let mut rng = SplitMix::new(62);
        let cells = [cell(&mut rng, 0, 6.0, 10.0, 0.0), cell(&mut rng, 1, 0.2, 4.0, 0.0)];
        let found = equal_error(&cells, &names(), Some(0.24)).unwrap();
        assert_eq!(found.reaches[0].time_ms, None);
        assert_eq!(found.reaches[0].sentence, "`a` does not reach it in 240.0 ms");
        assert!(found.reaches[1].at_once && found.reaches[1].speed_up.is_none());
        assert_eq!(found.reaches[1].sentence, "`b` reaches it in at most 4.0 ms");
        assert_eq!(equal_error(&[Cell::default()], &names(), Some(1.0)), None);
    }

    /// Of 40 noisy pairs, the interval of the speed-up holds the true one about as often as it says.
    #[test]
    fn intervals_hold_the_true_speed_up() {
        let mut rng = SplitMix::new(63);
        let holds = (0..40).filter(|_| {
            let [a, b] = [cell(&mut rng, 0, 6.0, 10.0, 0.3), cell(&mut rng, 1, 3.0, 4.0, 0.3)];
            let [low, high] = speed_up(&a.curve, &b.curve, 0.9).unwrap().interval.unwrap();
            low < 5.0 && 5.0 < high && high / low < 3.0
        });
        let holds = holds.count();
        // 95 % of 40 is 38; fewer than 33 has a chance of 0.1 %.
        assert!(holds >= 33, "{holds} of 40");
    }
}
