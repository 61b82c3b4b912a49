//! Every parameter and every slot as a widget, from the shaders' own declarations.

use super::{Viewer, bar::named};
use crate::{
    save::{param_key, slot_key, written},
    session::Shown,
};
use aquifer_graph::{Graph, Literal, Node, Param, RESERVED_PARAMS, Value};
use eframe::egui::{self, RichText};
use std::{collections::BTreeSet, sync::Arc};

/// Ranges whose ends are so many times apart are drawn logarithmically.
const WIDE: f64 = 100.0;

impl Viewer {
    pub(super) fn parameters(&mut self, ui: &mut egui::Ui, side: usize) {
        let Some(shown) = self.board.sides.get(side).and_then(|side| side.shown.clone()) else {
            ui.label("No graph yet.");
            return;
        };
        ui.label(RichText::new(shown.graph.title()).heading());
        ui.label(format!("light paths: {}", shown.graph.transport()));
        if !shown.graph.about().is_empty() {
            ui.label(RichText::new(shown.graph.about()).weak());
        }
        let changes = self.recipes[side].settings.len();
        ui.add_enabled_ui(changes > 0, |ui| {
            if ui.button(format!("Reset all ({changes})")).clicked() {
                self.recipes[side].settings.clear();
                self.send_recipe(side);
            }
        });
        ui.separator();
        self.slots(ui, side, &shown);
        let mut seen = BTreeSet::new();
        for node in shown.graph.nodes().iter().filter(|node| seen.insert(node.pass.clone())) {
            self.pass(ui, side, node, &shown);
        }
    }

    /// The graph's slots, for every pass that asks for them.
    fn slots(&mut self, ui: &mut egui::Ui, side: usize, shown: &Arc<Shown>) {
        let slots: BTreeSet<&String> = shown.graph.nodes().iter().flat_map(|node| &node.contract.slots).collect();
        if slots.is_empty() {
            return;
        }
        egui::CollapsingHeader::new("slots").default_open(true).show(ui, |ui| {
            egui::Grid::new("slots").num_columns(3).show(ui, |ui| {
                for slot in slots {
                    let filling = |graph: &Graph| {
                        graph.nodes().iter().find_map(|node| node.slots.get(slot).filter(|_| node.contract.slots.contains(slot)).cloned())
                    };
                    let now = filling(&shown.graph).unwrap_or_default();
                    self.slot(ui, side, &slot_key(slot), slot, &now);
                    ui.end_row();
                }
            });
        });
    }

    /// One slot as a drop-down.
    fn slot(&mut self, ui: &mut egui::Ui, side: usize, key: &str, slot: &str, now: &str) {
        let setting = self.recipes[side].setting(key).map(str::to_owned);
        let default = self.board.defaults.get(slot).map_or("", String::as_str);
        let now = if now.is_empty() { default } else { now };
        let mut chosen = setting.as_deref().map_or(now, |value| value.trim_matches('"')).to_owned();
        let before = chosen.clone();
        ui.label(slot);
        let combo = egui::ComboBox::from_id_salt(key).selected_text(&chosen).show_ui(ui, |ui| {
            for filling in self.board.slots.get(slot).into_iter().flatten() {
                ui.selectable_value(&mut chosen, filling.clone(), filling);
            }
        });
        named(&combo.response, key);
        if chosen != before {
            self.recipes[side].set(key, Some(format!("\"{chosen}\"")));
            self.send_recipe(side);
        }
        self.reset(ui, side, key, setting.is_some());
    }

    fn pass(&mut self, ui: &mut egui::Ui, side: usize, node: &Node, shown: &Arc<Shown>) {
        let params: Vec<&Param> = node.contract.params.iter().filter(|param| !RESERVED_PARAMS.contains(&param.name.as_str())).collect();
        if params.is_empty() && node.contract.slots.is_empty() {
            return;
        }
        egui::CollapsingHeader::new(&node.pass).default_open(true).show(ui, |ui| {
            ui.label(RichText::new(&node.contract.about).weak());
            egui::Grid::new(&node.pass).num_columns(3).show(ui, |ui| {
                for param in params {
                    self.param(ui, side, node, param, &shown.written);
                    ui.end_row();
                }
            });
            if !node.contract.slots.is_empty() {
                egui::CollapsingHeader::new("slots of this pass alone").id_salt((&node.pass, "slots")).show(ui, |ui| {
                    egui::Grid::new((&node.pass, "slots")).num_columns(3).show(ui, |ui| {
                        for slot in &node.contract.slots {
                            let now = node.slots.get(slot).cloned().unwrap_or_default();
                            self.slot(ui, side, &format!("{}.{}", node.pass, slot_key(slot)), slot, &now);
                            ui.end_row();
                        }
                    });
                });
            }
        });
    }

    fn param(&mut self, ui: &mut egui::Ui, side: usize, node: &Node, param: &Param, written_graph: &Graph) {
        let key = param_key(&node.pass, &param.name);
        let base = written_graph.nodes().iter().find(|known| known.pass == node.pass).and_then(|known| known.params.get(&param.name));
        let setting = self.recipes[side].setting(&key).and_then(|text| param.value(&literal(text)).ok());
        let before = setting.or(node.params.get(&param.name).copied()).unwrap_or(param.default);
        let before = if setting.is_none() { base.copied().unwrap_or(before) } else { before };
        let mut value = before;
        ui.label(&param.name).on_hover_text(help(param));
        let response = widget(ui, &key, param, &mut value);
        response.on_hover_text(help(param));
        if value != before {
            let differs = base != Some(&value);
            self.recipes[side].set(&key, differs.then(|| written(param, value)));
            self.send_recipe(side);
        }
        self.reset(ui, side, &key, setting.is_some());
    }

    /// A button that takes a change away.
    fn reset(&mut self, ui: &mut egui::Ui, side: usize, key: &str, changed: bool) {
        if !changed {
            ui.label("");
            return;
        }
        let button = ui.small_button("reset").on_hover_text("As the graph's file has it");
        named(&button, &format!("Reset {key}"));
        if button.clicked() {
            self.recipes[side].set(key, None);
            self.send_recipe(side);
        }
    }
}

/// What the shader says of a parameter.
fn help(param: &Param) -> String {
    let range = param.range.map(|(least, most)| format!("\nfrom {least} to {most}")).unwrap_or_default();
    let how = if param.live { "changes at once" } else { "baked: compiled anew in the background" };
    format!("{}{range}\n{how}", param.doc)
}

fn widget(ui: &mut egui::Ui, key: &str, param: &Param, value: &mut Value) -> egui::Response {
    match value {
        Value::Bool(on) => ui.checkbox(on, ""),
        Value::U32(index) if !param.choices.is_empty() => {
            let name = |index: u32| param.choices.get(index as usize).map_or("?", String::as_str);
            let combo = egui::ComboBox::from_id_salt(key).selected_text(name(*index)).show_ui(ui, |ui| {
                for choice in 0..param.choices.len() as u32 {
                    ui.selectable_value(index, choice, name(choice));
                }
            });
            named(&combo.response, key);
            combo.response
        }
        Value::U32(number) => number_widget(ui, key, param, number),
        Value::I32(number) => number_widget(ui, key, param, number),
        Value::F32(number) => number_widget(ui, key, param, number),
    }
}

fn number_widget<N: egui::emath::Numeric>(ui: &mut egui::Ui, key: &str, param: &Param, number: &mut N) -> egui::Response {
    let response = match param.range {
        Some((least, most)) => {
            let wide = least >= 0.0 && most > WIDE * least.max(1.0);
            ui.add(egui::Slider::new(number, N::from_f64(least)..=N::from_f64(most)).logarithmic(wide))
        }
        None => ui.add(egui::DragValue::new(number)),
    };
    named(&response, key);
    response
}

/// What a setting's text means.
fn literal(text: &str) -> Literal {
    if let Ok(value) = text.parse() {
        return Literal::Bool(value);
    }
    if let Ok(value) = text.parse() {
        return Literal::Integer(value);
    }
    text.parse().map_or_else(|_| Literal::Text(text.trim_matches('"').to_owned()), Literal::Float)
}
