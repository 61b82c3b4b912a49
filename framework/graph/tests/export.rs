//! Graphs as Graphviz text and as JSON, and what the graph alone can tell.

mod fake;

use aquifer_graph::{Document, Graph, NeedsAll, PortId, Shelf, Source};

const GRAPH: &str = r#"
title     = "Said \"so\""
transport = "direct"
output    = "accumulate.mean"
slots     = { domain = "di", proposal = "power" }

[pass.gbuffer]
[pass.initial]
in.surface = "gbuffer.surface"
[pass.shade]
in.surface   = "gbuffer.surface"
in.reservoir = "initial.reservoir"
[pass.blur]
in.color = "shade.color"
[pass.accumulate]
in.color   = "blur.color"
in.history = "accumulate.mean@prev"
[pass.meter]
in.color = "blur.color"
"#;

fn graph(edits: &[&str]) -> Graph {
    let mut document = Document::parse(Source::new("graph.toml", GRAPH), &Shelf::default()).unwrap();
    document.apply(edits.iter().map(|edit| Source::new("--set", *edit))).unwrap();
    Graph::check(&document, &fake::Fakes).unwrap_or_else(|faults| panic!("{faults}"))
}

#[test]
fn graphviz_shows_history_rewriting_and_what_is_culled() {
    let dot = graph(&[]).to_dot();
    for line in [
        r#"label="Said \"so\"\ndirect"; labelloc=t"#,
        r#"n1 [label="initial\ndomain = di\nproposal = power"];"#,
        r#"n5 [label="meter", color=gray, fontcolor=gray];"#,
        r#"n0 -> n1 [label="surface\nSurface", style=""];"#,
        r#"n2 -> n3 [label="color\nvec4<f32>", style="bold"];"#,
        r#"n4 -> n4 [label="mean → history\nvec4<f32>", style="dashed", constraint=false];"#,
        r#"n4 -> output [label="mean"];"#,
    ] {
        assert!(dot.contains(line), "{line}\n{dot}");
    }
}

#[test]
fn json_holds_what_a_graph_file_would_say() {
    let json = graph(&["initial.candidates=8"]).to_json();
    assert_eq!(json["nodes"][1]["params"]["candidates"], 8);
    assert_eq!(json["nodes"][4]["wires"]["history"], "accumulate.mean@prev");
    assert_eq!(json["output"], "accumulate.mean");
    assert_eq!(json["bias"][0]["place"]["line"], 13);
    let plan = graph(&[]).plan(&NeedsAll, &[]).unwrap().to_json();
    assert_eq!(plan["transport"], "direct");
    assert_eq!(plan["left_out"][0]["node"], "meter");
    assert_eq!(plan["resources"][plan["output"].as_u64().unwrap() as usize]["life"], "history");
}

#[test]
fn the_digest_names_the_computation_alone() {
    let digest = graph(&[]).digest();
    assert_eq!(graph(&["title=other", "initial.candidates=32"]).digest(), digest, "32 is the default");
    for edit in ["initial.candidates=33", "transport=full:1", "pass.accumulate.in.color=shade.color", "slots.proposal=uniform"] {
        let edits = if edit.contains("accumulate") { vec![edit, "pass.blur.remove=true", "pass.meter.remove=true"] } else { vec![edit] };
        assert_ne!(graph(&edits).digest(), digest, "{edit}");
    }
}

#[test]
fn history_is_told_by_the_wires() {
    let graph = graph(&[]);
    let port = |node: &str, port: &str| {
        let node = graph.nodes().iter().position(|known| known.name == node).unwrap();
        PortId { node, port: graph.nodes()[node].port_index(port).unwrap() }
    };
    assert!(graph.has_history(port("accumulate", "mean")));
    assert!(graph.has_history(port("accumulate", "history")));
    assert!(!graph.has_history(port("accumulate", "color")));
    assert!(!graph.has_history(port("blur", "color")));
}
