//! The rows of `aquifer stress`, a process for each case or long run: lavapipe keeps memory of every dispatch (docs/limits.md).
//!
//! ```text
//! cargo run -p aquifer-tests --example stress_evidence -- stress PROGRAM FILE COMMIT DATE [CASE[:GRAPH] …]
//! cargo run -p aquifer-tests --example stress_evidence -- long PROGRAM FILE COMMIT DATE [GRAPH …]
//! ```
//!
//! Resumable: what FILE has is not run again, unless a graph is named. `:GRAPH` is that graph in every case.

use aquifer_tests::{context, evidence::Evidence};
use serde_json::{Value, json};
use std::process::{Command, Stdio};

/// Of the long runs: frames, and graphs where none are named.
const FRAMES: &str = "10000";
const GRAPHS: [&str; 3] = ["restir_di_unbiased", "restir_gi_validated", "restir_full"];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [item, program, file, commit, date, named @ ..] = &arguments[..] else {
        eprintln!("stress_evidence stress|long PROGRAM FILE COMMIT DATE [CASE[:GRAPH]|GRAPH …]");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let long = item == "long";
    let every: Vec<&str> = if long { GRAPHS.to_vec() } else { aquifer_lab::stress::all().map(|case| case.name).collect() };
    let wanted: Vec<&str> = if named.is_empty() { every.clone() } else { named.iter().map(String::as_str).collect() };
    let mut evidence = Evidence::open(file, commit, date, &context);
    let in_every_case = |name: &&str| {
        let cases = if name.starts_with(':') { every.clone() } else { vec![""] };
        cases.into_iter().map(|case| format!("{case}{name}")).collect::<Vec<_>>()
    };
    for name in wanted.iter().flat_map(in_every_case) {
        let (name, graph) = name.split_once(':').map_or((name.as_str(), None), |(name, graph)| (name, Some(graph)));
        let (key, mut options) = if long { ("graph", vec!["--long", FRAMES, name]) } else { ("case", vec!["--case", name]) };
        if graph.is_none() && evidence.rows().any(|row| row[key] == name) {
            continue;
        }
        options.splice(0..0, graph);
        for row in measured(program, &options) {
            evidence.put(json!({ "case": row["case"], "graph": row["graph"] }), row);
        }
    }
}

/// What `aquifer stress` prints. An exit code of 1 tells of rows that are not as they should be: they belong into the evidence too.
fn measured(program: &str, options: &[&str]) -> Vec<Value> {
    let output = Command::new(program).arg("stress").args(options).arg("--json").stderr(Stdio::inherit()).output();
    let output = output.unwrap_or_else(|error| panic!("{program}: {error}"));
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{options:?}: {error}"))
}
