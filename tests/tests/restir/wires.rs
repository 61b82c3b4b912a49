//! What `check` says of graphs of reuse: bias by line, and reservoirs whose targets differ in visibility kept apart. No adapter is needed.

use aquifer_graph::{Document, Graph, Shelf, Source};

/// The graph with one setting, or the faults as people read them.
fn check(graph: &str, setting: &str) -> Result<Graph, String> {
    let registry = aquifer_passes::registry(aquifer_passes::library(), None).expect("the tree's shaders are whole");
    let text = format!("extends = '{graph}.toml'");
    let document = Document::parse(Source::new("test.toml", text), &Shelf::new("", aquifer_graphs::files()));
    let mut document = document.map_err(|faults| faults.to_string())?;
    document.apply([Source::new("--set", setting)]).map_err(|faults| faults.to_string())?;
    Graph::check(&document, &registry).map_err(|faults| faults.to_string())
}

#[test]
fn graphs_are_labelled() {
    for (graph, setting, biased) in [
        ("light_sampling", "shade.slots.domain=di", false),
        ("ris_only", "initial.candidates=8", false),
        ("restir_di", "slots.visibility=in_target", true),
        ("restir_di", "slots.mis=balance", true),
        ("restir_di_unbiased", "slots.mis=contribution", false),
        ("restir_di_unbiased", "slots.visibility=at_shading", false),
        ("restir_di_unbiased", "spatial.slots.mis=constant", true),
    ] {
        let found = check(graph, setting).unwrap_or_else(|faults| panic!("{faults}"));
        assert_eq!(!found.bias().is_empty(), biased, "{graph} with {setting}: {:?}", found.bias());
    }
}

#[test]
fn a_reader_that_assumes_another_visibility_is_refused() {
    let found = check("restir_di_unbiased", "initial.slots.visibility=at_shading");
    let faults = found.map(|_| "none").expect_err("a reservoir without visibility is wired to a reader that assumes it");
    assert!(faults.contains("slot `visibility` is `at_shading` in `initial` and `in_target` in `temporal`"), "{faults}");
}
