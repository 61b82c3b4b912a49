//! Runs graphs on a case.

use super::{
    Case, Looks, Outcome, Pictures, Row, Turned,
    row::{Pixel, Share},
};
use crate::{
    capture::Capture,
    compare::error::CompareError,
    film::{Film, luminance},
    stage,
    stats::{Difference, Estimate, Moments, ensemble::Ensemble},
};
use aquifer_graph::{Document, Graph, NeedsAll, Source};
use aquifer_render::{Context, Error, Registry, Renderer, RendererOptions, SceneGlobals, View};
use aquifer_scene::Scene;
use std::{collections::BTreeMap, path::PathBuf, sync::Arc};

/// Seed of the truth: no graph is run with it.
const TRUTH_SEED: u64 = 1 << 40;
/// Paths that the truth takes a pixel and frame: fewer dispatches.
const TRUTH_PATHS: u32 = 16;

/// How much is spent.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Seeds of a row at least, and at most: more are added while it is not resolved.
    pub seeds: [u64; 2],
    /// Samples a pixel of the truth.
    pub truth: u32,
}

impl Default for Effort {
    fn default() -> Self {
        Effort { seeds: [4, 128], truth: 512 }
    }
}

/// A case that is being run.
pub struct Bench<'a> {
    context: &'a Context,
    case: &'static Case,
    effort: Effort,
    /// The path tracer.
    baseline: &'a Document,
    own: Result<Place, String>,
    /// Where it is not the case's own.
    truth: Option<Place>,
    /// By transport and frame.
    truths: BTreeMap<(String, u32), Film>,
}

/// A scene with the shaders cut to it.
struct Place {
    scene: Arc<Scene>,
    registry: Registry,
}

impl Place {
    fn new(scene: Scene, shaders: &[PathBuf]) -> Result<Self, String> {
        let scene = Arc::new(scene.finish().map_err(|error| error.to_string())?);
        let registry = stage::registry(Some(&scene), shaders).map_err(|error| error.to_string())?;
        Ok(Place { scene, registry })
    }
}

impl<'a> Bench<'a> {
    /// Makes the scene; `baseline` is the path tracer's graph, and the folders hold shaders over the built-in ones.
    pub fn new(context: &'a Context, case: &'static Case, baseline: &'a Document, effort: Effort, shaders: &[PathBuf]) -> Self {
        let own = Place::new((case.scene)(), shaders);
        // What must look like another scene is held against that scene as it is known to be right: without shaders of others.
        let truth = case.truth.and_then(|scene| Place::new(scene(), &[]).ok());
        Bench { context, case, effort, baseline, own, truth, truths: BTreeMap::new() }
    }

    /// Runs a graph.
    ///
    /// # Errors
    /// What graphs and devices refuse, save for what the case is made to provoke.
    pub fn run(&mut self, name: &str, document: &Document) -> Result<(Row, Option<Pictures>), CompareError> {
        let mut row = self.row(name);
        let place = match &self.own {
            Ok(place) => place,
            Err(words) => return Ok((refused(row, self.case, words), None)),
        };
        let graph = self.graph(document, &place.registry)?;
        row.labelled = !graph.bias().is_empty();
        let mut shooter = match Shooter::new(self.context, place, self.case, graph) {
            Ok(shooter) => shooter,
            Err(CompareError::Render(error @ Error::LimitTooSmall { .. })) => {
                (row.outcome, row.why) = (Outcome::Limited, error.to_string());
                return Ok((row, None));
            }
            Err(error) => return Err(error),
        };
        let transport = shooter.graph.transport().to_string();
        let truths = if self.case.looks == Looks::Once { Vec::new() } else { self.truths(&transport)? };
        let mut seen = Seen::new(self.case.looks);
        let [least, most] = if self.case.looks == Looks::Once { [1, 1] } else { self.effort.seeds };
        let most = most * self.case.scarcity();
        for seed in 0..most {
            seen.add(&shooter.shoot(seed, self.case.looks.frames())?)?;
            seen.tell(&mut row, &truths);
            row.judge(&[]);
            if row.seeds >= least && row.outcome != Outcome::NotResolved {
                break;
            }
        }
        row.judge(&shooter.renderer.counts()?);
        let pictures = truths.last().map(|want| Pictures { got: seen.picture.film(), want: want.clone() });
        Ok((row, pictures))
    }

    fn row(&self, graph: &str) -> Row {
        Row {
            case: self.case.name.to_owned(),
            graph: graph.to_owned(),
            outcome: Outcome::NotResolved,
            known: self.case.known(graph).map(str::to_owned),
            why: String::new(),
            labelled: false,
            seeds: 0,
            truth_error: 0.0,
            bias: None,
            drift: None,
            worst_pixel: None,
            nan: 0,
            infinite: 0,
            recovers_after: None,
        }
    }

    /// The graph with the case's parameters turned.
    fn graph(&self, document: &Document, registry: &Registry) -> Result<Graph, CompareError> {
        let graph = Graph::check(document, registry)?;
        let edits = turned(&graph, self.case);
        if edits.is_empty() {
            return Ok(graph);
        }
        let mut changed = document.clone();
        changed.apply(edits)?;
        Ok(Graph::check(&changed, registry)?)
    }

    /// What each look should show.
    fn truths(&mut self, transport: &str) -> Result<Vec<Film>, CompareError> {
        let frames = self.case.looks.frames();
        frames.iter().map(|&frame| self.truth_at(transport, if self.case.looks == Looks::Still { 0 } else { frame })).collect()
    }

    fn truth_at(&mut self, transport: &str, frame: u32) -> Result<Film, CompareError> {
        let key = (transport.to_owned(), frame);
        if let Some(film) = self.truths.get(&key) {
            return Ok(film.clone());
        }
        let Some(place) = self.truth.as_ref().or(self.own.as_ref().ok()) else { return Ok(Film::default()) };
        let mut document = self.baseline.clone();
        document.apply(
            [format!("transport={transport}"), format!("path_tracer.samples={TRUTH_PATHS}")].map(|text| Source::new("truth", text)),
        )?;
        let graph = Graph::check(&document, &place.registry)?;
        let capture = Capture::of(&graph);
        let plan = graph.plan(&NeedsAll, &capture.keep())?;
        let view = View { time: self.case.looks.step() * frame as f32, centred: true, ..View::default() };
        let globals = SceneGlobals::new(self.context, place.scene.clone(), view)?;
        let options = RendererOptions { size: self.case.size, seed: TRUTH_SEED, ..RendererOptions::default() };
        let mut renderer = Renderer::new(self.context, &place.registry, plan, Box::new(globals), options)?;
        for _ in 0..(self.effort.truth * self.case.scarcity() as u32).div_ceil(TRUTH_PATHS).max(2) {
            renderer.frame()?;
        }
        let film = capture.radiance(&mut renderer)?;
        self.truths.insert(key, film.clone());
        Ok(film)
    }
}

/// The scene was not taken.
fn refused(mut row: Row, case: &Case, words: &str) -> Row {
    let meant = matches!(case.looks, Looks::Refused(expected) if words.contains(expected));
    (row.outcome, row.why) = (if meant { Outcome::Refused } else { Outcome::Failed }, words.to_owned());
    row
}

/// Settings that turn the case's parameters, in every pass that has them.
fn turned(graph: &Graph, case: &Case) -> Vec<Source> {
    let mut edits = Vec::new();
    for node in graph.nodes() {
        for (name, turned) in case.turned {
            let Some(param) = node.contract.params.iter().find(|param| param.name == *name) else { continue };
            let (least, most) = param.range.unwrap_or((0.0, 0.0));
            let value = match turned {
                Turned::Least => least,
                Turned::Most => most,
                Turned::To(value) => value.clamp(least, most),
            };
            // Numbers of floats have a point.
            let text = if matches!(param.default, aquifer_graph::Value::F32(_)) { format!("{value:?}") } else { format!("{value}") };
            edits.push(Source::new("case", format!("{}.{name}={text}", node.pass)));
        }
    }
    edits
}

/// A graph that counts NaNs while it renders.
struct Shooter {
    graph: Graph,
    capture: Capture,
    renderer: Renderer,
}

impl Shooter {
    fn new(context: &Context, place: &Place, case: &Case, graph: Graph) -> Result<Self, CompareError> {
        let capture = Capture::of(&graph);
        let frame = graph.port_name(capture.frame_port(&graph));
        let plan = graph.plan(&NeedsAll, &[&frame])?;
        let globals = SceneGlobals::new(context, place.scene.clone(), View { step: case.looks.step(), centred: true, ..View::default() })?;
        let options = RendererOptions { size: case.size, counters: true, ..RendererOptions::default() };
        let renderer = Renderer::new(context, &place.registry, plan, Box::new(globals), options)?;
        Ok(Shooter { graph, capture, renderer })
    }

    /// Those frames of one run, each by itself.
    fn shoot(&mut self, seed: u64, frames: &[u32]) -> Result<Vec<Film>, CompareError> {
        self.renderer.reseed(seed)?;
        let mut films = Vec::new();
        for frame in 0..=frames.last().copied().unwrap_or(0) {
            self.renderer.frame()?;
            if frames.contains(&frame) {
                films.push(self.capture.last_frame(&self.graph, &mut self.renderer)?);
            }
        }
        Ok(films)
    }
}

/// What the looks have shown so far.
struct Seen {
    looks: Looks,
    /// Of the frames that are judged.
    picture: Ensemble,
    /// Mean luminance of those frames together, one value a seed.
    judged: Moments,
    /// Mean luminance of each look.
    means: Vec<Moments>,
    /// Of the frames that are judged less of those before, seed by seed.
    drift: Moments,
}

impl Seen {
    fn new(looks: Looks) -> Self {
        let means = vec![Moments::default(); looks.frames().len()];
        Seen { looks, picture: Ensemble::default(), judged: Moments::default(), means, drift: Moments::default() }
    }

    /// Adds the looks of one seed.
    fn add(&mut self, films: &[Film]) -> Result<(), CompareError> {
        let means: Vec<f64> = films.iter().map(mean_luminance).collect();
        self.means.iter_mut().zip(&means).for_each(|(moments, mean)| moments.push(*mean));
        let early = films.len() - self.looks.judged();
        films[early..].iter().try_for_each(|film| self.picture.push(film))?;
        let [before, judged] = [&means[..early], &means[early..]].map(|means| means.iter().copied().collect::<Moments>().mean());
        self.judged.push(judged);
        self.drift.push(judged - before);
        Ok(())
    }

    fn tell(&self, row: &mut Row, truths: &[Film]) {
        row.seeds = self.judged.count();
        let Some(truth) = truths.last() else { return };
        row.bias = Some(bias(&self.judged, truth).into());
        row.truth_error = Difference::normal(0.0, error_of_mean(truth)).relative_to(mean_luminance(truth)).standard_error;
        if self.looks == Looks::Still {
            let found = Estimate::from(&self.drift);
            let drift = Difference { value: found.mean, standard_error: found.standard_error, freedom: found.freedom };
            row.drift = Some(drift.relative_to(mean_luminance(truth)).into());
        }
        if let Looks::After(frames) = self.looks {
            let is_wrong = |(means, truth)| Share::from(bias(means, truth)).is_outside(row.labelled);
            let wrong = self.means.iter().zip(truths).rposition(is_wrong);
            row.recovers_after = wrong.map_or(Some(0), |index| frames.get(index + 1).map(|frame| frame - frames[0]));
        }
        row.worst_pixel = worst(&self.picture.film(), truth);
    }
}

/// Of mean luminance, as a share of the truth's.
fn bias(means: &Moments, truth: &Film) -> Difference {
    let want = Estimate { mean: mean_luminance(truth), standard_error: error_of_mean(truth), freedom: f64::INFINITY };
    Difference::welch(Estimate::from(means), want).relative_to(want.mean)
}

fn mean_luminance(film: &Film) -> f64 {
    film.color.iter().map(|color| luminance(color.map(f64::from))).sum::<f64>() / film.pixels() as f64
}

/// Standard error of [`mean_luminance`], whose pixels are independent; channels are taken to vary together.
fn error_of_mean(film: &Film) -> f64 {
    let variances = film.variance.iter().flatten().map(|variance| luminance(variance.map(|v| f64::from(v).sqrt())).powi(2));
    variances.sum::<f64>().sqrt() / film.pixels() as f64
}

fn worst(got: &Film, want: &Film) -> Option<Pixel> {
    let scale = mean_luminance(want);
    let difference = |(got, want): (&[f32; 3], &[f32; 3])| luminance(got.map(f64::from)) - luminance(want.map(f64::from));
    let differences = got.color.iter().zip(&want.color).map(difference).enumerate();
    let (index, found) = differences.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let at = [index as u32 % got.size[0], index as u32 / got.size[0]];
    Some(Pixel { at, difference: if found == 0.0 { 0.0 } else { found / scale } })
}
