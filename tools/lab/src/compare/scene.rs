//! One scene from beginning to end: measured, held against references, weighed. Who is better is decided over all scenes of a report
//! ([`judge::decide`]).

use super::{
    bench::{Bench, Entrant},
    bias::{bias, t_values},
    correlation::{accumulation_gain, correlation},
    error::CompareError,
    evaluate::{Rounds, Truth, cell_name},
    explain::Question,
    further, judge,
    observer::Observer,
    reference::{Content, Reference, Tracer, shaders},
    report::{BiasFigures, Cell, Correlation, Explained, Protocol, ReferenceFacts, SceneResult},
    store::{Round, Store, make_folder},
    subject::Stage,
    summary::median,
};
use crate::{
    film::Film,
    stats::{ensemble::Ensemble, error::EPSILON},
};
use aquifer_graph::{Document, Transport};
use std::{
    path::PathBuf,
    time::{Duration, Instant},
};

/// What a comparison was asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// What is measured.
    pub protocol: Protocol,
    /// Milliseconds for every graph that can be given more or less; `None` takes the time of those that cannot.
    pub budget_ms: Option<f64>,
    /// Of all random numbers.
    pub seed: u64,
    /// How much of the smallest error may be the reference's own.
    pub reference_share: f64,
    /// The most samples of a reference.
    pub reference_samples: u64,
    /// The path tracer, for references.
    pub path_tracer: Document,
    /// Where references are kept.
    pub cache: PathBuf,
    /// Where everything else goes.
    pub folder: PathBuf,
    /// Ask of every biased graph which of its switches does how much.
    pub explain_bias: bool,
    /// The mean square error to be reached, where budgets grow; `None`: what all graphs reach.
    pub equal_error: Option<f64>,
    /// Of the program.
    pub version: String,
}

/// Frames that temporal correlation looks back.
const LAGS: usize = 8;
/// Folder of images beside the report.
const IMAGES: &str = "images";

/// The scene's names.
#[derive(Clone, Debug, Default)]
pub struct SceneFacts {
    /// Short and unique.
    pub name: String,
    /// As films name it.
    pub identity: String,
    /// A text that changes whenever the scene's content does.
    pub content: String,
    /// The environment over the scene's own.
    pub environment: Option<String>,
    /// The camera.
    pub camera: String,
}

/// A scene's figures with what they cost.
pub struct Compared {
    /// The figures.
    pub result: SceneResult,
    /// What readers must know.
    pub warnings: Vec<String>,
    /// Seconds of rendering what was measured.
    pub seconds: f64,
    /// Seconds of everything else but references: films read back and kept, errors, statistics.
    pub lab_seconds: f64,
    /// Who held the watch.
    pub clock: aquifer_render::Clock,
}

/// Measures and weighs.
///
/// # Errors
/// Whatever a graph, the device or the disk refuses. What was measured until then is kept, and a second call goes on from there.
pub fn compare_scene(
    stage: &Stage,
    entrants: &[Entrant],
    facts: &SceneFacts,
    request: &Request,
    observer: &mut dyn Observer,
) -> Result<Compared, CompareError> {
    let store = Store::open(request.folder.join("measured").join(state_name(stage, entrants, facts, request)?))?;
    let mut bench = Bench::new(stage, entrants, request.protocol, request.budget_ms, request.seed, &store)?;
    let settled = bench.settle(observer)?;
    let rounds = measure(&mut bench, &settled, &store, request.protocol.seeds(), &facts.name, observer)?;
    let measured = Rounds { store: &store, settled: &settled, rounds: &rounds };
    let mut scene =
        Scene { stage, entrants, facts, request, bench: &bench, measured, warnings: Vec::new(), reference_time: Duration::ZERO };
    let began = Instant::now();
    let mut result = scene.evaluate(observer)?;
    let evaluation = began.elapsed().saturating_sub(scene.reference_time);
    let warnings = scene.warnings;
    let mut spent = spent(&rounds);
    spent.1 += evaluation.as_secs_f64();
    if request.explain_bias {
        let (explained, asked) = explain_bias(stage, entrants, facts, request, &result, observer)?;
        result.explained = explained;
        spent = (spent.0 + asked.0, spent.1 + asked.1);
    }
    Ok(Compared { result, warnings, seconds: spent.0, lab_seconds: spent.1, clock: bench.as_written(0).clock() })
}

/// Seconds of rendering and of everything else.
fn spent(rounds: &[Round]) -> (f64, f64) {
    rounds.iter().fold((0.0, 0.0), |(seconds, lab), round| (seconds + round.seconds, lab + round.lab_seconds))
}

/// Every biased graph's switches turned one by one, and what that cost.
fn explain_bias(
    stage: &Stage,
    entrants: &[Entrant],
    facts: &SceneFacts,
    request: &Request,
    result: &SceneResult,
    observer: &mut dyn Observer,
) -> Result<(Vec<Explained>, (f64, f64)), CompareError> {
    let (mut explained, mut cost) = (Vec::new(), (0.0, 0.0));
    for (graph, entrant) in entrants.iter().enumerate() {
        let Some(question) = Question::new(graph, entrant, &stage.graph(&entrant.document, None)?.bias())? else { continue };
        let name = state_name(stage, &question.entrants, facts, request)?;
        let store = Store::open(request.folder.join("measured").join(format!("{name}-explained")))?;
        let mut bench = Bench::new(stage, &question.entrants, request.protocol, None, request.seed, &store)?;
        let settled = question.settled();
        let what = format!("{}, bias of {}", facts.name, entrant.name);
        let rounds = measure(&mut bench, &settled, &store, request.protocol.seeds(), &what, observer)?;
        let began = Instant::now();
        let reference = result.cells.iter().find(|cell| cell.graph == graph).map(|cell| &result.references[cell.reference]);
        let Some(reference) = reference.filter(|reference| !reference.black) else { continue };
        let reference = Film::read(&request.folder.join(&reference.image))?;
        explained.push(question.answer(&Rounds { store: &store, settled: &settled, rounds: &rounds }, &reference)?);
        let (seconds, lab) = spent(&rounds);
        cost = (cost.0 + seconds, cost.1 + lab + began.elapsed().as_secs_f64());
    }
    Ok((explained, cost))
}

/// Names what is measured: another graph, scene, size, protocol, seed, adapter or shader is another folder.
fn state_name(stage: &Stage, entrants: &[Entrant], facts: &SceneFacts, request: &Request) -> Result<String, CompareError> {
    let mut text = format!(
        "{} {:?} {} {:?} {} {} {:?} {} {} {} {}",
        facts.content,
        facts.environment,
        facts.camera,
        stage.size,
        stage.time,
        stage.step,
        request.protocol.without_seeds(),
        stage.centred,
        request.seed,
        request.budget_ms.map_or(0.0, |ms| ms),
        stage.context.adapter().name,
    );
    for entrant in entrants {
        let graph = stage.graph(&entrant.document, None)?;
        let plan = graph.plan(&stage.registry, &[])?;
        text += &format!("\n{} {}", graph.digest(), shaders(&stage.registry, &plan));
    }
    Ok(format!("{}-{}", facts.name, &blake3::hash(text.as_bytes()).to_hex()[..12]))
}

fn measure(
    bench: &mut Bench<'_>,
    settled: &super::store::Settled,
    store: &Store,
    seeds: u32,
    scene: &str,
    observer: &mut dyn Observer,
) -> Result<Vec<Round>, CompareError> {
    let mut rounds = Vec::new();
    for number in 0..seeds {
        observer.progress(&format!("{scene}: rounds of all graphs"), number.into(), seeds.into());
        rounds.push(match store.round(number).filter(|round| round.fits(settled)) {
            Some(round) => round,
            None => bench.round(number, settled, observer)?,
        });
    }
    Ok(rounds)
}

struct Scene<'a> {
    stage: &'a Stage,
    entrants: &'a [Entrant],
    facts: &'a SceneFacts,
    request: &'a Request,
    bench: &'a Bench<'a>,
    measured: Rounds<'a>,
    warnings: Vec<String>,
    /// Spent on references, which later comparisons find made.
    reference_time: Duration,
}

impl Scene<'_> {
    fn evaluate(&mut self, observer: &mut dyn Observer) -> Result<SceneResult, CompareError> {
        make_folder(&self.images())?;
        let mut result = SceneResult {
            name: self.facts.name.clone(),
            identity: self.facts.identity.clone(),
            environment: self.facts.environment.clone(),
            camera: self.facts.camera.clone(),
            animation_time: self.stage.time,
            size: self.stage.size,
            ..SceneResult::default()
        };
        let mut cells: Vec<Option<Cell>> = vec![None; self.measured.settled.cells.len()];
        for transport in self.transports() {
            let members = self.members(transport);
            let reference = result.references.len();
            for (index, cell) in self.evaluate_transport(transport, &members, observer, &mut result.references)? {
                cells[index] = Some(Cell { reference, ..cell });
            }
        }
        result.cells = cells.into_iter().flatten().collect();
        self.write_images(&mut result.cells, &result.references)?;
        let names: Vec<String> = self.entrants.iter().map(|entrant| entrant.name.clone()).collect();
        judge::weigh(&mut result, &names, self.request.protocol, self.request.equal_error);
        self.warn_of(&result);
        Ok(result)
    }

    fn transports(&self) -> Vec<Transport> {
        let mut transports = Vec::new();
        for graph in 0..self.entrants.len() {
            let transport = self.bench.as_written(graph).graph().transport();
            if !transports.contains(&transport) {
                transports.push(transport);
            }
        }
        transports
    }

    /// Cells whose graphs hold these light paths.
    fn members(&self, transport: Transport) -> Vec<usize> {
        let cells = self.measured.settled.cells.iter().enumerate();
        cells.filter(|(_, cell)| self.bench.as_written(cell.graph).graph().transport() == transport).map(|(index, _)| index).collect()
    }

    /// Figures of all cells of one transport, and the reference they were measured against.
    fn evaluate_transport(
        &mut self,
        transport: Transport,
        members: &[usize],
        observer: &mut dyn Observer,
        references: &mut Vec<ReferenceFacts>,
    ) -> Result<Vec<(usize, Cell)>, CompareError> {
        let traced = matches!(self.request.protocol, Protocol::Trace { .. });
        let takes = members.iter().map(|&cell| self.measured.takes(cell)).min().unwrap_or(0);
        let mut curves = vec![Vec::new(); members.len()];
        // The takes of a trace are of different times, each with a reference of its own; all others share one.
        if traced {
            for take in 0..takes.saturating_sub(1) {
                let at: Vec<(usize, usize)> = members.iter().map(|&cell| (cell, take)).collect();
                let time = self.time_of(take);
                let (film, facts) = self.reference(transport, time, &at, observer)?;
                let truth = Truth { film: &film, black: facts.black };
                for (&(cell, take), curve) in at.iter().zip(&mut curves) {
                    curve.push(self.measured.point(cell, take, self.figures(cell, take, &truth)?, time));
                }
            }
        }
        let at: Vec<(usize, usize)> = members.iter().map(|&cell| (cell, self.measured.takes(cell) - 1)).collect();
        let time = if traced { self.time_of(takes.saturating_sub(1)) } else { self.stage.time };
        let (film, facts) = self.reference(transport, time, &at, observer)?;
        let truth = Truth { film: &film, black: facts.black };
        let mut cells = Vec::new();
        for (&(index, take), mut curve) in at.iter().zip(curves) {
            let earlier = if traced { take..take } else { 0..take };
            for take in earlier {
                curve.push(self.measured.point(index, take, self.figures(index, take, &truth)?, time));
            }
            let cell = self.figures(index, take, &truth)?;
            let metrics = further::metrics(&self.measured.films(index, &cell, take)?, &film)?;
            if self.measured.takes(index) > 1 {
                curve.push(self.measured.point(index, take, cell.clone(), time));
            }
            cells.push((index, Cell { curve, metrics, ..cell }));
        }
        let name = format!("reference_{}.exr", file_name(&facts.transport));
        film.write(&self.images().join(&name))?;
        references.push(ReferenceFacts { image: self.image_name(&name), ..facts });
        Ok(cells)
    }

    /// The folder of this scene's images.
    fn images(&self) -> PathBuf {
        self.request.folder.join(IMAGES).join(&self.facts.name)
    }

    /// As the report names an image.
    fn image_name(&self, name: &str) -> String {
        format!("{IMAGES}/{}/{name}", self.facts.name)
    }

    /// The first seed's film of every cell, the mean over seeds, and what all seeds say of bias and correlation.
    fn write_images(&self, cells: &mut [Cell], references: &[ReferenceFacts]) -> Result<(), CompareError> {
        for (index, cell) in cells.iter_mut().enumerate() {
            let films = self.measured.films(index, cell, self.measured.takes(index) - 1)?;
            let name = file_name(&cell_name(cell, self.entrants));
            let mut mean = Ensemble::default();
            for film in &films {
                mean.push(film)?;
            }
            let (one, all) = (format!("{name}.exr"), format!("{name}.mean.exr"));
            films[0].write(&self.images().join(&one))?;
            mean.film().write(&self.images().join(&all))?;
            (cell.image, cell.mean_image) = (Some(self.image_name(&one)), Some(self.image_name(&all)));
            let facts = &references[cell.reference];
            // One seed has no variance, and nothing is relative to black.
            if films.len() < 2 || facts.black {
                continue;
            }
            let reference = Film::read(&self.request.folder.join(&facts.image))?;
            let t_map = format!("{name}.t.exr");
            t_values(&mean.film(), &reference).write(&self.images().join(&t_map))?;
            cell.bias = Some(BiasFigures { t_map: Some(self.image_name(&t_map)), ..bias(&films, &reference)? });
            cell.correlation = Some(self.correlation(index, cell, films)?);
        }
        Ok(())
    }

    /// From the last takes of a trace, from all of a growing budget, or from the one frame there is.
    fn correlation(&self, index: usize, cell: &Cell, last: Vec<Film>) -> Result<Correlation, CompareError> {
        let takes = self.measured.takes(index);
        let films = |take: usize| self.measured.films(index, cell, take);
        match self.request.protocol {
            Protocol::Frame { .. } => Ok(correlation(&[last])),
            Protocol::Trace { .. } => {
                let frames = (takes.saturating_sub(LAGS + 1)..takes).map(films).collect::<Result<Vec<_>, _>>()?;
                Ok(correlation(&frames))
            }
            Protocol::Accumulate { .. } => {
                let mean = |take: usize| Ok((cell.curve[take].frame, films(take)?));
                let means = (0..takes).map(mean).collect::<Result<Vec<_>, CompareError>>()?;
                Ok(Correlation { accumulation_gain: accumulation_gain(&means), ..correlation(&[last]) })
            }
        }
    }

    /// What a reader of the figures must know.
    fn warn_of(&mut self, result: &SceneResult) {
        let scene = &result.name;
        for reference in &result.references {
            if reference.black {
                self.warnings.push(format!("{scene}: the reference holds no light: relative metrics are undefined"));
            }
            let share = match reference.share {
                _ if reference.hides => "more than all".to_owned(),
                Some(share) if share > self.request.reference_share => format!("{:.0} %", 100.0 * share),
                _ => continue,
            };
            self.warnings.push(format!(
                "{scene}: the reference's own variance is {share} of the smallest error after {} samples: --reference-samples allows more",
                reference.samples
            ));
        }
        for pair in result.pairs.iter().filter(|pair| !pair.equal_time) {
            let name = |cell: usize| &self.entrants[result.cells[cell].graph].name;
            self.warnings.push(format!(
                "{scene}: `{}` takes {:.2} times as long as `{}`: times could not be made equal",
                name(pair.other),
                pair.time.value,
                name(pair.baseline)
            ));
        }
    }

    fn figures(&self, cell: usize, take: usize, truth: &Truth<'_>) -> Result<Cell, CompareError> {
        let graph = self.measured.settled.cells[cell].graph;
        self.measured.cell(cell, take, truth, &self.bench.as_written(graph).passes())
    }

    /// Seconds into the animation of a trace's frame.
    fn time_of(&self, take: usize) -> f32 {
        (f64::from(self.stage.time) + f64::from(self.stage.step) * take as f64) as f32
    }

    /// A reference good enough for these cells and takes, as far as the samples allowed make it so.
    fn reference(
        &mut self,
        transport: Transport,
        time: f32,
        at: &[(usize, usize)],
        observer: &mut dyn Observer,
    ) -> Result<(Film, ReferenceFacts), CompareError> {
        let request = self.request;
        let began = Instant::now();
        let mut tracer = Tracer::new(self.stage, &request.path_tracer, transport, time)?;
        self.reference_time += began.elapsed();
        let facts = self.facts;
        let environment = facts.environment.as_deref();
        let content = Content { scene: &facts.content, environment, camera: &facts.camera, version: &request.version };
        let mut reference = Reference::open(&request.cache, self.stage, &tracer, &content, observer);
        let mut wanted = reference.samples().max(1);
        loop {
            while reference.samples() < wanted.min(request.reference_samples).max(1) {
                if observer.stop() {
                    return Err(CompareError::Interrupted);
                }
                observer.progress(&format!("{}: reference ({transport})", facts.name), reference.samples(), wanted);
                let began = Instant::now();
                reference.extend(self.stage, &mut tracer, &content)?;
                self.reference_time += began.elapsed();
            }
            let film = reference.film().expect("at least one chunk was rendered").clone();
            let figures = self.facts_of(&reference, &film, at)?;
            let enough = !figures.hides && figures.share.is_none_or(|share| share <= request.reference_share);
            if enough || reference.samples() >= request.reference_samples {
                return Ok((film, figures));
            }
            // Variance falls as 1/samples; a tenth more makes up for what the estimate of the error may still lack.
            let more = figures.share.unwrap_or(f64::INFINITY) / request.reference_share * 1.1;
            wanted = (reference.samples() as f64 * more.min(64.0)).ceil() as u64;
        }
    }

    fn facts_of(&self, reference: &Reference, film: &Film, at: &[(usize, usize)]) -> Result<ReferenceFacts, CompareError> {
        let variance = film
            .variance
            .as_ref()
            .map_or(0.0, |variance| variance.iter().flatten().map(|v| f64::from(*v)).sum::<f64>() / (3.0 * film.pixels() as f64));
        let weighted = |(v, r): (&f32, &f32)| f64::from(*v) / (f64::from(*r).powi(2) + EPSILON);
        let rel_variance = film.variance.as_ref().map_or(0.0, |variance| {
            variance.iter().flatten().zip(film.color.iter().flatten()).map(weighted).sum::<f64>() / (3.0 * film.pixels() as f64)
        });
        let black = film.color.iter().flatten().all(|value| *value == 0.0);
        let mut least = f64::INFINITY;
        for &(cell, take) in at {
            let errors = self.measured.errors(cell, take, film)?;
            least = errors.iter().map(|seeds| median(&seeds.iter().map(|error| error.mse).collect::<Vec<_>>())).fold(least, f64::min);
        }
        let hides = variance > 0.0 && least <= 0.0;
        Ok(ReferenceFacts {
            transport: reference.transport().to_string(),
            image: String::new(),
            hash: reference.hash(),
            samples: reference.samples(),
            variance,
            rel_variance,
            share: (variance > 0.0 && !hides).then_some(variance / least),
            hides,
            black,
        })
    }
}

/// A name that any file system takes.
fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '.' | '-' | '_') { c } else { '_' }).collect()
}
