//! Every rule, with visibility in the target and at shading, of 1 to 9 inputs, against the closed form.

use crate::toy::{LIMIT, difference, estimates, graph, renderer};
use aquifer_lab::stats::{Difference, Moments, Rule, Verdict, difference::largest_error};
use aquifer_render::Context;
use aquifer_tests::context;

/// As a share of the integral.
const BAND: f64 = 5e-4;
/// Of equivalence.
const RULE: Rule = Rule::Equivalent { alpha: 0.05 };
/// Frames of 32,768 trials.
const MOST_FRAMES: u64 = 400;

/// From the closed form, for 1 to 9 inputs, until `enough`; `setting` is of the pass that combines.
fn measure(context: &Context, rule: &str, visibility: &str, setting: &str, enough: impl FnMut(&[Moments]) -> bool) -> Vec<Difference> {
    let mut renderer = renderer(context, &(graph(rule, visibility, 12) + setting), &[], &[]);
    let begin = std::time::Instant::now();
    let found = estimates(&mut renderer, enough);
    eprintln!("{rule}, {visibility}, {setting} {} trials in {:.1?}:", found[0].count(), begin.elapsed());
    for (count, moments) in (1..).zip(&found) {
        let found = difference(moments);
        eprintln!("  {count} inputs: {:+.4} % ± {:.4} %", 100.0 * found.value, 100.0 * found.standard_error);
    }
    found.iter().map(difference).collect()
}

/// Frames are added until the largest error at which equivalence can be shown; where that does not decide, until twice as many.
fn resolved() -> impl FnMut(&[Moments]) -> bool {
    let mut error = largest_error(BAND);
    move |all: &[Moments]| {
        let found: Vec<Difference> = all.iter().map(difference).collect();
        if found.iter().any(|found| found.standard_error > error) {
            return all[0].count() >= MOST_FRAMES * 32_768;
        }
        error /= 2.0_f64.sqrt();
        found.iter().all(|found| found.judge(BAND, RULE) != Verdict::NotResolved)
    }
}

#[test]
fn unbiased_rules_give_the_closed_form() {
    let Some(context) = context() else { return };
    let mut wrong = Vec::new();
    for rule in ["contribution", "balance", "pairwise"] {
        // That the limit holds both ways is asked of the rule it is for; that shares sum to one within it, of every rule (`partition`).
        let limited = (rule == "contribution").then_some(("in_target", LIMIT));
        for (visibility, setting) in [("at_shading", ""), ("in_target", "")].into_iter().chain(limited) {
            for (count, found) in (1..).zip(measure(&context, rule, visibility, setting, resolved())) {
                if found.judge(BAND, RULE) != Verdict::Passed {
                    wrong.push((rule, visibility, setting, count, found));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "not shown within 0.05 %: {wrong:#?}");
}

#[test]
fn biased_parts_miss_it() {
    let Some(context) = context() else { return };
    for (rule, visibility) in [("constant", "at_shading"), ("constant", "in_target"), ("balance", "reuse")] {
        let found = measure(&context, rule, visibility, "", |_| true);
        assert!(found[0].p_different() > 1e-4, "{rule}, {visibility}: one input leaves nothing to weight: {:?}", found[0]);
        for (count, found) in (1..).zip(found).skip(1) {
            assert!(found.p_outside(BAND) < 1e-6, "{rule}, {visibility}, {count} inputs: {found:?}");
        }
    }
}
