//! Fills slot `mis`: pairwise MIS, defensive (Bitterli 2022; Lin et al. 2022): every input is weighted against
//! the canonical κ alone. With C = Σc and p̂ the receiver's target,
//!
//!   m_i(y) = (c_i / C) (C − c_κ) p̂_{←i}(y) / [(C − c_κ) p̂_{←i}(y) + c_κ p̂(y)]
//!   m_κ(y) = c_κ / C + Σ_i (c_i / C) c_κ p̂(y) / [(C − c_κ) p̂_{←i}(y) + c_κ p̂(y)]
//!
//! Each pair's two terms sum to c_i / C, so that Σ m = 1 at every y. Unbiased; O(k) targets. m_κ is taken at the canonical's own sample.

import package::base::rng::{Rng, rng_next4};
import package::restir::inputs::{Candidate, Input, MAX_INPUTS, candidate, surface_of_input, target_from, total_confidence};
import package::restir::reservoir::{Reservoir, Selection, finish, merge};
import package::slot::shading::{shade_input};
import package::surface::{Surface};

fn combine(at: Surface, inputs: ptr<function, array<Input, MAX_INPUTS>>, count: u32, rng: ptr<function, Rng>) -> Reservoir {
    let total = total_confidence(inputs, count);
    var s: Selection;
    for (var i = 0u; i < count; i++) {
        let y = candidate(at, (*inputs)[i], i == 0u);
        let c = (*inputs)[i].confidence;
        var m = 0.0;
        if (y.p_hat > 0.0) {
            if (i == 0u) { m = share_of_canonical(at, y, total, inputs, count); } else { m = share_of(y, c, (*inputs)[0].confidence, total); }
        }
        shade_input(at, y, m * y.weight);
        merge(&s, y.sample, y.p_hat, m * y.p_hat * y.weight, c, rng_next4(rng).x);
    }
    return finish(s);
}

/// m_i at input i's candidate, i > 0.
fn share_of(y: Candidate, c: f32, canonical: f32, total: f32) -> f32 {
    let there = (total - canonical) * y.own;
    return c / total * there / (there + canonical * y.p_hat);
}

/// m_κ at the canonical's sample.
fn share_of_canonical(at: Surface, y: Candidate, total: f32, inputs: ptr<function, array<Input, MAX_INPUTS>>, count: u32) -> f32 {
    let canonical = (*inputs)[0].confidence;
    let here = canonical * y.p_hat;
    var sum = canonical;
    for (var i = 1u; i < count; i++) {
        let there = (total - canonical) * target_from(y.sample, at, surface_of_input((*inputs)[i]));
        sum += (*inputs)[i].confidence * here / (there + here);
    }
    return sum / total;
}
