//! One scene, measured: what every graph runs is settled once, then rounds of all graphs in turn, a seed each.

use super::{
    budget::{self, Offer},
    error::CompareError,
    observer::Observer,
    report::Protocol,
    store::{Round, Run, Settled, SettledCell, Store, Take},
    subject::{Schedule, Shot, Stage, Subject},
    summary::median,
};
use crate::{film::Film, stats::rng::SplitMix};
use aquifer_graph::Document;
use std::{collections::HashMap, time::Instant};

/// A graph that takes part.
#[derive(Clone, Debug)]
pub struct Entrant {
    /// Short and unique.
    pub name: String,
    /// With everything that is laid over it.
    pub document: Document,
    /// What is laid over it.
    pub settings: Vec<String>,
}

/// Frames of one visit whose median is a graph's frame time when budgets are settled.
const SETTLING_FRAMES: u32 = 3;
/// Visits to each graph meanwhile, in turn, so that a busy moment of the machine does not decide.
const SETTLING_VISITS: u32 = 5;
/// Turns in which a value of a knob is held against the budget's owner.
const SETTLING_TURNS: u32 = 3;
/// Frames of warm-up that settling gives to graphs with history: from the second on they have a history to read.
const SETTLING_WARM_UP: u32 = 4;

/// Graphs on one scene.
pub struct Bench<'a> {
    stage: &'a Stage,
    entrants: &'a [Entrant],
    protocol: Protocol,
    budget_ms: Option<f64>,
    seed: u64,
    store: &'a Store,
    /// By graph and bits of the knob's value.
    subjects: HashMap<(usize, Option<u64>), Subject>,
}

impl<'a> Bench<'a> {
    /// Compiles every graph as written.
    ///
    /// # Errors
    /// What a graph or the device refuses.
    pub fn new(
        stage: &'a Stage,
        entrants: &'a [Entrant],
        protocol: Protocol,
        budget_ms: Option<f64>,
        seed: u64,
        store: &'a Store,
    ) -> Result<Self, CompareError> {
        let mut bench = Self { stage, entrants, protocol, budget_ms, seed, store, subjects: HashMap::new() };
        for graph in 0..entrants.len() {
            bench.subject(graph, None)?;
        }
        Ok(bench)
    }

    fn subject(&mut self, graph: usize, knob: Option<f64>) -> Result<&mut Subject, CompareError> {
        let key = (graph, knob.map(f64::to_bits));
        if !self.subjects.contains_key(&key) {
            let subject = self.stage.subject(&self.entrants[graph].document, knob, self.protocol.warm_up())?;
            self.subjects.insert(key, subject);
        }
        Ok(self.subjects.get_mut(&key).expect("it was just put there"))
    }

    /// A graph as written.
    pub fn as_written(&self, graph: usize) -> &Subject {
        &self.subjects[&(graph, None)]
    }

    /// What is measured: as settled before, or settled now.
    ///
    /// # Errors
    /// What a graph, the device or the disk refuses.
    pub fn settle(&mut self, observer: &mut dyn Observer) -> Result<Settled, CompareError> {
        if let Some(settled) = self.store.settled().filter(|settled| settled.fits(self.entrants.len())) {
            return Ok(settled);
        }
        observer.progress("timing each graph", 0, 0);
        let mut visits = Vec::new();
        for _ in 0..SETTLING_VISITS {
            let times = (0..self.entrants.len()).map(|graph| Ok(median(&self.frame_times(graph, None)?)));
            visits.push(times.collect::<Result<Vec<f64>, CompareError>>()?);
        }
        let frame_ms = frame_times(&visits);
        let cells = self.cells(&frame_ms)?;
        let settled = Settled { frame_ms, cells };
        self.store.settle(&settled)?;
        Ok(settled)
    }

    fn frame_times(&mut self, graph: usize, knob: Option<f64>) -> Result<Vec<f64>, CompareError> {
        let warm_up = self.protocol.warm_up().min(SETTLING_WARM_UP);
        let subject = self.subject(graph, knob)?;
        let schedule = Schedule { warm_up: if subject.independent() { 0 } else { warm_up }, frames: SETTLING_FRAMES };
        let mut times = Vec::new();
        subject.run(u64::MAX, schedule, |_, subject, shot| {
            times.extend(subject.time_of(&shot));
            Ok(())
        })?;
        Ok(times)
    }

    fn cells(&mut self, frame_ms: &[f64]) -> Result<Vec<SettledCell>, CompareError> {
        let as_written = |graph| SettledCell { graph, budget: None, offers: vec![Offer { knob: None, frames: 1 }] };
        if let Protocol::Accumulate { frames, .. } = self.protocol {
            let most = f64::from(frames) * frame_ms.iter().copied().fold(0.0, f64::max);
            let offer = |graph: usize| Offer { knob: None, frames: (most / frame_ms[graph]).round().max(1.0) as u32 };
            return Ok((0..frame_ms.len()).map(|graph| SettledCell { offers: vec![offer(graph)], ..as_written(graph) }).collect());
        }
        let fixed: Vec<bool> = (0..frame_ms.len()).map(|graph| !self.is_flexible(graph)).collect();
        let budgets = budgets(frame_ms, &fixed, self.budget_ms);
        let mut cells = Vec::new();
        for (graph, &fixed) in fixed.iter().enumerate() {
            if fixed {
                cells.push(as_written(graph));
                continue;
            }
            for &(budget, of) in &budgets {
                cells.push(match of {
                    Some(of) if of == graph => as_written(graph),
                    _ => SettledCell { graph, budget: Some((budget, of)), offers: self.offers(graph, budget, of)? },
                });
            }
        }
        Ok(cells)
    }

    /// More time can be spent on it.
    fn is_flexible(&self, graph: usize) -> bool {
        let subject = self.as_written(graph);
        subject.independent() || subject.knob_range().is_some()
    }

    fn offers(&mut self, graph: usize, budget: f64, of: Option<usize>) -> Result<Vec<Offer>, CompareError> {
        let subject = self.as_written(graph);
        let (knob, independent) = (subject.knob_range(), subject.independent());
        let mut known: HashMap<Option<u64>, f64> = HashMap::new();
        budget::around(budget, knob, independent, |knob| {
            let key = knob.map(f64::to_bits);
            if let Some(&ms) = known.get(&key) {
                return Ok(ms);
            }
            let ms = self.beside(graph, knob, budget, of)?;
            known.insert(key, ms);
            Ok(ms)
        })
    }

    /// Frame time of a graph whose budget is the time of `of`: both take turns, and the median of their ratios tells, whatever the machine does
    /// beside. A budget in plain milliseconds has nobody to be held against.
    fn beside(&mut self, graph: usize, knob: Option<f64>, budget: f64, of: Option<usize>) -> Result<f64, CompareError> {
        let mut relative = Vec::new();
        for _ in 0..SETTLING_TURNS {
            let owner = of.map(|of| self.frame_times(of, None)).transpose()?;
            let own = median(&self.frame_times(graph, knob)?);
            relative.push(own / owner.map_or(budget, |times| median(&times)));
        }
        Ok(budget * median(&relative))
    }

    /// Measures every cell with one seed, and keeps what came out.
    ///
    /// # Errors
    /// What the device or the disk refuses; [`CompareError::Interrupted`].
    pub fn round(&mut self, number: u32, settled: &Settled, observer: &mut dyn Observer) -> Result<Round, CompareError> {
        // A comparison that goes on has not compiled what was settled before.
        for cell in &settled.cells {
            for offer in &cell.offers {
                self.subject(cell.graph, offer.knob)?;
            }
        }
        let began = Instant::now();
        let mut round = Round::default();
        for (index, cell) in settled.cells.iter().enumerate() {
            let mut runs = Vec::new();
            for (variant, offer) in cell.offers.iter().enumerate() {
                if observer.stop() {
                    return Err(CompareError::Interrupted);
                }
                let name = format!("{number:04}-{index}-{variant}");
                let mut random = SplitMix::new(self.seed ^ blake3_word(&format!("{index} {variant} {number}")));
                let (run, seconds) = self.run(cell.graph, *offer, &mut random, &name)?;
                round.seconds += seconds;
                runs.push(run);
            }
            round.runs.push(runs);
        }
        round.lab_seconds = began.elapsed().as_secs_f64() - round.seconds;
        self.store.keep_round(number, &round)?;
        Ok(round)
    }

    /// One run of one graph: what is kept of it, and the seconds of rendering.
    fn run(&mut self, graph: usize, offer: Offer, random: &mut SplitMix, name: &str) -> Result<(Run, f64), CompareError> {
        let (store, protocol, time, step) = (self.store, self.protocol, self.stage.time, self.stage.step);
        let subject = self.subject(graph, offer.knob)?;
        let independent = subject.independent();
        let mut takes = Takes { store, name, mean: Mean::default(), ms: 0.0, passes: Vec::new(), takes: Vec::new() };
        let warm_up = if independent { 0 } else { protocol.warm_up() };
        let schedule = Schedule { warm_up, frames: offer.frames };
        let seconds = match protocol {
            Protocol::Frame { .. } => {
                let seconds = subject.run(random.bits(), schedule, |_, subject, shot| takes.add(subject, &shot))?;
                takes.keep(offer.frames)?;
                seconds
            }
            Protocol::Accumulate { .. } => subject.run(random.bits(), schedule, |frame, subject, shot| {
                takes.add(subject, &shot)?;
                let done = frame + 1;
                if done.is_power_of_two() || done == offer.frames { takes.keep(done) } else { Ok(()) }
            })?,
            Protocol::Trace { frames, .. } if independent => {
                let mut seconds = 0.0;
                for frame in 0..frames {
                    subject.set_time((f64::from(time) + f64::from(step) * f64::from(frame)) as f32);
                    seconds += subject.run(random.bits(), schedule, |_, subject, shot| takes.add(subject, &shot))?;
                    takes.keep(frame)?;
                    takes.begin();
                }
                seconds
            }
            Protocol::Trace { frames, .. } => subject.run(random.bits(), Schedule { warm_up: 0, frames }, |frame, subject, shot| {
                takes.add(subject, &shot)?;
                takes.keep(frame)?;
                takes.begin();
                Ok(())
            })?,
        };
        let passes = takes.passes.iter().map(|times| (!times.is_empty()).then(|| median(times))).collect();
        Ok((Run { takes: takes.takes, passes }, seconds))
    }
}

/// The frame time of each graph, from visits to all of them: its share of each visit tells, for a visit that was slow for all was slow for all alike.
fn frame_times(visits: &[Vec<f64>]) -> Vec<f64> {
    let whole = |visit: &Vec<f64>| visit.iter().sum::<f64>();
    let usual = median(&visits.iter().map(whole).collect::<Vec<_>>());
    let share = |graph: usize| median(&visits.iter().map(|visit| visit[graph] / whole(visit)).collect::<Vec<_>>());
    (0..visits.first().map_or(0, Vec::len)).map(|graph| usual * share(graph)).collect()
}

/// Budgets in milliseconds, with the graph that each is the frame time of: one for every graph whose time cannot be changed; without such,
/// what was asked for, or the time of the slowest.
fn budgets(frame_ms: &[f64], fixed: &[bool], asked: Option<f64>) -> Vec<(f64, Option<usize>)> {
    if let Some(asked) = asked {
        return vec![(asked, None)];
    }
    let own: Vec<_> = (0..frame_ms.len()).filter(|&graph| fixed[graph]).map(|graph| (frame_ms[graph], Some(graph))).collect();
    let slowest = || (0..frame_ms.len()).max_by(|&a, &b| frame_ms[a].total_cmp(&frame_ms[b])).map(|graph| (frame_ms[graph], Some(graph)));
    if own.is_empty() { slowest().into_iter().collect() } else { own }
}

fn blake3_word(text: &str) -> u64 {
    let [a, b, c, d, e, f, g, h, ..] = *blake3::hash(text.as_bytes()).as_bytes();
    u64::from_le_bytes([a, b, c, d, e, f, g, h])
}

/// What a run has shown so far.
struct Takes<'a> {
    store: &'a Store,
    name: &'a str,
    mean: Mean,
    ms: f64,
    passes: Vec<Vec<f64>>,
    takes: Vec<Take>,
}

impl Takes<'_> {
    fn add(&mut self, subject: &Subject, shot: &Shot) -> Result<(), CompareError> {
        self.passes.resize(shot.passes.len(), Vec::new());
        for (times, ms) in self.passes.iter_mut().zip(&shot.passes) {
            times.extend(ms);
        }
        // A clock that ran backwards has no word on this frame; the wall's stands in.
        self.ms += subject.time_of(shot).unwrap_or(shot.wall_ms);
        self.mean.add(&shot.film);
        Ok(())
    }

    fn keep(&mut self, frame: u32) -> Result<(), CompareError> {
        let (film, hash) = self.store.keep_film(format!("{}-{frame}.exr", self.name), &self.mean.film())?;
        self.takes.push(Take { frame, ms: self.ms, film, hash });
        Ok(())
    }

    fn begin(&mut self) {
        self.mean = Mean::default();
        self.ms = 0.0;
    }
}

/// The mean of films, summed in double precision.
#[derive(Default)]
struct Mean {
    size: [u32; 2],
    sum: Vec<[f64; 3]>,
    count: u32,
}

impl Mean {
    fn add(&mut self, film: &Film) {
        self.size = film.size;
        self.sum.resize(film.pixels(), [0.0; 3]);
        for (sum, color) in self.sum.iter_mut().flatten().zip(film.color.iter().flatten()) {
            *sum += f64::from(*color);
        }
        self.count += 1;
    }

    fn film(&self) -> Film {
        let mean = |sum: f64| (sum / f64::from(self.count.max(1))) as f32;
        Film { size: self.size, color: self.sum.iter().map(|sum| sum.map(mean)).collect(), ..Film::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_moments_change_no_ratio() {
        let found = frame_times(&[vec![1.0, 3.0], vec![4.0, 12.0], vec![1.1, 3.3], vec![0.5, 30.0], vec![2.0, 6.0]]);
        assert!((found[1] / found[0] - 3.0).abs() < 1e-9 && (found[0] - 2.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn graphs_that_cannot_change_set_the_budgets() {
        assert_eq!(budgets(&[1.0, 5.0, 7.0], &[false, true, true], None), [(5.0, Some(1)), (7.0, Some(2))]);
        assert_eq!(budgets(&[1.0, 5.0], &[false, false], None), [(5.0, Some(1))]);
        assert_eq!(budgets(&[1.0, 5.0], &[false, true], Some(3.0)), [(3.0, None)]);
    }
}
