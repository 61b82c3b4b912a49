//! Any text taken for a graph: faults that can be read, or a graph that can be planned.

use crate::fake::Fakes;
use aquifer_graph::{Document, Graph, NeedsAll, Shelf, Source};

/// Panics where neither comes of it.
pub fn survives(text: &str) {
    let document = match Document::parse(Source::new("any.toml", text), &Shelf::default()) {
        Ok(document) => document,
        Err(faults) => return assert!(!faults.to_string().is_empty()),
    };
    match Graph::check(&document, &Fakes) {
        Err(faults) => assert!(!faults.to_string().is_empty()),
        Ok(graph) => {
            graph.to_json();
            graph.bias();
            if let Ok(plan) = graph.plan(&NeedsAll, &[]) {
                assert!(!plan.steps.is_empty());
            }
        }
    }
}
