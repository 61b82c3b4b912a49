//! `results.csv`: one line a graph, scene and budget, for spreadsheets and scripts. Undefined numbers are empty.

use crate::{
    compare::{report::Report, summary::Summary},
    metrics::Metric,
};

/// The whole table.
pub(super) fn csv(report: &Report) -> String {
    let further: Vec<Metric> = Metric::all().filter(|metric| !matches!(metric, Metric::Mse | Metric::RelMse)).collect();
    let mut head: Vec<String> = ["scene", "graph", "transport", "width", "height", "budget_ms", "seeds"].map(String::from).to_vec();
    for name in ["time_ms", "mse", "rel_mse"].into_iter().chain(further.iter().map(|metric| metric.key())) {
        head.extend([name.to_owned(), format!("{name}_low"), format!("{name}_high")]);
    }
    head.extend(["bias_squared", "variance", "mean_difference", "bias_verdict"].map(String::from));
    let mut lines = vec![head];
    for scene in &report.scenes {
        for cell in &scene.cells {
            let graph = report.graphs.get(cell.graph);
            let mut line = vec![
                scene.name.clone(),
                graph.map_or(String::new(), |graph| graph.name.clone()),
                graph.map_or(String::new(), |graph| graph.transport.clone()),
                scene.size[0].to_string(),
                scene.size[1].to_string(),
                number(cell.budget_ms),
                cell.mse.values.len().to_string(),
            ];
            let standard = [Some(&cell.time_ms), Some(&cell.mse), cell.rel_mse.as_ref()];
            let summaries = standard.into_iter().chain(further.iter().map(|metric| cell.metrics.get(metric.key())));
            line.extend(summaries.flat_map(with_interval));
            line.extend(match &cell.bias {
                Some(bias) => [bias.bias_squared, bias.variance, bias.mean_difference].map(|x| number(Some(x))).to_vec(),
                None => vec![String::new(); 3],
            });
            line.push(cell.bias.as_ref().map_or(String::new(), |bias| word(&bias.verdict)));
            lines.push(line);
        }
    }
    lines.iter().map(|line| line.iter().map(|field| quoted(field)).collect::<Vec<_>>().join(",") + "\n").collect()
}

fn with_interval(summary: Option<&Summary>) -> [String; 3] {
    let interval = summary.and_then(|summary| summary.interval);
    [number(summary.map(|summary| summary.median)), number(interval.map(|i| i[0])), number(interval.map(|i| i[1]))]
}

fn number(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or(String::new(), |value| value.to_string())
}

/// As `report.json` writes it.
fn word(value: &impl serde::Serialize) -> String {
    serde_json::to_value(value).ok().and_then(|value| value.as_str().map(String::from)).unwrap_or_default()
}

/// RFC 4180.
fn quoted(field: &str) -> String {
    match field.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", field.replace('"', "\"\"")),
        false => field.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::report::{BiasFigures, Cell, GraphFacts, SceneResult};

    #[test]
    fn a_line_a_cell() {
        let cell = Cell {
            mse: Summary { median: 0.5, interval: Some([0.25, 1.0]), values: vec![0.5; 4] },
            bias: Some(BiasFigures::default()),
            ..Cell::default()
        };
        let report = Report {
            graphs: vec![GraphFacts { name: "a, \"b\"".into(), ..GraphFacts::default() }],
            scenes: vec![SceneResult { name: "cornell".into(), cells: vec![cell], ..SceneResult::default() }],
            ..Report::default()
        };
        let text = csv(&report);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 2);
        assert!(
            lines[0].contains(",mse,mse_low,mse_high,rel_mse,")
                && lines[0].ends_with("flip_hdr_high,bias_squared,variance,mean_difference,bias_verdict")
        );
        assert!(lines[1].starts_with("cornell,\"a, \"\"b\"\"\",,0,0,,4,0,,,0.5,0.25,1,,,"), "{}", lines[1]);
        assert!(lines[1].ends_with(",0,0,0,not_resolved"));
        assert_eq!(lines[1].replace("\"a, \"\"b\"\"\"", "a").split(',').count(), lines[0].split(',').count());
    }
}
