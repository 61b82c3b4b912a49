//! Error against time of both sides, live.

use super::{Viewer, bar::readable, state::SIDE_NAMES};
use crate::session::{Judged, Point};
use eframe::egui::{self, RichText};
use egui_plot::{Legend, Line, Plot, PlotPoints};

/// Points down.
const HEIGHT: f32 = 260.0;

impl Viewer {
    pub(super) fn curves(&mut self, ui: &mut egui::Ui) {
        if self.board.truth.is_none() {
            ui.label("Errors are against a reference: choose one above. References are kept, and shared with `aquifer compare`.");
            ui.label(RichText::new(&self.board.truth_state).weak());
            return;
        }
        let judged: Vec<Option<&Judged>> = self.board.sides.iter().map(|side| side.judged.as_deref()).collect();
        ui.label("relMSE against seconds of rendering, both logarithmic");
        let plot = Plot::new("errors").height(HEIGHT).legend(Legend::default()).allow_scroll(false);
        let power = |mark: egui_plot::GridMark, _: &std::ops::RangeInclusive<f64>| format!("{:.3e}", 10_f64.powf(mark.value));
        plot.x_axis_formatter(power).y_axis_formatter(power).show(ui, |plot| {
            for (side, judged) in judged.iter().enumerate() {
                let points = judged.map_or_else(Vec::new, |judged| logarithms(&judged.curve));
                plot.line(Line::new(SIDE_NAMES[side], PlotPoints::from(points)).color(super::state::SIDE_COLORS[side]).width(2.0));
            }
        });
        self.figures(ui, &judged);
        for (side, name) in SIDE_NAMES.iter().enumerate() {
            if let Some(why) = self.board.unjudged(side) {
                ui.label(RichText::new(format!("{name} is not judged: {why}.")).color(readable(ui, side)));
            }
        }
        if let [Some(a), Some(b)] = judged.as_slice()
            && let Some((seconds, ratio)) = at_equal_time(&a.curve, &b.curve)
        {
            ui.label(format!("After {seconds:.2} s each, A has {ratio:.2} times the error of B."));
            ui.label(RichText::new("One run, no verdict: `aquifer compare` measures over seeds and says what is chance.").weak());
        }
    }

    fn figures(&self, ui: &mut egui::Ui, judged: &[Option<&Judged>]) {
        egui::Grid::new("figures").striped(true).num_columns(1 + judged.len()).show(ui, |ui| {
            ui.label("");
            (0..judged.len()).for_each(|side| {
                ui.label(RichText::new(SIDE_NAMES[side]).color(readable(ui, side)).strong());
            });
            ui.end_row();
            let names =
                judged.iter().flatten().next().map_or_else(Vec::new, |judged| judged.metrics.iter().map(|(metric, _)| *metric).collect());
            for metric in names {
                ui.label(metric.name());
                for judged in judged {
                    let value = judged.and_then(|judged| judged.metrics.iter().find(|(known, _)| *known == metric));
                    ui.label(RichText::new(value.map_or_else(String::new, |(_, value)| format!("{value:.4e}"))).monospace());
                }
                ui.end_row();
            }
            ui.label("samples");
            for side in &self.board.sides {
                ui.label(RichText::new(side.picture.as_ref().map_or_else(String::new, |picture| picture.samples.to_string())).monospace());
            }
            ui.end_row();
        });
    }
}

/// Where both are above zero.
fn logarithms(curve: &[Point]) -> Vec<[f64; 2]> {
    let drawable = |point: &&Point| point.seconds > 0.0 && point.rel_mse > 0.0;
    curve.iter().filter(drawable).map(|point| [point.seconds.log10(), point.rel_mse.log10()]).collect()
}

/// The ratio of errors at the latest time that both have reached.
fn at_equal_time(a: &[Point], b: &[Point]) -> Option<(f64, f64)> {
    let seconds = a.last()?.seconds.min(b.last()?.seconds);
    let error = |curve: &[Point]| curve.iter().rfind(|point| point.seconds <= seconds).map(|point| point.rel_mse);
    let (a, b) = (error(a)?, error(b)?);
    (a > 0.0 && b > 0.0).then_some((seconds, a / b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_compared_when_both_have_spent_as_much() {
        let curve = |scale: f64, points: u32| {
            (1..=points).map(|i| Point { seconds: f64::from(i), rel_mse: scale / f64::from(i), samples: 0 }).collect::<Vec<_>>()
        };
        assert_eq!(at_equal_time(&curve(4.0, 10), &curve(1.0, 20)), Some((10.0, 4.0)));
        assert_eq!(at_equal_time(&curve(4.0, 10), &[]), None);
        assert_eq!(
            logarithms(&[Point { seconds: 0.0, rel_mse: 1.0, samples: 1 }, Point { seconds: 10.0, rel_mse: 0.01, samples: 1 }]),
            [[1.0, -2.0]]
        );
    }
}
