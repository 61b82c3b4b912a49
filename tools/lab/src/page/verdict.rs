//! The result in words.

use super::words::{number, signed_percent};
use crate::{
    compare::{
        judge,
        report::{Better, BiasFigures, BiasVerdict, Cell, Pair, Ratio, Reach, Report, SceneResult},
    },
    stats::{Difference, multiple::holm},
};
use serde::Serialize;

/// Chance that a page calls any graph biased that is not.
const FAMILY_ALPHA: f64 = 0.05;
/// More verdicts than these are told in a list, under one word on all of them.
const MOST_LEADS: usize = 3;

/// What is said of one graph.
#[derive(Debug, Serialize)]
pub(super) struct Verdict {
    pub(super) lead: String,
    pub(super) sentences: Vec<Item>,
}

/// A marked sentence.
#[derive(Debug, Serialize)]
pub(super) struct Item {
    kind: &'static str,
    mark: &'static str,
    text: String,
}

/// One verdict for every graph but the baseline; of a baseline alone, its own; then what is known of its bias.
pub(super) fn of(report: &Report) -> Vec<Verdict> {
    let graphs = 0..report.graphs.len();
    if report.scenes.iter().all(|scene| scene.cells.is_empty()) {
        return vec![Verdict { lead: "Nothing was measured.".into(), sentences: vec![] }];
    }
    let mut verdicts: Vec<Verdict> = match report.graphs.len() > MOST_LEADS + 1 {
        true => vec![many(report)],
        false => graphs.clone().skip(1).map(|graph| Verdict { lead: lead(report, graph), sentences: sentences(report, graph) }).collect(),
    };
    if verdicts.is_empty() {
        verdicts.push(Verdict { lead: alone(report), sentences: vec![] });
    }
    if let Some(last) = verdicts.last_mut() {
        last.sentences.extend(report.scenes.iter().flat_map(equal_error));
        last.sentences.extend(graphs.filter_map(|graph| bias(report, graph)));
    }
    verdicts
}

/// What is known of the bias of each graph, in words.
pub(super) fn biases(report: &Report) -> Vec<String> {
    (0..report.graphs.len()).filter_map(|graph| bias(report, graph)).map(|item| format!("{}: {}", item.mark, item.text)).collect()
}

/// The pair that is spoken of: the first of the graph in the scene.
pub(super) fn pair(scene: &SceneResult, graph: usize) -> Option<&Pair> {
    scene.pairs.iter().find(|pair| scene.cells.get(pair.other).is_some_and(|cell| cell.graph == graph))
}

/// What was judged: the ratio of errors, or of error × time where times differ.
pub(super) fn ratio(pair: &Pair) -> Ratio {
    if pair.equal_time { pair.mse } else { pair.mse_time }
}

/// How a pair is marked.
pub(super) fn kind(better: Better) -> (&'static str, &'static str) {
    match better {
        Better::Other => ("better", "less error"),
        Better::Baseline => ("worse", "more error"),
        Better::NotResolved => ("open", "not resolved"),
    }
}

fn lead(report: &Report, graph: usize) -> String {
    let (name, baseline) = (&report.graphs[graph].name, &report.graphs[0].name);
    let pairs: Vec<&Pair> = report.scenes.iter().filter_map(|scene| pair(scene, graph)).collect();
    let (less, more) = (count(&pairs, Better::Other), count(&pairs, Better::Baseline));
    let open = pairs.len() - less - more;
    match pairs.as_slice() {
        [] => return format!("`{name}` was not held against `{baseline}`."),
        [only] if !only.sentence.is_empty() => return format!("{}.", only.sentence),
        _ if less + more == 0 => {
            return format!("Between `{name}` and `{baseline}` no difference of error can be shown on {}.", scenes(pairs.len()));
        }
        _ => {}
    }
    let mean = (pairs.iter().map(|pair| ratio(pair).value.ln()).sum::<f64>() / pairs.len() as f64).exp();
    let (factor, word) = if mean >= 1.0 { (mean, "lower") } else { (1.0 / mean, "higher") };
    let measure = if pairs.iter().all(|pair| pair.equal_time) { "mean square error at equal time" } else { "mean square error × time" };
    let split = match (less, more, open) {
        (_, 0, 0) => "lower on each".to_owned(),
        (0, _, 0) => "higher on each".to_owned(),
        _ => [(less, "lower"), (more, "higher"), (open, "not resolved")]
            .iter()
            .filter(|(n, _)| *n > 0)
            .map(|(n, word)| format!("{word} on {n}"))
            .collect::<Vec<_>>()
            .join(", "),
    };
    format!(
        "`{name}` has {} times {word} {measure} than `{baseline}` (geometric mean of {}; {split}).",
        number(factor),
        scenes(pairs.len())
    )
}

fn count(pairs: &[&Pair], better: Better) -> usize {
    pairs.iter().filter(|pair| pair.better == better).count()
}

fn scenes(n: usize) -> String {
    if n == 1 { "1 scene".into() } else { format!("{n} scenes") }
}

/// A sentence for every scene, unless the lead is that sentence already.
fn sentences(report: &Report, graph: usize) -> Vec<Item> {
    let pairs: Vec<(&SceneResult, &Pair)> = report.scenes.iter().filter_map(|scene| Some((scene, pair(scene, graph)?))).collect();
    if pairs.len() == 1 {
        return vec![];
    }
    pairs.into_iter().map(|(scene, pair)| item(scene, pair)).collect()
}

fn item(scene: &SceneResult, pair: &Pair) -> Item {
    let (kind, mark) = kind(pair.better);
    Item { kind, mark, text: format!("{}: {}", scene.name, pair.sentence) }
}

/// Of many graphs, as in a sweep: who is beaten by none, and every pair in the list.
fn many(report: &Report) -> Verdict {
    let front = |scene: &SceneResult| {
        let names = judge::front(&scene.cells).into_iter().map(|cell| format!("`{}`", report.graphs[scene.cells[cell].graph].name));
        format!("{} on {}", names.collect::<Vec<_>>().join(", "), scene.name)
    };
    let fronts: Vec<String> = report.scenes.iter().map(front).collect();
    let sentences = report.scenes.iter().flat_map(|scene| scene.pairs.iter().map(|pair| item(scene, pair))).collect();
    Verdict {
        lead: format!("Of {} graphs, none beats these in both error and time: {}.", report.graphs.len(), fronts.join("; ")),
        sentences,
    }
}

/// Who reaches the same error sooner.
fn equal_error(scene: &SceneResult) -> Vec<Item> {
    let Some(found) = &scene.equal_error else { return vec![] };
    let item = |reach: &Reach| {
        let interval = reach.speed_up?.interval;
        let (kind, mark) = match interval {
            Some([low, _]) if low > 1.0 => ("better", "sooner"),
            Some([_, high]) if high < 1.0 => ("worse", "later"),
            _ => ("open", "not resolved"),
        };
        Some(Item { kind, mark, text: format!("{}, MSE {}: {}", scene.name, number(found.mse), reach.sentence) })
    };
    found.reaches.iter().filter_map(item).collect()
}

fn alone(report: &Report) -> String {
    let name = report.graphs.first().map_or("The graph", |graph| graph.name.as_str());
    let said = report.scenes.iter().filter_map(|scene| scene.cells.first().map(|cell| (scene, cell)));
    let said = said.map(|(scene, cell)| format!("{} in {} ms on {}", error(cell), number(cell.time_ms.median), scene.name));
    format!("`{name}`: {}.", said.collect::<Vec<_>>().join("; "))
}

fn error(cell: &Cell) -> String {
    match &cell.rel_mse {
        Some(rel_mse) => format!("relMSE {}", number(rel_mse.median)),
        None => format!("MSE {}", number(cell.mse.median)),
    }
}

/// How a bias verdict is marked.
pub(super) fn bias_kind(verdict: BiasVerdict) -> (&'static str, &'static str) {
    match verdict {
        BiasVerdict::Unbiased => ("unbiased", "unbiased"),
        BiasVerdict::Biased => ("biased", "biased"),
        BiasVerdict::NotResolved => ("open", "bias not resolved"),
    }
}

/// What is known of one graph's bias over all scenes. One scene on which it is shown is enough; but a page of many scenes and graphs makes many
/// tests, and the chance that it calls any graph biased that is not stays 5 % (Holm).
fn bias(report: &Report, graph: usize) -> Option<Item> {
    let own: Vec<(&SceneResult, &BiasFigures)> = report.scenes.iter().filter_map(|scene| Some((scene, figures(scene, graph)?))).collect();
    let rest = (0..report.graphs.len()).filter(|&other| other != graph);
    let others = rest.flat_map(|other| report.scenes.iter().filter_map(move |scene| figures(scene, other)));
    let p: Vec<f64> = own.iter().map(|(_, figures)| *figures).chain(others).map(chance).collect();
    let shown = holm(&p, FAMILY_ALPHA)[..own.len()].contains(&true);
    let none = own.iter().all(|(_, figures)| figures.verdict == BiasVerdict::Unbiased);
    let (kind, mark) = bias_kind(match (shown, none) {
        _ if own.is_empty() => return None,
        (true, _) => BiasVerdict::Biased,
        (false, true) => BiasVerdict::Unbiased,
        (false, false) => BiasVerdict::NotResolved,
    });
    let name = &report.graphs[graph].name;
    let said = own.iter().map(|(scene, figures)| format!("{} {}", scene.name, mean(figures.mean_difference, figures.mean_error)));
    Some(Item { kind, mark, text: format!("`{name}`, mean against the reference: {}.", said.collect::<Vec<_>>().join(", ")) })
}

/// Of such a difference of means where there is no bias beyond the band.
fn chance(figures: &BiasFigures) -> f64 {
    let freedom = figures.seeds.saturating_sub(1).max(1) as f64;
    Difference { value: figures.mean_difference, standard_error: figures.mean_error, freedom }.p_outside(figures.band)
}

/// The bias figures of the graph's first cell that has some.
fn figures(scene: &SceneResult, graph: usize) -> Option<&BiasFigures> {
    scene.cells.iter().filter(|cell| cell.graph == graph).find_map(|cell| cell.bias.as_ref())
}

/// A mean with its standard error.
pub(super) fn mean(difference: f64, error: f64) -> String {
    format!("{} ± {} %", signed_percent(difference).trim_end_matches(" %"), number(100.0 * error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::report::GraphFacts;

    fn report(results: &[(f64, Better)]) -> Report {
        let graph = |name: &str| GraphFacts { name: name.into(), ..GraphFacts::default() };
        let scene = |(i, &(value, better)): (usize, &(f64, Better))| SceneResult {
            name: format!("scene{i}"),
            cells: vec![Cell::default(), Cell { graph: 1, ..Cell::default() }],
            pairs: vec![Pair {
                other: 1,
                mse: Ratio { value, interval: None },
                better,
                equal_time: true,
                sentence: format!("{value}"),
                ..Pair::default()
            }],
            ..SceneResult::default()
        };
        Report { graphs: vec![graph("old"), graph("new")], scenes: results.iter().enumerate().map(scene).collect(), ..Report::default() }
    }

    #[test]
    fn leads() {
        let lead = |results: &[(f64, Better)]| of(&report(results)).remove(0).lead;
        assert_eq!(
            lead(&[(2.0, Better::Other), (8.0, Better::Other)]),
            "`new` has 4.00 times lower mean square error at equal time than `old` (geometric mean of 2 scenes; lower on each)."
        );
        assert_eq!(
            lead(&[(0.25, Better::Baseline), (1.0, Better::NotResolved)]),
            "`new` has 2.00 times higher mean square error at equal time than `old` (geometric mean of 2 scenes; higher on 1, not resolved on 1)."
        );
        assert_eq!(
            lead(&[(1.1, Better::NotResolved), (0.9, Better::NotResolved)]),
            "Between `new` and `old` no difference of error can be shown on 2 scenes."
        );
        assert_eq!(lead(&[(3.0, Better::Other)]), "3.");
        assert_eq!(lead(&[]), "Nothing was measured.");
    }

    #[test]
    fn many_graphs_have_one_lead() {
        let mut report = report(&[(2.0, Better::Other)]);
        let graph = |name: &str| GraphFacts { name: name.into(), ..GraphFacts::default() };
        report.graphs = ["a", "b", "c", "d", "e"].map(graph).to_vec();
        let found = of(&report);
        assert_eq!((found.len(), found[0].sentences.len()), (1, 1));
        assert_eq!(found[0].lead, "Of 5 graphs, none beats these in both error and time: `a`, `b` on scene0.");
        assert_eq!(found[0].sentences[0].text, "scene0: 2");
    }

    #[test]
    fn one_scene_on_which_bias_is_shown_is_enough() {
        let word = |errors: [f64; 2]| {
            let mut report = report(&[(2.0, Better::Other), (2.0, Better::Other)]);
            for (scene, mean_error) in errors.into_iter().enumerate() {
                let verdict = if mean_error > 0.1 { BiasVerdict::Unbiased } else { BiasVerdict::Biased };
                let figures = BiasFigures { seeds: 16, verdict, mean_difference: -0.02, mean_error, band: 0.002, ..BiasFigures::default() };
                report.scenes[scene].cells[1].bias = Some(figures);
            }
            let mut items = of(&report).remove(0).sentences;
            assert_eq!(items.len(), 3);
            items.remove(2)
        };
        let shown = word([0.001, 1.0]);
        assert_eq!(
            (shown.kind, shown.text.as_str()),
            ("biased", "`new`, mean against the reference: scene0 −2.00 ± 0.100 %, scene1 −2.00 ± 100 %.")
        );
        // Alone this would do: t = 2.1, p = 0.03. Of two tests it may be chance.
        assert_eq!(word([0.0085, 1.0]).kind, "open");
    }
}
