//! Time of each pass, as bars on one scale and as a table.

use crate::compare::report::{Cell, SceneResult};
use serde::Serialize;

/// The bar of one graph.
#[derive(Debug, Serialize)]
pub(super) struct Bar {
    graph: usize,
    /// Milliseconds of what counts.
    total: f64,
    passes: Vec<Piece>,
}

#[derive(Debug, Serialize)]
struct Piece {
    pass: String,
    ms: f64,
    counted: bool,
    /// Of the longest bar.
    percent: f64,
    /// Number of the colour: the same pass has the same in every bar.
    color: usize,
}

/// A line of the table.
#[derive(Debug, Serialize)]
pub(super) struct Line {
    pass: String,
    counted: bool,
    color: usize,
    /// One a bar.
    ms: Vec<Option<f64>>,
}

/// Bars and lines of the first cell of every graph that was timed by pass.
pub(super) fn of(scene: &SceneResult) -> (Vec<Bar>, Vec<Line>) {
    let mut cells: Vec<&Cell> = Vec::new();
    for cell in scene.cells.iter().filter(|cell| !cell.passes.is_empty()) {
        if !cells.iter().any(|known| known.graph == cell.graph) {
            cells.push(cell);
        }
    }
    let mut names: Vec<(&str, bool)> = Vec::new();
    for pass in cells.iter().flat_map(|cell| &cell.passes) {
        if !names.iter().any(|(name, _)| *name == pass.pass) {
            names.push((&pass.pass, pass.counted));
        }
    }
    let longest = cells.iter().map(|cell| cell.passes.iter().map(|pass| pass.ms).sum::<f64>()).fold(f64::MIN_POSITIVE, f64::max);
    let color = |name: &str| names.iter().position(|(known, _)| *known == name).unwrap_or(0) % 8;
    let bar = |cell: &&Cell| Bar {
        graph: cell.graph,
        total: cell.passes.iter().filter(|pass| pass.counted).map(|pass| pass.ms).sum(),
        passes: cell
            .passes
            .iter()
            .map(|pass| Piece {
                pass: pass.pass.clone(),
                ms: pass.ms,
                counted: pass.counted,
                percent: 100.0 * pass.ms / longest,
                color: color(&pass.pass),
            })
            .collect(),
    };
    let line = |&(name, counted): &(&str, bool)| Line {
        pass: name.to_owned(),
        counted,
        color: color(name),
        ms: cells.iter().map(|cell| cell.passes.iter().find(|pass| pass.pass == name).map(|pass| pass.ms)).collect(),
    };
    (cells.iter().map(bar).collect(), names.iter().map(line).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::report::PassShare;

    #[test]
    fn bars_share_a_scale_and_colours() {
        let pass = |name: &str, ms, counted| PassShare { pass: name.into(), ms, counted };
        let cell = |graph, passes| Cell { graph, passes, ..Cell::default() };
        let scene = SceneResult {
            cells: vec![
                cell(0, vec![pass("trace", 3.0, true), pass("tonemap", 1.0, false)]),
                cell(1, vec![pass("trace", 2.0, true)]),
                cell(1, vec![]),
            ],
            ..SceneResult::default()
        };
        let (bars, lines) = of(&scene);
        assert_eq!((bars.len(), bars[0].total, bars[0].passes[0].percent, bars[1].passes[0].percent), (2, 3.0, 75.0, 50.0));
        assert_eq!(bars[0].passes[0].color, bars[1].passes[0].color);
        assert_eq!((lines.len(), lines[1].ms.as_slice(), lines[1].counted), (2, [Some(1.0), None].as_slice(), false));
    }
}
