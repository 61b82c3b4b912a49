//! Graph files: whatever the text, faults that can be read or a graph that can be planned.

#![no_main]

#[path = "../../framework/graph/tests/fake/mod.rs"]
mod fake;

use aquifer_graph::{Document, Graph, NeedsAll, Shelf, Source};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let document = match Document::parse(Source::new("fuzz.toml", text), &Shelf::default()) {
        Ok(document) => document,
        Err(faults) => return assert!(!faults.to_string().is_empty()),
    };
    match Graph::check(&document, &fake::Fakes) {
        Err(faults) => assert!(!faults.to_string().is_empty()),
        Ok(graph) => {
            graph.to_json();
            graph.bias();
            if let Ok(plan) = graph.plan(&NeedsAll, &[]) {
                assert!(!plan.steps.is_empty());
            }
        }
    }
});
