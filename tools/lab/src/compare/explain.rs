//! Which part of a graph's bias comes from which of its switches: each is turned on alone, and off alone.
//!
//! What turns a switch off is said beside it in the shaders (`@unbiased VALUE`, `//! bias [slot = filling]`). Lines of a graph that the same
//! setting turns off are one switch. Shares need not add up: what one switch loses, another may have lost already.

use super::{
    bench::Entrant,
    bias::bias,
    budget::Offer,
    error::CompareError,
    evaluate::Rounds,
    report::{BiasFigures, Explained, Share, SwitchShare},
    store::{Settled, SettledCell},
};
use crate::film::Film;
use aquifer_graph::{BiasFinding, Source};
use std::collections::BTreeSet;

/// Lines of a graph that one setting turns off.
#[derive(Clone, Debug, PartialEq)]
pub struct Switch {
    what: String,
    setting: Option<String>,
}

/// The switches of a graph, in the order of its findings.
pub fn switches(findings: &[BiasFinding]) -> Vec<Switch> {
    let mut found: Vec<Switch> = Vec::new();
    for finding in findings {
        let switch = Switch { what: format!("{}: {}", finding.what, finding.why), setting: finding.without.clone() };
        let same = |known: &Switch| if switch.setting.is_some() { known.setting == switch.setting } else { known.what == switch.what };
        if !found.iter().any(same) {
            found.push(switch);
        }
    }
    found
}

/// Settings that are laid over the graph in a variant, in order.
type Off = BTreeSet<String>;

/// The variants that tell: as written, all off, each on alone, each off alone; equal ones once.
fn variants(switches: &[Switch]) -> Vec<Off> {
    let all = settings(switches);
    let mut variants = vec![Off::new()];
    for setting in &all {
        variants.push(Off::from([setting.clone()]));
        variants.push(all.iter().filter(|other| *other != setting).cloned().collect());
    }
    variants.push(all);
    let mut seen = BTreeSet::new();
    variants.retain(|variant| seen.insert(variant.clone()));
    variants
}

fn settings(switches: &[Switch]) -> Off {
    switches.iter().filter_map(|switch| switch.setting.clone()).collect()
}

/// A biased graph with its variants.
pub struct Question {
    graph: usize,
    switches: Vec<Switch>,
    variants: Vec<Off>,
    /// One for each variant.
    pub entrants: Vec<Entrant>,
}

impl Question {
    /// What there is to ask of a graph; `None` of one without bias.
    ///
    /// # Errors
    /// [`CompareError::Graph`] where a variant is no graph.
    pub fn new(graph: usize, entrant: &Entrant, findings: &[BiasFinding]) -> Result<Option<Self>, CompareError> {
        let switches = switches(findings);
        if switches.is_empty() {
            return Ok(None);
        }
        let variants = variants(&switches);
        let variant = |off: &Off| {
            let mut document = entrant.document.clone();
            document.apply(off.iter().map(|setting| Source::new("--explain-bias", setting)))?;
            let settings: Vec<String> = off.iter().cloned().collect();
            Ok(Entrant {
                name: [entrant.name.clone()].into_iter().chain(settings.clone()).collect::<Vec<_>>().join(","),
                document,
                settings,
            })
        };
        let entrants = variants.iter().map(variant).collect::<Result<_, CompareError>>()?;
        Ok(Some(Self { graph, switches, variants, entrants }))
    }

    /// Every variant runs one frame as written: nothing has a budget.
    pub fn settled(&self) -> Settled {
        let cell = |graph| SettledCell { graph, budget: None, offers: vec![Offer { knob: None, frames: 1 }] };
        Settled { frame_ms: Vec::new(), cells: (0..self.entrants.len()).map(cell).collect() }
    }

    /// The answer, from rounds of [`Question::settled`] in a store.
    ///
    /// # Errors
    /// When a film cannot be read.
    pub fn answer(&self, measured: &Rounds<'_>, reference: &Film) -> Result<Explained, CompareError> {
        let share = |off: &Off| -> Result<Option<Share>, CompareError> {
            let Some(variant) = self.variants.iter().position(|known| known == off) else { return Ok(None) };
            let films = measured.rounds.iter().map(|round| measured.store.film(&round.runs[variant][0].takes[0]));
            let figures = bias(&films.collect::<Result<Vec<_>, _>>()?, reference)?;
            let BiasFigures { mean_difference, mean_error, bias_squared, bias_squared_interval, .. } = figures;
            Ok(Some(Share { mean_difference, mean_error, bias_squared, bias_squared_interval }))
        };
        let all = settings(&self.switches);
        let mut switches = Vec::new();
        for Switch { what, setting } in &self.switches {
            let (alone, without) = match setting {
                None => (None, None),
                Some(own) => {
                    let others = all.iter().filter(|setting| *setting != own).cloned().collect();
                    (share(&others)?, share(&Off::from([own.clone()]))?)
                }
            };
            switches.push(SwitchShare { what: what.clone(), setting: setting.clone(), alone, without });
        }
        Ok(Explained {
            graph: self.graph,
            seeds: measured.rounds.len() as u64,
            all_on: share(&Off::new())?.unwrap_or_default(),
            all_off: if all.is_empty() { None } else { share(&all)? },
            switches,
        })
    }
}
