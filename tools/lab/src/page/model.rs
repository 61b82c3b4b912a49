//! What the page shows beside the report itself.

use super::{
    PageError,
    charts::{self, Chart, Lag, Measured, Reached},
    passes::{self, Bar, Line},
    picture::{self, Payload, Store},
    verdict::{self, Verdict},
    words::{self, number},
};
use crate::{
    compare::{
        judge,
        report::{BiasFigures, Correlation, Ratio, Report, SceneResult},
    },
    film::Film,
    metrics::Metric,
};
use serde::Serialize;
use std::path::Path;

/// Everything beside the report.
#[derive(Debug, Serialize)]
pub(super) struct Page {
    pub(super) title: String,
    pub(super) verdicts: Vec<Verdict>,
    pub(super) overview: Vec<Row>,
    pub(super) protocol: String,
    pub(super) clock: &'static str,
    pub(super) scenes: Vec<Scene>,
    pub(super) payloads: Vec<Payload>,
}

/// A graph's line of the overview.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    graph: usize,
    pairs: Vec<Option<Against>>,
}

#[derive(Debug, Serialize)]
struct Against {
    ratio: Ratio,
    rel_mse: Option<Ratio>,
    kind: &'static str,
}

/// One scene.
#[derive(Debug, Serialize)]
pub(super) struct Scene {
    id: String,
    result: SceneResult,
    graphs: Vec<usize>,
    pictures: Vec<Picture>,
    has_means: bool,
    single_seed: bool,
    left_out: Option<String>,
    charts: Vec<Chart>,
    both_errors: bool,
    metrics: Vec<MetricHead>,
    /// Indices of cells that no other beats; empty where there is little to choose from.
    front: Vec<usize>,
    passes: Vec<Bar>,
    pass_table: Vec<Line>,
    bias: Vec<BiasRow>,
    correlation: Vec<CorrelationRow>,
    gains: Vec<u32>,
    correlation_charts: Vec<Chart>,
    files: Vec<String>,
    /// For the script.
    #[serde(skip)]
    pub(super) data: Data,
}

/// What the script needs of a scene.
#[derive(Debug, Serialize)]
pub(super) struct Data {
    id: String,
    size: [u32; 2],
    black: bool,
    pictures: Vec<Picture>,
    curve: Vec<Measured>,
    cells: Vec<Measured>,
    temporal: Vec<Lag>,
    spatial: Vec<Lag>,
    reach: Vec<Reached>,
    /// The error of `reach`.
    reached: Option<f64>,
}

/// An image of the viewer: ids of payloads, the first picture being the reference.
#[derive(Clone, Debug, Serialize)]
struct Picture {
    label: String,
    graph: Option<usize>,
    image: String,
    flip: Option<String>,
    mean: Option<String>,
    mean_flip: Option<String>,
}

#[derive(Debug, Serialize)]
struct MetricHead {
    key: &'static str,
    name: &'static str,
}

#[derive(Debug, Serialize)]
struct BiasRow {
    graph: usize,
    kind: &'static str,
    mark: &'static str,
    mean: String,
    share: String,
    figures: BiasFigures,
}

#[derive(Debug, Serialize)]
struct CorrelationRow {
    graph: usize,
    temporal: Option<f64>,
    spatial: Option<f64>,
    flicker: f64,
    worth: Vec<Option<f64>>,
}

impl Page {
    pub(super) fn new(report: &Report, folder: &Path) -> Result<Self, PageError> {
        let mut store = Store::default();
        let scenes = report.scenes.iter().enumerate();
        let scenes = scenes.map(|(i, result)| Scene::new(report, i, result, folder, &mut store)).collect::<Result<_, _>>()?;
        Ok(Self {
            title: title(report),
            verdicts: verdict::of(report),
            overview: (1..report.graphs.len()).map(|graph| Row::new(report, graph)).collect(),
            protocol: words::protocol(&report.protocol),
            clock: match report.made.clock.as_str() {
                "timestamps" => "time on the device, by timestamps around every pass",
                _ => "wall time of submitted work (the device's timestamps are not sound)",
            },
            scenes,
            payloads: store.payloads,
        })
    }
}

fn title(report: &Report) -> String {
    let graphs: Vec<&str> = report.graphs.iter().map(|graph| graph.name.as_str()).collect();
    match (graphs.as_slice(), report.scenes.as_slice()) {
        ([], _) => "Comparison".into(),
        (graphs, [scene]) => format!("{} on {}", several(graphs), scene.name),
        (graphs, scenes) => format!("{} on {} scenes", several(graphs), scenes.len()),
    }
}

/// Names, while they fit into a title.
fn several(graphs: &[&str]) -> String {
    if graphs.len() > 4 { format!("{} graphs", graphs.len()) } else { graphs.join(" · ") }
}

impl Row {
    fn new(report: &Report, graph: usize) -> Self {
        let against = |scene| {
            let pair = verdict::pair(scene, graph)?;
            Some(Against { ratio: verdict::ratio(pair), rel_mse: pair.rel_mse, kind: verdict::kind(pair.better).0 })
        };
        Self { graph, pairs: report.scenes.iter().map(against).collect() }
    }
}

impl Scene {
    fn new(report: &Report, index: usize, result: &SceneResult, folder: &Path, store: &mut Store) -> Result<Self, PageError> {
        let id = format!("scene-{index}");
        let (pictures, left_out) = pictures(report, result, folder, store)?;
        let (passes, pass_table) = passes::of(result);
        let black = result.cells.iter().all(|cell| cell.rel_mse.is_none());
        let temporal = charts::lags(result, |cell| cell.correlation.as_ref().map(|c| &c.temporal));
        let spatial = charts::lags(result, |cell| cell.correlation.as_ref().map(|c| &c.spatial));
        let gains = gains(result);
        Ok(Self {
            graphs: charts::graphs(result),
            has_means: pictures.iter().any(|picture| picture.mean.is_some()),
            single_seed: pictures.len() > 1,
            left_out,
            charts: charts::of_errors(&report.protocol, result),
            both_errors: !black,
            metrics: metric_heads(result),
            front: if result.cells.len() > 2 { judge::front(&result.cells) } else { vec![] },
            passes,
            pass_table,
            bias: bias_rows(result),
            correlation: correlation_rows(result, &gains),
            correlation_charts: charts::of_correlation(&temporal, &spatial),
            gains,
            files: files(result),
            data: Data {
                id: id.clone(),
                size: result.size,
                black,
                pictures: pictures.clone(),
                curve: charts::curve(result),
                cells: charts::cells(result),
                temporal,
                spatial,
                reach: charts::reached(result),
                reached: result.equal_error.as_ref().map(|found| found.mse),
            },
            result: result.clone(),
            pictures,
            id,
        })
    }
}

/// The reference and every cell's images, with a word on what is missing.
fn pictures(report: &Report, scene: &SceneResult, folder: &Path, store: &mut Store) -> Result<(Vec<Picture>, Option<String>), PageError> {
    let Some(reference) = picture::read(folder, scene.references.first().map(|reference| &reference.image))? else {
        return Ok((vec![], Some("The images are not beside this report.".into())));
    };
    let image = store.radiance(&reference);
    let mut pictures = vec![Picture { label: "reference".into(), graph: None, image, flip: None, mean: None, mean_flip: None }];
    let mut full = false;
    for cell in &scene.cells {
        let read = |name: &Option<String>| picture::read(folder, name.as_ref());
        let Some(film) = read(&cell.image)? else { continue };
        let mut both = |film: &Film| -> Result<_, PageError> { Ok((store.radiance(film), store.flip(film, &reference)?)) };
        let (image, flip) = both(&film)?;
        let (mean, mean_flip) = match read(&cell.mean_image)? {
            Some(film) => both(&film).map(|(mean, flip)| (Some(mean), flip))?,
            None => (None, None),
        };
        let label = label(report, scene, cell.graph, cell.budget_ms);
        pictures.push(Picture { label, graph: Some(cell.graph), image, flip, mean, mean_flip });
        if !store.has_room(2 * film.pixels()) {
            full = true;
            break;
        }
    }
    let limit = || {
        format!("This page carries no more than {} MB of images; the others are in the EXR files beside it.", picture::MOST_EMBEDDED >> 20)
    };
    Ok((pictures, full.then(limit)))
}

/// The graph's name, with the budget where there are several.
fn label(report: &Report, scene: &SceneResult, graph: usize, budget: Option<f64>) -> String {
    let name = report.graphs.get(graph).map_or("?", |graph| graph.name.as_str());
    match scene.cells.iter().filter(|cell| cell.graph == graph).count() {
        0 | 1 => name.to_owned(),
        _ => format!("{name}, {}", budget.map_or("own time".into(), |ms| format!("{} ms", number(ms)))),
    }
}

fn metric_heads(scene: &SceneResult) -> Vec<MetricHead> {
    let there = |metric: &Metric| scene.cells.iter().any(|cell| cell.metrics.contains_key(metric.key()));
    Metric::all().filter(there).map(|metric| MetricHead { key: metric.key(), name: metric.name() }).collect()
}

fn bias_rows(scene: &SceneResult) -> Vec<BiasRow> {
    let row = |(graph, figures): (usize, &BiasFigures)| {
        let (kind, mark) = verdict::bias_kind(figures.verdict);
        let share = figures.bias_squared.max(0.0) / (figures.bias_squared.max(0.0) + figures.variance);
        BiasRow {
            graph,
            kind,
            mark,
            mean: verdict::mean(figures.mean_difference, figures.mean_error),
            share: format!("{} %", number(100.0 * share)),
            figures: figures.clone(),
        }
    };
    scene.cells.iter().filter_map(|cell| Some((cell.graph, cell.bias.as_ref()?))).map(row).collect()
}

/// Every N for which some graph says what the mean of N frames is worth.
fn gains(scene: &SceneResult) -> Vec<u32> {
    let all = scene.cells.iter().filter_map(|cell| cell.correlation.as_ref()).flat_map(|c| &c.accumulation_gain);
    let mut gains: Vec<u32> = all.map(|(n, _)| *n).collect();
    gains.sort_unstable();
    gains.dedup();
    gains
}

fn correlation_rows(scene: &SceneResult, gains: &[u32]) -> Vec<CorrelationRow> {
    let row = |(graph, c): (usize, &Correlation)| CorrelationRow {
        graph,
        temporal: c.temporal.first().copied(),
        spatial: c.spatial.first().copied(),
        flicker: c.flicker,
        worth: gains.iter().map(|n| c.accumulation_gain.iter().find(|(m, _)| m == n).map(|(n, gain)| f64::from(*n) * gain)).collect(),
    };
    scene.cells.iter().filter_map(|cell| Some((cell.graph, cell.correlation.as_ref()?))).map(row).collect()
}

/// Image files of a scene beside the report.
fn files(scene: &SceneResult) -> Vec<String> {
    let references = scene.references.iter().map(|reference| &reference.image).filter(|name| !name.is_empty());
    let cells = scene.cells.iter().flat_map(|cell| [cell.image.as_ref(), cell.mean_image.as_ref()]).flatten();
    let maps = scene.cells.iter().filter_map(|cell| cell.bias.as_ref()?.t_map.as_ref());
    references.chain(cells).chain(maps).cloned().collect()
}
