//! Direct and indirect light in one graph: nothing is counted twice, and no number goes astray in a long run.

use aquifer_render::View;
use aquifer_tests::{Parts, context, scene};

/// Colour of a pass in the fourth frame.
fn fourth_frame(graph: &str, setting: &[&str], port: &str) -> Option<Vec<f32>> {
    let context = context()?;
    let scene = scene("cornell");
    let graph = format!("extends = '{graph}.toml'");
    let mut renderer = Parts { settings: setting, keep: &[port], ..Parts::new(&scene, &graph) }.renderer(&context);
    (0..4).for_each(|_| renderer.frame().unwrap());
    Some(renderer.read_f32(port).unwrap())
}

/// Random numbers go by the names of passes, so that the parts alone draw what they draw together.
#[test]
fn full_is_direct_plus_indirect() {
    let Some(full) = fourth_frame("restir_full", &[], "shade.color") else { return };
    let emission_and_direct = fourth_frame("restir_full", &["transport=full:0"], "shade_direct.color").unwrap();
    let indirect = fourth_frame("restir_gi_unbiased", &[], "shade.color").unwrap();
    let mut lit = [0, 0];
    for ((full, direct), indirect) in full.chunks_exact(4).zip(emission_and_direct.chunks_exact(4)).zip(indirect.chunks_exact(4)) {
        lit[0] += u32::from(direct[1] > 0.0);
        lit[1] += u32::from(indirect[1] > 0.0);
        for channel in 0..3 {
            let sum = direct[channel] + indirect[channel];
            assert!((full[channel] - sum).abs() <= 1e-5 * sum, "{full:?} is not {direct:?} and {indirect:?}");
        }
    }
    assert!(lit.iter().all(|lit| *lit > 500), "lit pixels: {lit:?}");
}

/// A thousand frames: what is no number would stay in the history for good.
#[test]
fn long_runs_hold_numbers_only() {
    let Some(context) = context() else { return };
    for (graph, on) in [("restir_gi_validated", "animated"), ("restir_full", "sunlit_wall")] {
        let scene = scene(on);
        let graph = format!("extends = '{graph}.toml'");
        let view = View { step: 0.05, ..View::default() };
        let keep = ["shade.color", "spatial.reservoir"];
        // Few inputs: the histories are what this is about.
        let settings = ["spatial.taps=1", "spatial.low=0.0"];
        let mut renderer =
            Parts { size: [32, 18], view, settings: &settings, keep: &keep, ..Parts::new(&scene, &graph) }.renderer(&context);
        for frame in 1..=1000 {
            renderer.frame().unwrap();
            if frame % 100 == 0 {
                let color = renderer.read_f32("shade.color").unwrap();
                assert!(color.iter().all(|word| word.is_finite()), "{graph}, frame {frame}: radiance");
                let weights: Vec<f32> = renderer.read_f32("spatial.reservoir").unwrap().chunks_exact(12).map(|words| words[10]).collect();
                assert!(weights.iter().all(|word| word.is_finite()), "{graph}, frame {frame}: weights");
                assert!(weights.iter().filter(|word| **word > 0.0).count() > 100, "{graph}, frame {frame}: reservoirs are empty");
            }
        }
    }
}
