//! A domain whose shift replays random numbers and traces rays goes through every pass of reuse: only its own file knows. No adapter is needed.

use aquifer_shader::Specialisation;
use std::collections::BTreeSet;

/// A path of two vertices, as a shift of path space needs it: the first direction is drawn anew at the receiver from the path's own random numbers, the
/// second vertex of the old path is joined to what that ray hits. What it shines is left out.
const DOMAIN: &str = include_str!("path_shift.wgsl");

#[test]
fn a_shift_that_traces_composes_with_every_rule() {
    let mut library = aquifer_passes::library();
    library.insert("domain/path_shift", DOMAIN, "path_shift.wgsl");
    let rules = library.slots().remove("mis").expect("slot `mis`");
    for pass in ["initial", "temporal", "spatial", "shade"] {
        for rule in &rules {
            let mut slots = library.default_slots();
            slots.extend([("domain", "path_shift"), ("mis", rule), ("visibility", "in_target")].map(|(a, b)| (a.to_owned(), b.to_owned())));
            let what = Specialisation { entry: format!("pass/{pass}"), slots, features: BTreeSet::new() };
            let composed = library.compose(&what).unwrap_or_else(|fault| panic!("{pass} with {rule}:\n{fault}"));
            let traces = composed.interface.bindings.iter().any(|binding| binding.name == "tlas");
            assert!(traces, "{pass} with {rule} traces no ray");
        }
    }
}
