//! A report in a few lines for people.

use aquifer_lab::compare::{
    judge,
    report::{Cell, Explained, Made, Report, SceneResult, Share},
    summary::Summary,
};
use aquifer_render::Clock;

/// Who held the watch, as reports say it.
pub fn clock(clock: Clock) -> &'static str {
    match clock {
        Clock::Timestamps => "timestamps",
        Clock::Wall => "wall",
    }
}

/// Verdicts first, then the table of every scene.
pub fn report(report: &Report) -> String {
    let mut lines = Vec::new();
    for scene in &report.scenes {
        lines.push(format!("{}, {}×{}, {}", scene.name, scene.size[0], scene.size[1], scene.camera));
        lines.extend(scene.pairs.iter().map(|pair| format!("  {}", pair.sentence)));
        lines.extend(table(report, scene));
        lines.extend(front(report, scene));
        lines.extend(equal_error(scene));
        lines.extend(scene.explained.iter().flat_map(|explained| explanation(report, explained)));
        lines.push(String::new());
    }
    lines.extend(aquifer_lab::page::biases(report));
    lines.push(format!("times by {} on {}", report.made.clock, report.made.adapter));
    lines.join("\n")
}

/// What the measuring itself cost.
pub fn overhead(made: &Made, page_seconds: f64) -> String {
    let lab = made.lab_seconds + page_seconds;
    let share = 100.0 * lab / made.measured_seconds.max(f64::MIN_POSITIVE);
    format!("{:.1} s of rendering measured; films, errors, statistics and the page took {lab:.1} s, {share:.1} %", made.measured_seconds)
}

/// Who is on the Pareto front, where more than two could be.
fn front(report: &Report, scene: &SceneResult) -> Option<String> {
    let names = judge::front(&scene.cells).into_iter().map(|cell| {
        let cell = &scene.cells[cell];
        format!("{} ({:.3} ms)", report.graphs[cell.graph].name, cell.time_ms.median)
    });
    (scene.cells.len() > 2).then(|| format!("  beaten by none in both error and time: {}", names.collect::<Vec<_>>().join(", ")))
}

fn equal_error(scene: &SceneResult) -> Vec<String> {
    let Some(found) = &scene.equal_error else { return Vec::new() };
    let head = format!("  mean square error {:.3e}:", found.mse);
    std::iter::once(head).chain(found.reaches.iter().map(|reach| format!("    {}", reach.sentence))).collect()
}

/// The bias of a graph by its switches.
fn explanation(report: &Report, explained: &Explained) -> Vec<String> {
    let share = |share: &Option<Share>| match share {
        Some(share) => format!("{:+.2} ± {:.2} %", 100.0 * share.mean_difference, 100.0 * share.mean_error),
        None => "cannot be told".to_owned(),
    };
    let mut lines = vec![
        format!("  bias of {}, mean against the reference:", report.graphs[explained.graph].name),
        format!("    as written {}, all off {}", share(&Some(explained.all_on.clone())), share(&explained.all_off)),
    ];
    for switch in &explained.switches {
        let how = switch.setting.as_deref().map_or("no setting turns it off".to_owned(), |setting| format!("off: {setting}"));
        lines.push(format!("    alone {}, without it {}: {} ({how})", share(&switch.alone), share(&switch.without), switch.what));
    }
    lines
}

fn table(report: &Report, scene: &SceneResult) -> Vec<String> {
    let width = report.graphs.iter().map(|graph| graph.name.chars().count()).max().unwrap_or(0);
    let head =
        format!("  {:width$}  {:>24}  {:>11}  {:>24}  {:>34}  {:>10}", "graph", "in the time of", "ms", "runs", "MSE (95 %)", "relMSE");
    let row = |cell: &Cell| {
        let of = match (cell.budget_of, cell.budget_ms) {
            (Some(of), _) => report.graphs[of].name.clone(),
            (None, Some(ms)) => format!("{ms} ms"),
            (None, None) => "its own".to_owned(),
        };
        let rel_mse = cell.rel_mse.as_ref().map_or("undefined".to_owned(), |error| format!("{:.3e}", error.median));
        let name = &report.graphs[cell.graph].name;
        format!("  {name:width$}  {of:>24}  {:>11.3}  {:>24}  {:>34}  {rel_mse:>10}", cell.time_ms.median, runs(cell), interval(&cell.mse))
    };
    std::iter::once(head).chain(scene.cells.iter().map(row)).collect()
}

fn interval(summary: &Summary) -> String {
    let ends = summary.interval.map(|[low, high]| format!(" ({low:.3e} to {high:.3e})")).unwrap_or_default();
    format!("{:.3e}{ends}", summary.median)
}

/// `2.4 frames`, or `12.3 at the knob`.
fn runs(cell: &Cell) -> String {
    let mean = |value: &dyn Fn(&aquifer_lab::compare::report::Variant) -> f64| -> f64 {
        cell.variants.iter().map(|variant| variant.weight * value(variant)).sum()
    };
    let frames = mean(&|variant| f64::from(variant.frames));
    match cell.variants.first().and_then(|variant| variant.knob) {
        Some(_) if frames > 1.0 => format!("{frames:.0} frames, knob {:.2}", mean(&|variant| variant.knob.unwrap_or(0.0))),
        Some(_) => format!("knob {:.2}", mean(&|variant| variant.knob.unwrap_or(0.0))),
        None => format!("{frames:.2} frames"),
    }
}
