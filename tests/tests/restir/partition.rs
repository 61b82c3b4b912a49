//! Shares sum to one, sample by sample; empty reservoirs; confidence.

use crate::toy::{INPUTS, LIMIT, graph, renderer, results};
use aquifer_graph::Value;
use aquifer_render::Renderer;
use aquifer_tests::context;

const RULES: [&str; 4] = ["constant", "contribution", "balance", "pairwise"];

/// Combines nine made-up inputs, each trial at its own place.
fn partition(context: &aquifer_render::Context, rule: &str, visibility: &str, setting: &str) -> Renderer {
    let graph = (graph(rule, visibility, 4) + setting)
        .replace("[pass.initial]\nin.surface = 'toy_gbuffer.surface'\nset.candidates = 4", "[pass.partition]")
        .replace("surface@prev", "surface")
        .replace("initial.reservoir@prev", "partition.reservoir")
        .replace("initial.", "partition.");
    renderer(context, &graph, &[("pass/partition", include_str!("partition.wgsl"))], &["partition.able"])
}

/// One number of what came out of nine inputs, for every trial.
fn of_nine(renderer: &mut Renderer, number: u32) -> Vec<f64> {
    renderer.set_param("combine", "written", Value::U32(number)).unwrap();
    results(renderer).swap_remove(INPUTS - 1)
}

const CONFIDENCE: u32 = 1;
const WEIGHT: u32 = 2;

/// For every trial: how many inputs could have made its sample, and whether the receiver could.
fn able(renderer: &mut Renderer) -> Vec<(usize, bool)> {
    let words = renderer.read_f32("partition.able").unwrap();
    words.chunks_exact(9).map(|able| (able.iter().filter(|can| **can > 0.0).count(), able[0] > 0.0)).collect()
}

#[test]
fn shares_sum_to_one() {
    let Some(context) = context() else { return };
    for rule in RULES {
        for (visibility, setting) in [("at_shading", ""), ("in_target", ""), ("in_target", LIMIT)] {
            let mut renderer = partition(&context, rule, visibility, setting);
            let sums = of_nine(&mut renderer, WEIGHT);
            let able = able(&mut renderer);
            let lit: Vec<_> = sums.iter().zip(&able).filter(|(_, able)| able.1).map(|(sum, able)| (*sum, able.0)).collect();
            assert!(lit.iter().any(|lit| lit.1 == 1) && lit.iter().any(|lit| lit.1 >= 6), "places of all kinds");
            let worst = lit.iter().map(|(sum, _)| (sum - 1.0).abs()).fold(0.0, f64::max);
            eprintln!("{rule}, {visibility}, {setting}: |Σm − 1| ≤ {worst:.1e} at {} places", lit.len());
            // With the constant rule the shares of all inputs sum to one, but not those of the inputs that can make the sample.
            assert!(if rule == "constant" { worst > 0.1 } else { worst < 3e-6 }, "{rule}, {visibility}: {worst}");
        }
    }
}

#[test]
fn confidence_adds_up_and_what_cannot_be_used_is_not_kept() {
    let Some(context) = context() else { return };
    let expected: u32 = 8 + (1..9).map(|i| 1 + 5 * i % 3).sum::<u32>();
    for rule in RULES {
        let mut renderer = partition(&context, rule, "at_shading", "");
        assert!(of_nine(&mut renderer, CONFIDENCE).iter().all(|confidence| *confidence == f64::from(expected)), "{rule}: not {expected}");
        let sums = of_nine(&mut renderer, WEIGHT);
        let dark: Vec<_> = sums.iter().zip(able(&mut renderer)).filter(|(_, able)| !able.1).collect();
        assert!(dark.len() > 100 && dark.iter().all(|(sum, _)| **sum == 0.0), "{rule}: kept where the receiver's target is 0");
    }
}
