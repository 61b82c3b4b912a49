//! Films as textures, made anew only when what they show has changed.

use super::state::{Show, State};
use crate::{
    develop::{self, Curve, Developing},
    session::{Board, Side, difference},
};
use aquifer_graph::{Graph, Value};
use aquifer_lab::{film::Film, metrics::heat};
use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};
use std::sync::Arc;

/// The textures of both sides.
#[derive(Default)]
pub struct Images {
    cells: [Option<Cell>; 2],
}

struct Cell {
    key: Key,
    texture: TextureHandle,
}

/// What decides an image.
#[derive(PartialEq)]
struct Key {
    pictures: [u64; 2],
    show: Show,
    developing: Developing,
    amplify: f32,
    /// Samples of the reference, and of FLIP's map where that is shown.
    truth: Option<(u64, usize)>,
    watched: Option<usize>,
}

/// Exposure and curve of the graph's own tone mapping.
pub fn developing_of(graph: &Graph) -> Developing {
    let value = |name: &str| graph.nodes().iter().find_map(|node| (node.kind == "tonemap").then(|| node.params.get(name).copied())?);
    let exposure = match value("exposure") {
        Some(Value::F32(stops)) => stops,
        _ => 0.0,
    };
    let curve = match value("curve") {
        Some(Value::U32(index)) => Curve::ALL.get(index as usize).map_or(Curve::Linear, |(curve, _)| *curve),
        _ => Curve::Linear,
    };
    Developing { exposure, curve }
}

impl Images {
    /// The texture of a side with its size in pixels; the last good one where there is nothing to show now.
    pub fn of(&mut self, context: &egui::Context, board: &Board, state: &State, side: usize) -> Option<(egui::TextureId, [usize; 2])> {
        let key = key(board, state, side);
        if self.cells[side].as_ref().is_none_or(|cell| cell.key != key)
            && let Some(image) = image(board, state, side)
        {
            match &mut self.cells[side] {
                Some(cell) => {
                    cell.texture.set(image, TextureOptions::NEAREST);
                    cell.key = key;
                }
                empty => *empty = Some(Cell { key, texture: context.load_texture(format!("side {side}"), image, TextureOptions::NEAREST) }),
            }
        }
        self.cells[side].as_ref().map(|cell| (cell.texture.id(), cell.texture.size()))
    }
}

fn key(board: &Board, state: &State, side: usize) -> Key {
    let number = |side: usize| board.sides.get(side).and_then(|side| side.picture.as_ref()).map_or(0, |picture| picture.number);
    let pictures = if state.show == Show::Apart { [number(0), number(1)] } else { [number(side); 2] };
    let flip = |side: &Side| side.judged.as_ref()?.flip.as_ref().map(|map| Arc::as_ptr(map).addr());
    let truth = board.truth_of(side).filter(|_| state.show.wants_truth());
    let map = if state.show == Show::Flip { board.sides.get(side).and_then(flip).unwrap_or(0) } else { 0 };
    let watched = board.sides.get(side).and_then(|side| side.watched.as_ref()).map(|watched| Arc::as_ptr(watched).addr());
    let truth = truth.map(|truth| (truth.samples, map));
    Key { pictures, show: state.show, developing: state.developing, amplify: state.amplify, truth, watched }
}

fn image(board: &Board, state: &State, side: usize) -> Option<ColorImage> {
    let (film, how) = film(board, state, side)?;
    let size = film.size.map(|side| side as usize);
    Some(ColorImage::from_rgba_unmultiplied(size, &develop::bytes(&film, how)))
}

/// What is shown of a side, and how it is to be developed; `None` where it cannot be made.
pub fn film(board: &Board, state: &State, side: usize) -> Option<(Film, Developing)> {
    let amplified = Developing { exposure: state.amplify, curve: Curve::Linear };
    let plain = Developing::default();
    let board_side = board.sides.get(side)?;
    if let Some(watched) = &board_side.watched {
        let film = watched.film.as_ref()?;
        let [low, high] = watched.range;
        // Colours are shown as they are; single numbers from their smallest to their largest.
        return Some(match watched.watch.member.is_some() || !watched.element.starts_with("vec") {
            false => (film.clone(), state.developing),
            true => (stretched(film, low, high), plain),
        });
    }
    let picture = &board_side.picture.as_ref()?.film;
    let truth = || board.truth_of(side).map(|truth| &truth.film).filter(|truth| truth.size == picture.size);
    match state.show {
        Show::Picture => Some((picture.clone(), state.developing)),
        show if show.wants_truth() && truth().is_none() => Some((picture.clone(), state.developing)),
        Show::Apart => {
            let other = &board.sides.get(1 - side)?.picture.as_ref()?.film;
            Some((difference(picture, other)?, amplified))
        }
        Show::Difference => Some((difference(picture, truth()?)?, amplified)),
        Show::Relative => Some((heat::of_difference(picture, truth()?).ok()?, plain)),
        Show::Flip => Some((heat::of_flip(board_side.judged.as_ref()?.flip.as_ref()?), plain)),
    }
}

fn stretched(film: &Film, low: f32, high: f32) -> Film {
    let scale = if high > low { 1.0 / (high - low) } else { 0.0 };
    Film { color: film.color.iter().map(|color| color.map(|c| (c - low) * scale)).collect(), ..film.clone() }
}
