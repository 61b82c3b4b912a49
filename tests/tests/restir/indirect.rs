//! Indirect light by ReSTIR against Mitsuba, and bugs and biases that must show there.

use crate::{
    direct::coarse,
    toy::{module, replaced},
};
use aquifer_lab::stats::{
    BlockTest, Blocks, Rule, Verdict,
    blocks::{BlockComparison, Quantity},
};
use aquifer_render::View;
use aquifer_tests::{
    Parts, context,
    cost::rays_of_frames,
    references::mitsuba,
    scene,
    seeds::{SIDE, Trial},
};

/// 0.5 % of the whole; 2 % of each block that is resolved to 0.7 %. Few seeds: that is less than half of the blocks.
fn test() -> BlockTest {
    let rule = Rule::Exceeds { alpha: 0.05 };
    BlockTest { block_rule: rule, resolved_share: 0.4, ..BlockTest::default() }
}

/// Many candidates, small disks, and few inputs while histories are short: this resolves most in the time that a test may take.
const SMALL: [&str; 5] = ["initial.candidates=8", "spatial.radius=6.0", "spatial.rows=0.0", "spatial.more_taps=3", "spatial.taps=3"];

const INITIAL: &str = "restir_gi_initial";
const SPATIAL: &str = "restir_gi_spatial_only";

/// What is compared, on which scene.
struct Case<'a> {
    scene: &'a str,
    graph: &'a str,
    settings: &'a [&'a str],
    shaders: &'a [(&'a str, &'a str)],
    frame: u32,
    seeds: u64,
    test: BlockTest,
}

impl Case<'_> {
    /// `None` without an adapter.
    fn compare(&self) -> Option<BlockComparison> {
        let context = context()?;
        let graph = format!("extends = '{}.toml'\ntransport = 'indirect:2'", self.graph);
        let reference = Blocks::of_film(&mitsuba(&format!("{}-indirect2.exr", self.scene)), SIDE, Quantity::Luminance);
        let scene = scene(self.scene);
        let Case { settings, shaders, frame, seeds, .. } = *self;
        let trial = Trial { scene: &scene, graph: &graph, settings, shaders, view: View::default(), frame, seeds };
        Some(trial.compare(&context, &reference, &self.test))
    }
}

#[test]
fn unbiased_reuse_agrees_with_path_tracing() {
    let case = Case { scene: "cornell", graph: "restir_gi_unbiased", settings: &SMALL, shaders: &[], frame: 2, seeds: 192, test: test() };
    let Some(found) = case.compare() else { return };
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
}

/// The domain that keeps a vertex more, and evaluates surfaces anew at both ends.
const PATHS: [&str; 5] = ["slots.domain=gi_path", "initial.candidates=8", "spatial.radius=6.0", "spatial.rows=0.0", "spatial.taps=3"];

#[test]
fn kept_paths_agree_with_path_tracing() {
    let case = Case { scene: "cornell", graph: SPATIAL, settings: &PATHS, shaders: &[], frame: 0, seeds: 192, test: coarse() };
    let Some(found) = case.compare() else { return };
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
    let swapped = replaced(
        module("domain/gi_path"),
        "return Shifted(s, value(s, dst), p_hat(s, dst), j);",
        "return Shifted(s, value(s, dst), p_hat(s, dst), 1.0 / j);",
    );
    let found = Case { shaders: &[("domain/gi_path", &swapped)], ..case }.compare().expect("the adapter is still there");
    assert_eq!(found.verdict, Verdict::Failed, "the Jacobian inverted does not show: {found}");
}

#[test]
fn planted_bugs_of_indirect_light_show() {
    let z = replaced(module("restir/inputs"), "let x = move_to(y, at, src);", "let x = shift(y, at, src);");
    let p = replaced(module("bounce"), "select(0.0, 1.0 / onward_share,", "select(0.0, 1.0,");
    // Neighbours of all kinds: many of their samples are hidden.
    let near = ["spatial.radius=12.0", "spatial.rows=0.0", "spatial.taps=4", "spatial.normal=180.0", "spatial.depth=1.0"];
    let with = |setting| near.iter().copied().chain([setting]).collect::<Vec<_>>();
    let settings = [with("spatial.jacobian=inverted"), with("slots.mis=contribution"), vec!["initial.onward_share=0.25"]];
    let shaders = [vec![], vec![("restir/inputs", z.as_str())], vec![("bounce", p.as_str())]];
    let bugs =
        [("the Jacobian inverted", SPATIAL, 128), ("visibility missing in Z", SPATIAL, 128), ("no 1/p after roulette", INITIAL, 256)];
    for (i, (name, graph, seeds)) in bugs.into_iter().enumerate() {
        let case = Case { scene: "cornell", graph, settings: &settings[i], shaders: &shaders[i], frame: 0, seeds, test: test() };
        let Some(found) = case.compare() else { return };
        assert_eq!(found.verdict, Verdict::Failed, "{name} does not show: {found}");
    }
}

#[test]
fn tiles_of_small_pictures_do_not_pass_all_at_once() {
    let Some(context) = context() else { return };
    let scene = scene("cornell");
    let parts = Parts { settings: &["initial.onward_share=0.25"], ..Parts::new(&scene, "extends = 'restir_gi_initial.toml'") };
    let spread = |parts: &Parts<'_>| {
        let rays = rays_of_frames(&context, parts, &["initial".into()]).remove(0);
        rays.iter().fold(0.0, |most: f64, &it| most.max(it)) / rays.iter().fold(f64::INFINITY, |least, &it| least.min(it))
    };
    let (scaled, of_1080_rows) =
        (spread(&parts), spread(&Parts { settings: &["initial.onward_share=0.25", "initial.tile_rows=0"], ..parts }));
    assert!(scaled < 1.2, "frames trace up to {scaled:.2} times the rays of others");
    assert!(of_1080_rows > 1.3, "one tile or two: {of_1080_rows:.2} times");
}
