//! Extreme and stiff cases: a few of them run, a planted bug is found, and the lists of graphs that do not pass are what the evidence says.

use aquifer_graph::{Document, Shelf};
use aquifer_lab::stress::{self, Bench, Effort, Outcome, Row};
use aquifer_tests::{context, scene};
use serde_json::Value;
use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

const EFFORT: Effort = Effort { seeds: [4, 32], truth: 256 };

fn document(graph: &str) -> Document {
    let files = Shelf::new("built-in", aquifer_graphs::files());
    Document::load(&format!("{graph}.toml"), &files).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The rows of a case; nothing without an adapter.
fn rows(case: &str, graphs: &[&str], shaders: &[PathBuf]) -> Vec<Row> {
    let Some(context) = context() else { return Vec::new() };
    let case = stress::by_name(case).expect("it is in the list");
    let baseline = document("path_tracer");
    let mut bench = Bench::new(&context, case, &baseline, EFFORT, shaders);
    let row = |graph: &&str| bench.run(graph, &document(graph)).unwrap_or_else(|error| panic!("{error}")).0;
    graphs.iter().map(row).inspect(|row| eprintln!("{}", row.sentence())).collect()
}

#[test]
fn a_few_cases_do_what_they_should() {
    let cases = [
        ("far_1e6", &["path_tracer", "restir_di_unbiased"][..]),
        ("scaled_down", &["restir_di_unbiased"]),
        ("one_pixel", &["restir_full"]),
        ("black", &["restir_gi_unbiased"]),
        ("no_light", &["restir_full"]),
        ("nan_texels", &["path_tracer"]),
        ("4k", &["path_tracer"]),
        ("camera_cut", &["restir_di_unbiased"]),
    ];
    for (case, graphs) in cases {
        for row in rows(case, graphs, &[]) {
            assert!(row.is_good(), "{}", row.sentence());
        }
    }
}

#[test]
fn a_step_that_does_not_scale_with_the_scene_is_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let text =
        aquifer_passes::library().text("scene/ray").expect("a module").replace("RELATIVE_ERROR * max(size, max3(abs(point)))", "1e-2");
    std::fs::create_dir(folder.path().join("scene"))
        .and_then(|()| std::fs::write(folder.path().join("scene/ray.wgsl"), text))
        .expect("a file");
    for row in rows("scaled_down", &["path_tracer"], &[folder.path().to_owned()]) {
        assert_eq!(row.outcome, Outcome::Failed, "{}", row.sentence());
    }
}

/// Every pass of resampling, of direct and of indirect light.
#[test]
fn a_thousand_frames_neither_drift_nor_grow() {
    let Some(context) = context() else { return };
    let run = stress::long(&context, &scene("cornell"), ("restir_full", &document("restir_full")), [32, 18], 1000);
    let run = run.unwrap_or_else(|error| panic!("{error}")).expect("it has history");
    assert!(run.is_good(), "{}", run.sentence());
}

/// (case, graph).
type Pair = (String, String);

fn evidence() -> Vec<Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/evidence/stress.json");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let all: Value = serde_json::from_str(&text).expect("the evidence is JSON");
    all["rows"].as_array().expect("rows").clone()
}

#[test]
fn the_lists_of_graphs_that_do_not_pass_are_right_both_ways() {
    let text = |row: &Value, key: &str| row[key].as_str().unwrap_or_default().to_owned();
    let pair = |row: &Value| (text(row, "case"), text(row, "graph"));
    let is_good = |row: &Value| ["passed", "limited", "refused"].contains(&text(row, "outcome").as_str());
    let rows = evidence();
    let measured: BTreeSet<Pair> = rows.iter().map(pair).collect();
    assert!(stress::all().all(|case| measured.iter().any(|(name, _)| name == case.name)), "a case was not measured");
    let found: BTreeSet<Pair> = rows.iter().filter(|row| !is_good(row)).map(pair).collect();
    let of_case = |case: &'static stress::Case| case.known.iter().map(|known| (case.name.to_owned(), known.graph.to_owned()));
    let listed: BTreeSet<Pair> = stress::all().flat_map(of_case).collect();
    assert_eq!(found, listed);
}
