//! Points of the plots: the script draws them, this says which there are.

use crate::compare::{
    report::{Cell, Point, Protocol, Reach, SceneResult},
    summary::Summary,
};
use serde::Serialize;

/// A plot's place on the page.
#[derive(Debug, Serialize)]
pub(super) struct Chart {
    pub(super) kind: &'static str,
    pub(super) title: &'static str,
    pub(super) about: &'static str,
}

/// A measured point. Errors are value, low and high.
#[derive(Debug, Serialize)]
pub(super) struct Measured {
    graph: usize,
    frame: u32,
    time: f64,
    time_low: Option<f64>,
    time_high: Option<f64>,
    mse: [f64; 3],
    rel_mse: Option<[f64; 3]>,
}

/// A point of a correlation.
#[derive(Debug, Serialize)]
pub(super) struct Lag {
    graph: usize,
    lag: usize,
    value: f64,
}

/// When a graph reaches the error that all are asked for.
#[derive(Debug, Serialize)]
pub(super) struct Reached {
    graph: usize,
    time: f64,
    low: f64,
    high: f64,
    at_once: bool,
}

fn band(summary: &Summary) -> [f64; 3] {
    let [low, high] = summary.interval.unwrap_or([summary.median; 2]);
    [summary.median, low, high]
}

impl Measured {
    fn of_cell(cell: &Cell) -> Self {
        Self {
            graph: cell.graph,
            frame: cell.variants.first().map_or(1, |variant| variant.frames),
            time: cell.time_ms.median,
            time_low: cell.time_ms.interval.map(|[low, _]| low),
            time_high: cell.time_ms.interval.map(|[_, high]| high),
            mse: band(&cell.mse),
            rel_mse: cell.rel_mse.as_ref().map(band),
        }
    }

    fn of_point(graph: usize, point: &Point) -> Self {
        Self {
            graph,
            frame: point.frame,
            time: point.time_ms,
            time_low: None,
            time_high: None,
            mse: band(&point.mse),
            rel_mse: point.rel_mse.as_ref().map(band),
        }
    }
}

/// Every cell.
pub(super) fn cells(scene: &SceneResult) -> Vec<Measured> {
    scene.cells.iter().map(Measured::of_cell).collect()
}

/// The longest curve of every graph; of graphs without one, their cells.
pub(super) fn curve(scene: &SceneResult) -> Vec<Measured> {
    let of_graph = |graph: usize| scene.cells.iter().filter(move |cell| cell.graph == graph);
    let points = |graph: usize| -> Vec<Measured> {
        let longest = of_graph(graph).map(|cell| &cell.curve).max_by_key(|curve| curve.len());
        match longest.filter(|curve| !curve.is_empty()) {
            Some(curve) => curve.iter().map(|point| Measured::of_point(graph, point)).collect(),
            None => of_graph(graph).map(Measured::of_cell).collect(),
        }
    };
    let mut points: Vec<Measured> = graphs(scene).into_iter().flat_map(points).collect();
    points.sort_by(|a, b| a.graph.cmp(&b.graph).then(a.time.total_cmp(&b.time)));
    points
}

/// Graphs that reach the error of equal error.
pub(super) fn reached(scene: &SceneResult) -> Vec<Reached> {
    let reach = |reach: &Reach| {
        let time = reach.time_ms?;
        let [low, high] = reach.interval.unwrap_or([time; 2]);
        Some(Reached { graph: scene.cells.get(reach.cell)?.graph, time, low, high, at_once: reach.at_once })
    };
    scene.equal_error.iter().flat_map(|found| &found.reaches).filter_map(reach).collect()
}

/// Graphs of the scene, once each.
pub(super) fn graphs(scene: &SceneResult) -> Vec<usize> {
    let mut graphs: Vec<usize> = scene.cells.iter().map(|cell| cell.graph).collect();
    graphs.sort_unstable();
    graphs.dedup();
    graphs
}

const TIME: Chart = Chart {
    kind: "time",
    title: "Error against time",
    about: "medians, 95 % bands; dotted: N⁻¹ᐟ², what more independent samples would do",
};
const FRAME: Chart = Chart { kind: "frame", title: "Error of each frame", about: "medians, 95 % bands" };
const PARETO: Chart = Chart { kind: "pareto", title: "Pareto front", about: "every graph and budget; filled: beaten by none in both" };
const REACH: Chart = Chart { kind: "reach", title: "Time to equal error", about: "95 % intervals; open: less, its first frame is there" };
const TEMPORAL: Chart = Chart { kind: "temporal", title: "Between frames", about: "covariance over variance; 0: independent" };
const SPATIAL: Chart = Chart { kind: "spatial", title: "Between pixels", about: "covariance over variance; 0: independent" };

/// The plots that have something to show beyond each other.
pub(super) fn of_errors(protocol: &Protocol, scene: &SceneResult) -> Vec<Chart> {
    let several = scene.cells.len() > graphs(scene).len().min(2) || scene.cells.iter().any(|cell| !cell.curve.is_empty());
    match protocol {
        _ if scene.cells.is_empty() => vec![],
        Protocol::Trace { .. } => vec![FRAME, PARETO],
        _ if !reached(scene).is_empty() => vec![TIME, PARETO, REACH],
        _ if several => vec![TIME, PARETO],
        _ => vec![TIME],
    }
}

/// The plots of correlation, with lags beyond 0.
pub(super) fn of_correlation(temporal: &[Lag], spatial: &[Lag]) -> Vec<Chart> {
    let there = |chart, points: &[Lag]| (points.iter().map(|point| point.lag).max() > Some(1)).then_some(chart);
    there(TEMPORAL, temporal).into_iter().chain(there(SPATIAL, spatial)).collect()
}

/// Correlations of the first cell of every graph that has them; lag 1 is the next frame or pixel.
pub(super) fn lags(scene: &SceneResult, values: fn(&Cell) -> Option<&Vec<f64>>) -> Vec<Lag> {
    let mut points = Vec::new();
    for graph in graphs(scene) {
        let first = scene.cells.iter().filter(|cell| cell.graph == graph).find_map(values);
        let lags = first.into_iter().flatten().enumerate();
        points.extend(lags.map(|(i, &value)| Lag { graph, lag: i + 1, value }));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(graph: usize, time: f64, curve: usize) -> Cell {
        let curve = (0..curve).map(|i| Point { frame: i as u32, time_ms: i as f64, ..Point::default() }).collect();
        Cell { graph, time_ms: Summary { median: time, ..Summary::default() }, curve, ..Cell::default() }
    }

    #[test]
    fn curves_are_the_longest_or_the_cells_in_order_of_time() {
        let scene =
            SceneResult { cells: vec![cell(1, 9.0, 0), cell(0, 5.0, 2), cell(0, 7.0, 3), cell(1, 4.0, 0)], ..SceneResult::default() };
        let points: Vec<_> = curve(&scene).iter().map(|point| (point.graph, point.time)).collect();
        assert_eq!(points, [(0, 0.0), (0, 1.0), (0, 2.0), (1, 4.0), (1, 9.0)]);
        let kinds = |scene: &SceneResult| of_errors(&Protocol::default(), scene).iter().map(|chart| chart.kind).collect::<Vec<_>>();
        assert_eq!(kinds(&scene), ["time", "pareto"]);
        let sweep = |n: usize| SceneResult { cells: (0..n).map(|graph| cell(graph, 1.0, 0)).collect(), ..SceneResult::default() };
        assert_eq!(kinds(&sweep(2)), ["time"]);
        assert_eq!(kinds(&sweep(3)), ["time", "pareto"], "a sweep has a front");
        assert!(kinds(&SceneResult::default()).is_empty());
    }
}
