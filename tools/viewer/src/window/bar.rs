//! The bar above the stage, and the line of figures below it.

use super::{
    Viewer,
    keys::HELP,
    state::{Layout, SIDE_COLORS, SIDE_NAMES, Show},
};
use crate::{
    Recipe,
    develop::Curve,
    session::{Choice, Message},
};
use eframe::egui::{self, RichText};

/// Samples that a reference can be asked for.
const REFERENCES: [u64; 4] = [256, 1024, 4096, 16384];
/// Fixed resolutions: the full size divided by these.
const DIVISORS: [f64; 5] = [1.0, 1.5, 2.0, 4.0, 8.0];

impl Viewer {
    pub(super) fn bar(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            self.graph_choices(ui);
            ui.separator();
            self.layouts(ui);
            self.showing(ui);
            ui.separator();
            self.developing(ui);
        });
        ui.horizontal_wrapped(|ui| {
            self.cameras(ui);
            self.animation(ui);
            ui.separator();
            self.rendering(ui);
            ui.separator();
            self.reference(ui);
            ui.separator();
            self.windows(ui);
        });
        self.help(ui);
    }

    fn graph_choices(&mut self, ui: &mut egui::Ui) {
        for side in 0..self.recipes.len() {
            ui.label(RichText::new(SIDE_NAMES[side]).strong().color(SIDE_COLORS[side]));
            let mut chosen = self.recipes[side].graph.clone();
            let label = format!("Graph {}", SIDE_NAMES[side]);
            let combo = egui::ComboBox::from_id_salt(&label).selected_text(&chosen).width(150.0).show_ui(ui, |ui| {
                for graph in &self.known_graphs {
                    ui.selectable_value(&mut chosen, graph.clone(), graph);
                }
            });
            named(&combo.response, &label);
            if chosen != self.recipes[side].graph {
                self.recipes[side] = Recipe::of(chosen);
                self.send_recipe(side);
            }
        }
        if self.recipes.len() == 1 {
            if ui.button("Compare with …").on_hover_text("Opens a second graph on the same scene and camera").clicked() {
                self.recipes.push(self.recipes[0].clone());
                (self.state.layout, self.state.split) = (Layout::Split, 0.5);
                self.send_recipe(1);
            }
        } else if ui.button("Close B").on_hover_text("Closes B").clicked() {
            self.recipes.truncate(1);
            (self.state.layout, self.state.front) = (Layout::Single, 0);
            if self.state.show == Show::Apart {
                self.state.show = Show::Picture;
            }
            self.session.send(Message::Close);
        }
    }

    fn layouts(&mut self, ui: &mut egui::Ui) {
        if self.recipes.len() < 2 {
            return;
        }
        ui.selectable_value(&mut self.state.layout, Layout::Split, "Split").on_hover_text("Key 1: one picture, a slider between A and B");
        ui.selectable_value(&mut self.state.layout, Layout::Beside, "Side by side").on_hover_text("Key 2");
        for (side, name) in SIDE_NAMES.iter().enumerate() {
            let single = self.state.layout == Layout::Single && self.state.front == side;
            let words = format!("Only {name}");
            if ui.selectable_label(single, words).on_hover_text("Key 3; space flips").clicked() {
                (self.state.layout, self.state.front) = (Layout::Single, side);
            }
        }
    }

    fn showing(&mut self, ui: &mut egui::Ui) {
        let mut show = self.state.show;
        let combo = egui::ComboBox::from_id_salt("show").selected_text(show.name()).width(110.0).show_ui(ui, |ui| {
            for (choice, name, help) in Show::ALL {
                if choice != Show::Apart || self.recipes.len() > 1 {
                    ui.selectable_value(&mut show, choice, name).on_hover_text(help);
                }
            }
        });
        named(&combo.response, "Show");
        if show != self.state.show {
            self.state.show = show;
            self.session.send(Message::Flip(show == Show::Flip));
            if show.wants_truth() && self.state.truth.is_none() {
                self.ask_truth(0);
            }
        }
    }

    fn developing(&mut self, ui: &mut egui::Ui) {
        if matches!(self.state.show, Show::Apart | Show::Difference) {
            ui.add(egui::Slider::new(&mut self.state.amplify, -4.0..=10.0).text("amplified, stops"));
        } else if self.state.show == Show::Picture {
            ui.add(egui::Slider::new(&mut self.state.developing.exposure, -10.0..=10.0).text("exposure"));
            let curve = &mut self.state.developing.curve;
            let combo = egui::ComboBox::from_id_salt("curve").selected_text(curve.name()).width(70.0).show_ui(ui, |ui| {
                for (choice, name) in Curve::ALL {
                    ui.selectable_value(curve, choice, name);
                }
            });
            named(&combo.response, "Tone curve");
        }
    }

    fn cameras(&mut self, ui: &mut egui::Ui) {
        let names = self.board.cameras.clone();
        let text = match (&self.state.mover, &self.state.camera) {
            (Some(_), _) => "free".to_owned(),
            (None, Some(name)) => name.clone(),
            (None, None) => names.first().cloned().unwrap_or_default(),
        };
        ui.label("camera");
        let mut chosen = None;
        let combo = egui::ComboBox::from_id_salt("camera").selected_text(text).width(90.0).show_ui(ui, |ui| {
            for name in &names {
                if ui.selectable_label(self.state.mover.is_none() && self.state.camera.as_ref() == Some(name), name).clicked() {
                    chosen = Some(name.clone());
                }
            }
        });
        named(&combo.response, "Camera");
        if chosen.is_some() {
            self.use_camera(chosen);
        }
        if let Some(mover) = &mut self.state.mover {
            ui.add(egui::DragValue::new(&mut mover.speed).range(1e-3..=1e6).speed(0.02).suffix(" m/s"))
                .on_hover_text("How fast W A S D fly");
        }
    }

    fn animation(&mut self, ui: &mut egui::Ui) {
        if self.board.duration <= 0.0 {
            return;
        }
        ui.separator();
        if ui.button(if self.state.plays { "Pause" } else { "Play" }).on_hover_text("Key P: plays or pauses the animation").clicked() {
            self.play(!self.state.plays);
        }
        if ui.button("Step").on_hover_text("Key . : one step of the animation").clicked() {
            self.session.send(Message::Step);
        }
        let mut time = self.board.moment.as_ref().map_or(0.0, |moment| moment.time);
        if ui.add(egui::Slider::new(&mut time, 0.0..=self.board.duration).suffix(" s")).changed() {
            self.session.send(Message::Time(time));
        }
    }

    fn rendering(&mut self, ui: &mut egui::Ui) {
        let mut holds = self.state.holds;
        if ui.toggle_value(&mut holds, "Hold").on_hover_text("Key H: rendering stands still").changed() {
            self.hold(holds);
        }
        if ui
            .checkbox(&mut self.state.averages, "average")
            .on_hover_text("While nothing moves, the picture is the mean of all frames; else the last frame")
            .changed()
        {
            self.session.send(Message::Average(self.state.averages));
        }
        let mut scale = self.state.scale;
        let text = |scale: Choice| match scale {
            Choice::Automatic => "automatic size".to_owned(),
            Choice::Fixed(divisor) => format!("1/{divisor}"),
        };
        let combo = egui::ComboBox::from_id_salt("scale").selected_text(text(scale)).width(110.0).show_ui(ui, |ui| {
            for choice in [Choice::Automatic].into_iter().chain(DIVISORS.map(Choice::Fixed)) {
                ui.selectable_value(&mut scale, choice, text(choice));
            }
        });
        named(&combo.response, "Resolution");
        if scale != self.state.scale {
            self.state.scale = scale;
            self.session.send(Message::Scale(scale));
        }
    }

    fn reference(&mut self, ui: &mut egui::Ui) {
        let text = match (&self.board.truth, self.state.truth) {
            (Some(truth), _) => format!("reference: {} samples", truth.samples),
            (None, None) => "no reference".to_owned(),
            (None, Some(_)) => "reference: none yet".to_owned(),
        };
        let mut wanted = None;
        let combo = egui::ComboBox::from_id_salt("reference").selected_text(text).width(170.0).show_ui(ui, |ui| {
            if ui.selectable_label(false, "what the cache has").clicked() {
                wanted = Some(0);
            }
            for samples in REFERENCES {
                if ui.selectable_label(self.state.truth == Some(samples), format!("{samples} samples a pixel")).clicked() {
                    wanted = Some(samples);
                }
            }
        });
        named(&combo.response, "Reference");
        if let Some(samples) = wanted {
            self.ask_truth(samples);
        }
        if !self.board.truth_state.is_empty() {
            ui.label(RichText::new(&self.board.truth_state).weak());
        }
    }

    pub(super) fn ask_truth(&mut self, samples: u64) {
        self.state.truth = Some(samples);
        self.session.send(Message::Truth(samples));
    }

    fn windows(&mut self, ui: &mut egui::Ui) {
        let dark = ui.visuals().dark_mode;
        if ui.button(if dark { "Light" } else { "Dark" }).on_hover_text("Light or dark window").clicked() {
            ui.ctx().set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
        }
        ui.toggle_value(&mut self.state.loupe, "Loupe").on_hover_text("Key L: pixels with values");
        ui.toggle_value(&mut self.state.files.open, "Keep").on_hover_text("Save changes, pictures, films; copy the command line");
        ui.toggle_value(&mut self.state.panel, "Panel").on_hover_text("F2");
        ui.toggle_value(&mut self.state.help, "?").on_hover_text("F1: keys and mouse");
    }

    fn help(&mut self, ui: &egui::Ui) {
        egui::Window::new("Keys and mouse").open(&mut self.state.help).resizable(false).show(ui.ctx(), |ui| {
            egui::Grid::new("keys").striped(true).show(ui, |ui| {
                for (keys, what) in HELP {
                    ui.label(RichText::new(keys).monospace());
                    ui.label(what);
                    ui.end_row();
                }
            });
        });
    }

    /// What was rendered, and how fast.
    pub(super) fn status(&self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            if let Some(waiting) = &self.board.waiting {
                ui.spinner();
                ui.label(waiting);
            }
            let milliseconds = self.board.update.as_secs_f64() * 1e3;
            let size = self.board.sides.iter().find_map(|side| side.picture.as_ref()).map(|picture| picture.film.size);
            if let Some([width, height]) = size {
                ui.label(format!("{} · {width}×{height} · {:.1} pictures/s", self.board.adapter, 1e3 / milliseconds.max(1e-3)));
            }
            for (side, board) in self.board.sides.iter().enumerate() {
                ui.separator();
                if board.building {
                    ui.spinner();
                    ui.label("compiling");
                }
                if let Some(picture) = &board.picture {
                    let words = format!("{} {} samples in {:.2} s", SIDE_NAMES[side], picture.samples, picture.spent * 1e-3);
                    ui.label(RichText::new(words).color(readable(ui, side))).on_hover_text(format!(
                        "{} frames in the last picture, {} in all; both sides spend the same time",
                        board.frames, picture.frames
                    ));
                }
            }
        });
    }
}

/// A side's colour on the window's ground.
pub fn readable(ui: &egui::Ui, side: usize) -> egui::Color32 {
    if ui.visuals().dark_mode { SIDE_COLORS[side] } else { SIDE_COLORS[side].lerp_to_gamma(egui::Color32::BLACK, 0.45) }
}

/// Gives a drop-down a name, for those who cannot see what stands beside it.
pub fn named(response: &egui::Response, name: &str) {
    // Nothing where nobody listens.
    let _ = response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name));
}
