//! What the reservoirs of a pixel hold.

use super::{Viewer, bar::readable, state::SIDE_NAMES};
use crate::{
    record::Record,
    testimony::{self, Carried, TESTIMONY, Tried},
};
use eframe::egui::{self, RichText};

impl Viewer {
    pub(super) fn inspector(&mut self, ui: &mut egui::Ui) {
        let Some(place) = self.state.inspected else {
            ui.label("Click a pixel of the picture.");
            return;
        };
        if let Some(picture) = self.board.sides.iter().find_map(|side| side.picture.as_ref()) {
            let [x, y] = [0, 1].map(|axis| (place[axis] * picture.film.size[axis] as f32) as u32);
            ui.label(RichText::new(format!("Pixel {x}, {y}")).heading());
        }
        for (side, (board, recipe)) in self.board.sides.iter().zip(&self.recipes).enumerate() {
            ui.label(RichText::new(format!("{}  {}", SIDE_NAMES[side], recipe.graph)).color(readable(ui, side)).strong());
            if board.building {
                ui.label("compiling: reservoirs must be kept for reading …");
            } else if board.records.is_empty() {
                ui.label("This graph has no reservoirs.");
            }
            for record in board.records.iter().filter(|record| !record.resource.ends_with(TESTIMONY)) {
                egui::CollapsingHeader::new(format!("{}  {}", record.resource, record.element))
                    .id_salt((side, &record.resource))
                    .default_open(true)
                    .show(ui, |ui| {
                        egui::Grid::new((side, &record.resource)).striped(true).num_columns(2).show(ui, |ui| {
                            for (member, value) in &record.values {
                                ui.label(member);
                                ui.label(RichText::new(number(*value)).monospace());
                                ui.end_row();
                            }
                        });
                        let told = board.records.iter().find(|told| is_of(told, record));
                        let lines = told.map_or_else(Vec::new, testimony::lines);
                        if !lines.is_empty() {
                            inputs(ui, &lines);
                        }
                    });
            }
        }
    }
}

/// Is this what the pass that left the reservoir told of it?
fn is_of(told: &Record, reservoir: &Record) -> bool {
    let pass = |record: &Record| record.resource.rsplit_once('.').map(|(pass, _)| pass.to_owned());
    told.resource.ends_with(TESTIMONY) && pass(told) == pass(reservoir)
}

/// What was tried, and what became of it.
fn inputs(ui: &mut egui::Ui, lines: &[Tried]) {
    egui::Grid::new(ui.scope_id().with("inputs")).striped(true).num_columns(5).show(ui, |ui| {
        for head in ["input", "W", "Jacobian", "target", "weight w", ""] {
            ui.label(RichText::new(head).weak());
        }
        ui.end_row();
        for line in lines {
            let [x, y] = line.pixel;
            ui.label(RichText::new(format!("{x}, {y}{}", if line.before { " before" } else { "" })).monospace());
            let words = match (line.carried, line.against) {
                (Some(carried), _) => {
                    for value in [carried.weight, carried.jacobian, carried.target, carried.resampling] {
                        ui.label(RichText::new(format!("{value:.3e}")).monospace());
                    }
                    became(&carried)
                }
                (None, against) => {
                    (0..4).for_each(|_| {
                        ui.label("");
                    });
                    against.unwrap_or("found, and not used")
                }
            };
            let words = RichText::new(words);
            ui.label(if line.carried.is_some_and(|carried| carried.kept) { words.strong() } else { words });
            ui.end_row();
        }
    });
}

fn became(carried: &Carried) -> &'static str {
    match carried {
        Carried { kept: true, .. } => "kept",
        Carried { adopted: true, .. } => "adopted, then replaced",
        Carried { weight: 0.0, .. } => "holds nothing",
        Carried { jacobian: 0.0, .. } => "has no shift here",
        Carried { target: 0.0, .. } => "shows nothing here",
        _ => "not drawn",
    }
}

/// Whole numbers without a point.
fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e10 { format!("{value:.0}") } else { format!("{value:.6e}") }
}
