//! The numbers for people.

use super::{AreaReport, Report};
use aquifer_lab::metrics::{Measured, Metric};

/// A block for every area, and the verdict.
pub(super) fn of(report: &Report, agreement: &str) -> String {
    let mut text: String = report.areas.iter().map(area).collect();
    text.push_str(&format!("agreement: {agreement}"));
    text
}

fn area(area: &AreaReport) -> String {
    let mean = area.mean_difference.map_or("undefined".to_owned(), |share| format!("{:+.3} %", 100.0 * share));
    let mut text = format!("{}: {} pixels, mean {mean}\n", area.name, area.pixels);
    if area.not_finite > 0 {
        text.push_str(&format!("  {} pixels are infinite or not a number, and with them every metric that they reach\n", area.not_finite));
    }
    text.push_str(&format!("  {:<11} {:>11} {:>11} {:>11} {:>11}\n", "", "value", "red", "green", "blue"));
    for metric in Metric::all() {
        text.push_str(&line(metric, area.metrics[metric.key()].as_ref()));
    }
    text.push('\n');
    text
}

fn line(metric: Metric, measured: Option<&Measured>) -> String {
    let Some(measured) = measured else {
        return format!("  {:<11} {:>11} (the reference is black)\n", metric.name(), "undefined");
    };
    let mut text = format!("  {:<11} {:>11}", metric.name(), number(metric, measured.value));
    for channel in measured.channels.into_iter().flatten() {
        text.push_str(&format!(" {:>11}", number(metric, channel)));
    }
    match measured.reference_variance {
        Some(0.0) => text.push_str("  (the reference taken as exact)"),
        Some(variance) => text.push_str(&format!("  ({:.4e} less the reference's variance {variance:.4e})", measured.raw)),
        None => {}
    }
    text.push('\n');
    text
}

fn number(metric: Metric, value: f64) -> String {
    match metric {
        Metric::Psnr => format!("{value:.2} dB"),
        Metric::FlipLdr | Metric::FlipHdr => format!("{value:.5}"),
        _ => format!("{value:.4e}"),
    }
}
