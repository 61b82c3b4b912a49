//! From films and times to errors.

use super::{
    bench::Entrant,
    budget::weights,
    error::CompareError,
    report::{Cell, PassShare, Point, Variant},
    store::{Round, Settled, SettledCell, Store},
    summary::{Summary, median},
};
use crate::{
    film::Film,
    stats::error::{mse, rel_mse},
};
use rayon::prelude::*;

/// All rounds of one scene.
pub struct Rounds<'a> {
    /// Where their films are.
    pub store: &'a Store,
    /// What each measured.
    pub settled: &'a Settled,
    /// In order of seeds.
    pub rounds: &'a [Round],
}

/// One film's error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmError {
    /// The reference's variance taken out.
    pub mse: f64,
    /// Likewise.
    pub rel_mse: f64,
}

/// A truth to measure against.
pub struct Truth<'a> {
    /// Mean and variance of the mean.
    pub film: &'a Film,
    /// No light: relative errors are undefined.
    pub black: bool,
}

impl Rounds<'_> {
    /// How many takes every run of a cell has.
    pub fn takes(&self, cell: usize) -> usize {
        self.rounds.first().map_or(0, |round| round.runs[cell].iter().map(|run| run.takes.len()).min().unwrap_or(0))
    }

    /// Errors of one take of a cell: by offer, by seed.
    ///
    /// # Errors
    /// When a film cannot be read.
    pub fn errors(&self, cell: usize, take: usize, reference: &Film) -> Result<Vec<Vec<FilmError>>, CompareError> {
        let error = |film: Film| -> Result<FilmError, CompareError> {
            Ok(FilmError { mse: mse(&film, reference)?.value(), rel_mse: rel_mse(&film, reference)?.value() })
        };
        let of_offer =
            |offer: usize| self.rounds.par_iter().map(|round| error(self.store.film(&round.runs[cell][offer].takes[take])?)).collect();
        (0..self.settled.cells[cell].offers.len()).map(of_offer).collect()
    }

    /// Milliseconds of one take of a cell: by offer, by seed.
    fn times(&self, cell: usize, take: usize) -> Vec<Vec<f64>> {
        let of_offer = |offer: usize| self.rounds.iter().map(|round| round.runs[cell][offer].takes[take].ms).collect();
        (0..self.settled.cells[cell].offers.len()).map(of_offer).collect()
    }

    /// The budget of a cell: what was asked for, or the median time that its graph was measured to take in these very rounds.
    fn budget(&self, cell: &SettledCell, take: usize) -> Option<f64> {
        let (asked, of) = cell.budget?;
        let owner = of.and_then(|of| self.settled.cells.iter().position(|other| other.graph == of && other.budget.is_none()));
        Some(owner.map_or(asked, |owner| median(&self.times(owner, take)[0])))
    }

    /// A cell with its figures at one take; images, bias and curve are left to others.
    ///
    /// # Errors
    /// When a film cannot be read.
    pub fn cell(&self, index: usize, take: usize, truth: &Truth<'_>, passes: &[(String, bool)]) -> Result<Cell, CompareError> {
        let settled = &self.settled.cells[index];
        let (times, errors) = (self.times(index, take), self.errors(index, take, truth.film)?);
        let medians: Vec<f64> = times.iter().map(|times| median(times)).collect();
        let budget = self.budget(settled, take);
        let weights = weights(&medians, budget.unwrap_or(medians[0]));
        let mixed = |value: &dyn Fn(usize, usize) -> f64| {
            let seed = |seed: usize| weights.iter().enumerate().map(|(offer, weight)| weight * value(offer, seed)).sum();
            Summary::of((0..self.rounds.len()).map(seed).collect())
        };
        let variant = |((offer, weight), ms): ((&super::budget::Offer, &f64), &f64)| Variant {
            knob: offer.knob,
            frames: offer.frames,
            time_ms: *ms,
            weight: *weight,
        };
        Ok(Cell {
            graph: settled.graph,
            budget_ms: budget,
            budget_of: settled.budget.and_then(|(_, of)| of),
            variants: settled.offers.iter().zip(&weights).zip(&medians).map(variant).collect(),
            time_ms: mixed(&|offer, seed| times[offer][seed]),
            mse: mixed(&|offer, seed| errors[offer][seed].mse),
            rel_mse: (!truth.black).then(|| mixed(&|offer, seed| errors[offer][seed].rel_mse)),
            passes: self.passes(index, passes),
            ..Cell::default()
        })
    }

    fn passes(&self, cell: usize, passes: &[(String, bool)]) -> Vec<PassShare> {
        let ms = |pass: usize| {
            let times: Vec<f64> = self.rounds.iter().filter_map(|round| *round.runs[cell][0].passes.get(pass)?).collect();
            median(&times)
        };
        let share = |(index, (pass, counted)): (usize, &(String, bool))| PassShare { pass: pass.clone(), ms: ms(index), counted: *counted };
        passes.iter().enumerate().map(share).filter(|share| share.ms.is_finite()).collect()
    }

    /// A cell at one take, as a point of a curve.
    pub fn point(&self, cell: usize, take: usize, figures: Cell, animation_time: f32) -> Point {
        let frame = self.rounds.first().map_or(0, |round| round.runs[cell][0].takes[take].frame);
        Point {
            frame,
            time_ms: figures.time_ms.median,
            times_ms: figures.time_ms.values,
            animation_time,
            mse: figures.mse,
            rel_mse: figures.rel_mse,
        }
    }

    /// The films of the offer that weighs most.
    ///
    /// # Errors
    /// When a film cannot be read.
    pub fn films(&self, index: usize, cell: &Cell, take: usize) -> Result<Vec<Film>, CompareError> {
        let heaviest = (0..cell.variants.len()).max_by(|&a, &b| cell.variants[a].weight.total_cmp(&cell.variants[b].weight)).unwrap_or(0);
        self.rounds.par_iter().map(|round| self.store.film(&round.runs[index][heaviest].takes[take])).collect()
    }
}

/// A cell's name in the names of files: the graph's, and whose time it was given.
pub fn cell_name(cell: &Cell, entrants: &[Entrant]) -> String {
    let own = &entrants[cell.graph].name;
    match (cell.budget_ms, cell.budget_of) {
        (Some(_), Some(of)) => format!("{own}_in_time_of_{}", entrants[of].name),
        (Some(_), None) => format!("{own}_in_budget"),
        (None, _) => own.clone(),
    }
}
