//! Fills slot `mis`: the generalised balance heuristic m_i(y) = c_i p̂_{←i}(y) / Σ_j c_j p̂_{←j}(y) (Lin et al. 2022).
//!
//! Unbiased. O(k²) targets: the most costly of the rules.

import package::base::rng::{Rng, rng_next4};
import package::restir::inputs::{Candidate, Input, MAX_INPUTS, candidate, surface_of_input, target_from};
import package::restir::reservoir::{Reservoir, Selection, finish, merge};
import package::slot::shading::{shade_input};
import package::surface::{Surface};

fn combine(at: Surface, inputs: ptr<function, array<Input, MAX_INPUTS>>, count: u32, rng: ptr<function, Rng>) -> Reservoir {
    var s: Selection;
    for (var i = 0u; i < count; i++) {
        let y = candidate(at, (*inputs)[i], i == 0u);
        var m = 0.0;
        if (y.p_hat > 0.0) { m = share(at, y, i, inputs, count); }
        shade_input(at, y, m * y.weight);
        merge(&s, y.sample, y.p_hat, m * y.p_hat * y.weight, (*inputs)[i].confidence, rng_next4(rng).x);
    }
    return finish(s);
}

/// m_i at input i's candidate y.
fn share(at: Surface, y: Candidate, i: u32, inputs: ptr<function, array<Input, MAX_INPUTS>>, count: u32) -> f32 {
    let own = (*inputs)[i].confidence * y.own;
    var sum = own;
    for (var j = 0u; j < count; j++) {
        if (j == i) { continue; }
        var there = y.p_hat;
        if (j != 0u) { there = target_from(y.sample, at, surface_of_input((*inputs)[j])); }
        sum += (*inputs)[j].confidence * there;
    }
    return own / sum;
}
