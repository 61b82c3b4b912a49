//! What a scene does not need can be left out without changing any bit; the evidence tier does the same for every graph on every scene.

use aquifer_graph::{Document, Graph, Life, Shelf, Source};
use aquifer_scene::{Channel, Environment, Features, Interpolation, Scene, Track};
use aquifer_tests::{
    Kept, Parts, context,
    leaving_out::{Differs, Pair},
    scene,
};
use std::sync::Arc;

/// Small graphs on scenes whose facts are all different; and each kind of ReSTIR, still and moving.
const PAIRS: [(&str, &str); 9] = [
    ("path_tracer", "cornell"),
    ("path_tracer", "textured"),
    ("path_tracer", "outdoor"),
    ("path_tracer", "point_lights"),
    ("light_sampling", "sun_room"),
    ("restir_di_unbiased", "cornell"),
    ("restir_di", "animated"),
    ("restir_gi_validated", "cornell"),
    ("restir_gi_temporal_only", "animated"),
];

/// Pairs whose shaders the driver compiles to other roundings once branches are gone, with the resource where that shows first.
const ROUNDED: [(&str, &str, &str); 2] =
    [("restir_di_unbiased", "cornell", "initial.reservoir"), ("restir_gi_validated", "cornell", "initial.reservoir")];

fn extending(graph: &str) -> String {
    format!("extends = '{graph}.toml'")
}

#[test]
fn what_is_left_out_changes_no_bit() {
    let Some(context) = context() else { return };
    for (graph, name) in PAIRS {
        let (scene, text) = (scene(name), extending(graph));
        let pair = Pair { scene: &scene, graph: &text };
        assert_eq!(pair.first_difference(&context, Kept::Resources), None, "{graph} on {name}");
        let Some(Differs { resource, ulps }) = pair.first_difference(&context, Kept::All) else { continue };
        assert!(ROUNDED.contains(&(graph, name, &resource)) && ulps <= 4, "{graph} on {name}: {ulps} ulp in {resource}");
        assert!(pair.means_agree(&context, Kept::All), "{graph} on {name}");
    }
}

/// The leaves of `textured`, under a sky, with camera, lamp and objects in motion.
fn full() -> Arc<Scene> {
    let mut scene = (aquifer_scenes::by_name("textured").unwrap().make)();
    scene.environment =
        Some(Environment { name: String::new(), width: 2, height: 1, radiance: vec![[0.5; 3]; 2], world_to_map: Default::default() });
    let slides = |node: usize| {
        let track = Track::Translation(vec![glam::Vec3::ZERO, glam::Vec3::X]);
        Channel { node: node as u32, track, times: vec![0.0, 4.0], interpolation: Interpolation::Linear }
    };
    scene.animation = (0..scene.nodes.len()).map(slides).collect();
    Arc::new(scene.finish().unwrap())
}

fn planned(scene: &Scene, graph: &str) -> aquifer_graph::Plan {
    let registry = aquifer_passes::registry(aquifer_passes::library(), Some(scene)).unwrap();
    let document = Document::parse(Source::new("test.toml", graph), &Shelf::new("", aquifer_graphs::files())).unwrap();
    Graph::check(&document, &registry).unwrap().plan(&registry, &[]).unwrap()
}

#[test]
fn the_fullest_scene_loses_nothing() {
    let scene = full();
    assert_eq!(Features::of(&scene), Features::ALL);
    for (name, text) in aquifer_graphs::files() {
        let plan = planned(&scene, text);
        assert!(plan.left_out.is_empty(), "{name}: {:?}", plan.left_out);
    }
}

#[test]
fn a_still_scene_has_no_motion_and_no_validation() {
    let plan = planned(&scene("cornell"), &extending("restir_gi_validated"));
    let left: Vec<(&str, &str)> = plan.left_out.iter().filter_map(|left| Some((left.node.as_str(), left.port.as_deref()?))).collect();
    let gone = [
        ("gbuffer_traced", "motion"),
        ("initial", "history"),
        ("initial", "motion"),
        ("initial", "previous_surface"),
        ("initial", "stale"),
        ("temporal", "motion"),
        ("temporal", "stale"),
        ("spatial", "motion"),
        ("spatial", "stale"),
    ];
    assert!(gone.iter().all(|port| left.contains(port)) && left.len() == gone.len(), "{left:?}");
    assert!(plan.left_out.iter().all(|left| left.reason.starts_with("the scene has no moving ")), "{:?}", plan.left_out);
    assert!(plan.resources.iter().all(|resource| !resource.name.ends_with(".motion") && !resource.name.ends_with(".stale")));

    // A history whose only reader was validation goes with it.
    let validated = "extends = 'restir_gi_validated.toml'\n[pass.temporal]\nin.history = 'spatial.reservoir@prev'";
    let pairs = |scene: &str| {
        let plan = planned(&self::scene(scene), validated);
        plan.resources.iter().any(|resource| resource.name == "temporal.reservoir" && resource.life == Life::History)
    };
    assert!(pairs("animated") && !pairs("cornell"));
}

#[test]
fn nothing_is_resampled_in_the_dark() {
    let Some(context) = context() else { return };
    let mut dark = (aquifer_scenes::by_name("cornell").unwrap().make)();
    dark.materials.iter_mut().for_each(|material| material.emission = glam::Vec3::ZERO);
    let dark = Arc::new(dark.finish().unwrap());
    let graph = extending("restir_di_unbiased");
    let runs: Vec<String> = planned(&dark, &graph).steps.into_iter().map(|step| step.node).collect();
    assert_eq!(runs, ["gbuffer_traced", "shade", "accumulate", "tonemap"]);
    let output = |kept: Kept| {
        let mut renderer = Parts { kept, ..Parts::new(&dark, &graph) }.renderer(&context);
        aquifer_tests::image(&mut renderer, 3)
    };
    assert_eq!(output(Kept::Needed), output(Kept::All));
}
