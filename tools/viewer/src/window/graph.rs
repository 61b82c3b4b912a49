//! The graph as a picture: passes, wires, times and bytes; a click on a wire shows its resource.

use super::{Viewer, bar::named};
use crate::session::{Message, Shown, Watch};
use aquifer_graph::{Direction, Graph, When, Wire};
use eframe::egui::{self, Align2, Color32, CornerRadius, FontId, Pos2, Rect, RichText, Sense, Shape, Stroke, StrokeKind, Vec2, pos2, vec2};
use egui_plot::{Legend, Line, Plot, PlotPoints};

/// Points of a pass's box.
const BOX: Vec2 = vec2(150.0, 44.0);
/// Points between boxes.
const GAP: Vec2 = vec2(24.0, 40.0);
/// Points from a wire in which a click counts.
const NEAR: f32 = 5.0;
/// Straight pieces of a curved wire.
const PIECES: usize = 24;
/// Points down of the timing history.
const HEIGHT: f32 = 150.0;

/// Where a box lies: down by the length of the way to it, across in the order of the file.
pub fn places(graph: &Graph) -> Vec<[usize; 2]> {
    let mut depths = vec![0_usize; graph.nodes().len()];
    // Wires of this frame have no loops: after as many rounds as there are passes, nothing moves any more.
    for _ in 0..depths.len() {
        for (index, node) in graph.nodes().iter().enumerate() {
            let from = node.wires.iter().flatten().filter(|wire| wire.when == When::This).map(|wire| depths[wire.from.node] + 1);
            depths[index] = from.max().unwrap_or(0).min(graph.nodes().len());
        }
    }
    let mut taken = vec![0; graph.nodes().len() + 1];
    let mut place = |depth: usize| {
        taken[depth] += 1;
        [taken[depth] - 1, depth]
    };
    depths.into_iter().map(&mut place).collect()
}

impl Viewer {
    pub(super) fn graph(&mut self, ui: &mut egui::Ui, side: usize) {
        let Some(shown) = self.board.sides.get(side).and_then(|side| side.shown.clone()) else {
            ui.label("No graph yet.");
            return;
        };
        let mut clicked = None;
        egui::ScrollArea::horizontal().id_salt("picture").show(ui, |ui| clicked = self.drawing(ui, side, &shown));
        for left in &shown.plan.left_out {
            ui.label(RichText::new(format!("{} is left out: {}", left.node, left.reason)).weak());
        }
        ui.label(RichText::new("Bold: rewritten in place. Dashed: last frame's. The mean over frames is taken by the viewer.").weak());
        ui.separator();
        clicked = self.resources(ui, side, &shown).or(clicked);
        if let Some(watch) = clicked {
            self.session.send(Message::Watch(side, watch));
        }
        ui.separator();
        self.times(ui, side);
    }

    /// The picture; the answer is a wire that was clicked.
    fn drawing(&self, ui: &mut egui::Ui, side: usize, shown: &Shown) -> Option<Option<Watch>> {
        let places = places(&shown.graph);
        let most = |axis: usize| places.iter().map(|place| place[axis] + 1).max().unwrap_or(1) as f32;
        let extent = (BOX + GAP) * vec2(most(0), most(1)) + vec2(GAP.x, 0.0);
        let (response, painter) = ui.allocate_painter(extent.max(vec2(ui.available_width(), 0.0)), Sense::click());
        let rect = |node: usize| {
            let [across, down] = places[node];
            let corner = response.rect.min + vec2(0.5 * GAP.x, 0.25 * GAP.y) + (BOX + GAP) * vec2(across as f32, down as f32);
            Rect::from_min_size(corner, BOX)
        };
        let pointer = response.hover_pos();
        let mut hovered = None;
        for (index, node) in shown.graph.nodes().iter().enumerate() {
            for (port, wire) in node.wires.iter().enumerate() {
                let Some(wire) = wire else { continue };
                let line = way(rect(wire.from.node), rect(index), wire, port);
                let near = pointer.is_some_and(|pointer| line.windows(2).any(|piece| distance(pointer, piece[0], piece[1]) < NEAR));
                if near {
                    hovered = Some(*wire);
                }
                let inout = node.port(port).direction == Direction::InOut;
                let color = if near { ui.visuals().hyperlink_color } else { ui.visuals().weak_text_color() };
                let stroke = Stroke::new(if inout || near { 2.5 } else { 1.2 }, color);
                if wire.when == When::Previous {
                    painter.extend(Shape::dashed_line(&line, stroke, 5.0, 4.0));
                } else {
                    painter.add(Shape::line(line.clone(), stroke));
                }
                arrow(&painter, &line, stroke);
            }
        }
        for index in 0..places.len() {
            self.node(ui, &painter, rect(index), side, shown, index);
        }
        let wire = hovered?;
        let name = shown.graph.port_name(wire.from);
        let ty = &shown.graph.nodes()[wire.from.node].port(wire.from.port).ty;
        response.clone().on_hover_text(format!("{name}\n{}", ty.element));
        response.clicked().then_some(Some(Watch { resource: name, member: None }))
    }

    fn node(&self, ui: &egui::Ui, painter: &egui::Painter, rect: Rect, side: usize, shown: &Shown, index: usize) {
        let node = &shown.graph.nodes()[index];
        let runs = shown.plan.steps.iter().any(|step| step.node == node.name);
        let visuals = ui.visuals();
        let (fill, ink) = if runs {
            (visuals.widgets.inactive.bg_fill, visuals.strong_text_color())
        } else {
            (Color32::TRANSPARENT, visuals.weak_text_color())
        };
        painter.rect(rect, CornerRadius::same(5), fill, Stroke::new(1.0, visuals.weak_text_color()), StrokeKind::Inside);
        painter.text(rect.min + vec2(8.0, 5.0), Align2::LEFT_TOP, &node.name, FontId::proportional(14.0), ink);
        let time = self.board.sides[side].times.iter().find(|time| time.pass == node.name).and_then(|time| time.median_ms);
        let bytes: u64 = shown
            .memory
            .resources
            .iter()
            .filter(|memory| memory.name.rsplit_once('.').is_some_and(|(of, _)| of == node.name))
            .map(|memory| memory.bytes)
            .sum();
        let words = match (runs, time) {
            (false, _) => "left out".to_owned(),
            (true, None) => size_words(bytes),
            (true, Some(time)) => format!("{time:.2} ms   {}", size_words(bytes)),
        };
        painter.text(
            rect.left_bottom() + vec2(8.0, -5.0),
            Align2::LEFT_BOTTOM,
            words,
            FontId::proportional(11.0),
            visuals.weak_text_color(),
        );
    }

    /// Every resource as a button, and which number of it is shown.
    fn resources(&self, ui: &mut egui::Ui, side: usize, shown: &Shown) -> Option<Option<Watch>> {
        let watched = self.board.sides[side].watched.clone();
        let mut answer = None;
        if ui.add_enabled(watched.is_some(), egui::Button::new("Back to the picture")).clicked() {
            answer = Some(None);
        }
        if let Some(watched) = watched.as_ref().filter(|watched| !watched.members.is_empty()) {
            let mut member = watched.watch.member.clone();
            let text = member.clone().unwrap_or_else(|| "as colour, or its first number".to_owned());
            let combo = egui::ComboBox::from_id_salt("member").selected_text(text).show_ui(ui, |ui| {
                for name in &watched.members {
                    ui.selectable_value(&mut member, Some(name.clone()), name);
                }
            });
            named(&combo.response, "Member");
            if member != watched.watch.member {
                answer = Some(Some(Watch { member, ..watched.watch.clone() }));
            }
            ui.label(format!("from {:.4e} (black) to {:.4e} (white)", watched.range[0], watched.range[1]));
        }
        egui::Grid::new("resources").striped(true).num_columns(3).show(ui, |ui| {
            for resource in &shown.plan.resources {
                let chosen = watched.as_ref().is_some_and(|watched| watched.watch.resource == resource.name);
                if ui.selectable_label(chosen, &resource.name).clicked() {
                    answer = Some(Some(Watch { resource: resource.name.clone(), member: None }));
                }
                ui.label(RichText::new(&resource.ty.element).weak());
                let bytes = shown.memory.resources.iter().find(|memory| memory.name == resource.name).map_or(0, |memory| memory.bytes);
                ui.label(size_words(bytes));
                ui.end_row();
            }
        });
        answer
    }

    fn times(&self, ui: &mut egui::Ui, side: usize) {
        ui.label("milliseconds of each pass, picture by picture");
        Plot::new("times").height(HEIGHT).legend(Legend::default()).allow_scroll(false).include_y(0.0).show(ui, |plot| {
            for (pass, samples) in self.history.of(side) {
                let points: Vec<[f64; 2]> = samples.iter().enumerate().map(|(index, ms)| [index as f64, *ms]).collect();
                plot.line(Line::new(pass.as_str(), PlotPoints::from(points)));
            }
        });
    }
}

/// The way of a wire: down from one box to another; last frame's goes up along the side.
fn way(from: Rect, to: Rect, wire: &Wire, port: usize) -> Vec<Pos2> {
    let across = |rect: Rect, slot: usize| rect.left() + rect.width() * (0.2 + 0.15 * (slot % 5) as f32);
    let (start, end) = (pos2(across(from, wire.from.port), from.bottom()), pos2(across(to, port), to.top()));
    let reach = 0.5 * (end.y - start.y).abs().max(GAP.y);
    let (a, b) = match wire.when {
        When::This => (start + vec2(0.0, reach), end - vec2(0.0, reach)),
        When::Previous => (start + vec2(0.6 * BOX.x, GAP.y), end + vec2(0.6 * BOX.x, -GAP.y)),
    };
    (0..=PIECES).map(|piece| cubic([start, a, b, end], piece as f32 / PIECES as f32)).collect()
}

fn cubic([a, b, c, d]: [Pos2; 4], t: f32) -> Pos2 {
    let s = 1.0 - t;
    let weigh = |point: Pos2, weight: f32| point.to_vec2() * weight;
    (weigh(a, s * s * s) + weigh(b, 3.0 * s * s * t) + weigh(c, 3.0 * s * t * t) + weigh(d, t * t * t)).to_pos2()
}

/// From a point to a straight piece.
fn distance(point: Pos2, a: Pos2, b: Pos2) -> f32 {
    let (along, to) = (b - a, point - a);
    let share = if along.length_sq() > 0.0 { (to.dot(along) / along.length_sq()).clamp(0.0, 1.0) } else { 0.0 };
    (to - along * share).length()
}

fn arrow(painter: &egui::Painter, line: &[Pos2], stroke: Stroke) {
    if let [.., before, end] = line {
        let back = (*before - *end).normalized() * 7.0;
        for side in [0.45_f32, -0.45] {
            painter.line_segment([*end, *end + egui::emath::Rot2::from_angle(side) * back], stroke);
        }
    }
}

/// Bytes for people.
fn size_words(bytes: u64) -> String {
    match bytes {
        0..1024 => format!("{bytes} B"),
        1024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}
