//! What `check` says of graphs of reuse: bias by line, and reservoirs whose targets differ in visibility kept apart. No adapter is needed.

use aquifer_graph::{Document, Graph, Shelf, Source};

/// The graph with some settings, or the faults as people read them.
fn check(graph: &str, settings: &[&str]) -> Result<Graph, String> {
    let registry = aquifer_passes::registry(aquifer_passes::library(), None).expect("the tree's shaders are whole");
    let text = format!("extends = '{graph}.toml'");
    let document = Document::parse(Source::new("test.toml", text), &Shelf::new("", aquifer_graphs::files()));
    let mut document = document.map_err(|faults| faults.to_string())?;
    document.apply(settings.iter().map(|text| Source::new("--set", *text))).map_err(|faults| faults.to_string())?;
    Graph::check(&document, &registry).map_err(|faults| faults.to_string())
}

#[test]
fn graphs_are_labelled() {
    for (graph, settings, biased) in [
        ("light_sampling", &["shade.slots.domain=di"][..], false),
        ("ris_only", &["initial.candidates=8"], false),
        ("restir_di", &["slots.visibility=in_target"], true),
        ("restir_di", &["slots.mis=balance"], true),
        ("restir_di_unbiased", &["slots.mis=contribution"], false),
        ("restir_di_unbiased", &["slots.visibility=at_shading"], false),
        ("restir_di_unbiased", &["spatial.slots.mis=constant"], true),
        ("restir_di_unbiased", &["initial.bsdf_rays=2"], false),
        ("restir_di_unbiased", &["initial.bsdf_rays=2", "slots.visibility=at_shading"], true),
        ("restir_di_unbiased", &["temporal.permute=true", "spatial.pattern=even"], false),
        ("restir_di_unbiased", &["temporal.history_world=now"], true),
        ("restir_di_unbiased", &["slots.visibility=untested"], true),
        ("restir_di_regir", &["slots.mis=pairwise"], true),
        ("restir_di_regir", &["slots.mis=pairwise", "slots.visibility=in_target"], false),
        ("restir_gi", &["slots.mis=balance"], true),
        ("restir_gi_unbiased", &["slots.domain=gi_path"], false),
        ("restir_gi_unbiased", &["spatial.jacobian=inverted"], true),
        ("restir_gi_unbiased", &["slots.visibility=at_shading"], true),
        ("restir_gi_unbiased", &["initial.validate_every=6"], true),
        ("restir_full", &["spatial.target_of=radiance"], false),
    ] {
        let found = check(graph, settings).unwrap_or_else(|faults| panic!("{faults}"));
        assert_eq!(!found.bias().is_empty(), biased, "{graph} with {settings:?}: {:?}", found.bias());
    }
}

/// A glossy scene is asked only of the domain that takes every point for diffuse.
#[test]
fn facts_of_scenes_bias() {
    for (domain, facts) in
        [("gi", vec!["glossy", "moving_lights", "moving_objects", "normal_maps"]), ("gi_path", vec!["moving_lights", "moving_objects"])]
    {
        let found = check("restir_gi_unbiased", &[&format!("slots.domain={domain}")]).unwrap_or_else(|faults| panic!("{faults}"));
        let given: std::collections::BTreeSet<_> = found.bias_elsewhere().into_iter().filter_map(|finding| finding.given).collect();
        assert_eq!(given.into_iter().collect::<Vec<_>>(), facts, "{domain}");
    }
}

/// What turns a bias off is said beside it, and turns off no other.
#[test]
fn every_switch_is_turned_off_by_itself() {
    for (graph, settings, count) in [
        ("restir_di", &[][..], 2),
        ("restir_gi", &[], 2),
        ("restir_di_unbiased", &["spatial.slots.mis=constant"], 1),
        ("restir_di_unbiased", &["temporal.history_world=now", "slots.visibility=untested"], 2),
        ("restir_gi_unbiased", &["spatial.jacobian=inverted", "initial.validate_every=6", "slots.visibility=at_shading"], 3),
    ] {
        let off = |more: &[String]| -> std::collections::BTreeSet<String> {
            let all: Vec<&str> = settings.iter().copied().chain(more.iter().map(String::as_str)).collect();
            let found = check(graph, &all).unwrap_or_else(|faults| panic!("{graph} with {all:?}: {faults}"));
            found
                .bias()
                .into_iter()
                .map(|finding| finding.without.unwrap_or_else(|| panic!("nothing turns {} off", finding.what)))
                .collect()
        };
        let switches = off(&[]);
        assert_eq!(switches.len(), count, "{graph}: {switches:?}");
        for switch in &switches {
            let rest: Vec<&String> = switches.iter().filter(|other| *other != switch).collect();
            assert_eq!(off(std::slice::from_ref(switch)).iter().collect::<Vec<_>>(), rest, "{graph} without {switch}");
        }
        assert!(off(&switches.into_iter().collect::<Vec<_>>()).is_empty());
    }
}

#[test]
fn a_reader_that_assumes_another_visibility_is_refused() {
    let found = check("restir_di_unbiased", &["initial.slots.visibility=at_shading"]);
    let faults = found.map(|_| "none").expect_err("a reservoir without visibility is wired to a reader that assumes it");
    assert!(faults.contains("slot `visibility` is `at_shading` in `initial` and `in_target` in `temporal`"), "{faults}");
}
