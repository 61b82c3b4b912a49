//! Fills slot `mis`: m_i = c_i / C, the 1/M of Bitterli et al. 2020, alg. 4. No input's target is evaluated at another's sample.
//!
//! At a sample that some input could not have made, the shares of those that could sum to less than 1.
//! bias [mis = contribution]: it loses energy where the inputs' supports differ, at shadow edges, creases and the rims of lights

import package::base::rng::{Rng, rng_next4};
import package::restir::inputs::{Input, MAX_INPUTS, candidate, total_confidence};
import package::restir::reservoir::{Reservoir, Selection, finish, merge};
import package::slot::shading::{shade_input};
import package::surface::{Surface};

fn combine(at: Surface, inputs: ptr<function, array<Input, MAX_INPUTS>>, count: u32, rng: ptr<function, Rng>) -> Reservoir {
    let total = total_confidence(inputs, count);
    var s: Selection;
    for (var i = 0u; i < count; i++) {
        let y = candidate(at, (*inputs)[i], i == 0u);
        let c = (*inputs)[i].confidence;
        shade_input(at, y, c / total * y.weight);
        merge(&s, y.sample, y.p_hat, c / total * y.p_hat * y.weight, c, rng_next4(rng).x);
    }
    return finish(s);
}
