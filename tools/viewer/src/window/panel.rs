//! The panel beside the stage, and the times that it remembers.

use super::{
    Viewer,
    state::{SIDE_NAMES, Tab},
};
use crate::session::Board;
use eframe::egui;
use std::collections::{BTreeMap, VecDeque};

/// Pictures that the timing history looks back on.
const LENGTH: usize = 240;

/// Times of every pass, picture by picture.
#[derive(Default)]
pub struct History {
    updates: u64,
    /// By side: milliseconds by pass.
    passes: [BTreeMap<String, VecDeque<f64>>; 2],
}

impl History {
    /// Takes note of the board, once a picture.
    pub fn note(&mut self, board: &Board) {
        if std::mem::replace(&mut self.updates, board.updates) == board.updates {
            return;
        }
        for (passes, side) in self.passes.iter_mut().zip(&board.sides) {
            passes.retain(|name, _| side.times.iter().any(|time| time.pass == *name));
            for time in &side.times {
                let samples = passes.entry(time.pass.clone()).or_default();
                samples.extend(time.latest_ms);
                samples.drain(..samples.len().saturating_sub(LENGTH));
            }
        }
    }

    /// Milliseconds by pass.
    pub fn of(&self, side: usize) -> &BTreeMap<String, VecDeque<f64>> {
        &self.passes[side]
    }
}

impl Viewer {
    pub(super) fn panel(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            for (tab, name) in
                [(Tab::Parameters, "Parameters"), (Tab::Graph, "Graph"), (Tab::Errors, "Errors"), (Tab::Inspector, "Inspector")]
            {
                if ui.selectable_value(&mut self.state.tab, tab, name).clicked() && tab == Tab::Errors && self.state.truth.is_none() {
                    self.ask_truth(0);
                }
            }
        });
        if self.recipes.len() > 1 && matches!(self.state.tab, Tab::Parameters | Tab::Graph) {
            ui.horizontal(|ui| {
                for (side, name) in SIDE_NAMES.iter().enumerate() {
                    let words = egui::RichText::new(format!("of {name}")).color(super::bar::readable(ui, side));
                    ui.selectable_value(&mut self.state.front, side, words);
                }
            });
        }
        ui.separator();
        let side = self.state.front.min(self.recipes.len() - 1);
        egui::ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| match self.state.tab {
            Tab::Parameters => self.parameters(ui, side),
            Tab::Graph => self.graph(ui, side),
            Tab::Errors => self.curves(ui),
            Tab::Inspector => self.inspector(ui),
        });
    }
}
