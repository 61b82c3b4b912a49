//! How long each pass of a graph takes.

use super::turns::Middle;
use crate::compare::{
    error::CompareError,
    subject::{Schedule, Stage, Subject},
};
use aquifer_graph::Document;
use serde::Serialize;

/// One graph.
#[derive(Clone, Debug, Serialize)]
pub struct PassesReport {
    /// As it was asked for.
    pub graph: String,
    /// Rounds in which every graph had its turn.
    pub rounds: u32,
    /// In order of execution; passes that only show or average the image are left out.
    pub passes: Vec<(String, Middle)>,
    /// All of them, milliseconds.
    pub frame: Middle,
}

/// Frames before the one that counts, of graphs with history: their cost has settled by then.
const WARM_UP: u32 = 8;

/// Milliseconds of one frame of each graph, in turns.
///
/// # Errors
/// What a graph or the device refuses.
pub fn measure(stage: &Stage, graphs: &[(String, Document)], rounds: u32) -> Result<Vec<PassesReport>, CompareError> {
    let subjects = graphs.iter().map(|(_, document)| stage.subject(document, None, WARM_UP));
    let mut subjects = subjects.collect::<Result<Vec<Subject>, _>>()?;
    let mut times: Vec<Vec<Vec<f64>>> = subjects.iter().map(|subject| vec![Vec::new(); subject.passes().len()]).collect();
    for round in 0..rounds {
        for (subject, times) in subjects.iter_mut().zip(&mut times) {
            let warm_up = if subject.independent() { 0 } else { WARM_UP };
            subject.run(round.into(), Schedule { warm_up, frames: 1 }, |_, _, shot| {
                // A frame whose clock ran backwards says nothing.
                if shot.passes.iter().all(Option::is_some) {
                    times.iter_mut().zip(&shot.passes).for_each(|(times, ms)| times.extend(ms));
                }
                Ok(())
            })?;
        }
    }
    Ok(graphs
        .iter()
        .zip(subjects.iter().zip(&times))
        .filter_map(|((name, _), (subject, times))| report(name, subject, times, rounds))
        .collect())
}

fn report(graph: &str, subject: &Subject, times: &[Vec<f64>], rounds: u32) -> Option<PassesReport> {
    let counted: Vec<(String, &Vec<f64>)> =
        subject.passes().into_iter().zip(times).filter(|((_, counted), _)| *counted).map(|((name, _), times)| (name, times)).collect();
    let frames = counted.first().map_or(0, |(_, times)| times.len());
    let frame = Middle::of((0..frames).map(|frame| counted.iter().map(|(_, times)| times[frame]).sum::<f64>()))?;
    let passes = counted.into_iter().filter_map(|(name, times)| Some((name, Middle::of(times.iter().copied())?))).collect();
    Some(PassesReport { graph: graph.to_owned(), rounds, passes, frame })
}
