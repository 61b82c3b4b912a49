//! Fills slot `mis`: m_i = c_i / Z(Y), Z = Σ c_j over the inputs that could have made the sample that was kept
//! (Bitterli et al. 2020, alg. 6; Ouyang et al. 2021, alg. 4).
//!
//! Unbiased: Σ m = 1 over those inputs. O(k) targets, all for one sample; noisy where targets are very unlike, since it asks only for p̂_{←j} > 0.
//! Z depends on y alone, so that dividing by it after the choice has the expectation of weighting by c_i / Z(y_i) before (not its noise: samples are
//! chosen by other shares).
//! @default

import package::base::rng::{Rng, rng_next4};
import package::restir::inputs::{Input, MAX_INPUTS, candidate, surface_of_input, target_from};
import package::restir::reservoir::{Reservoir, Selection, finish, merge};
import package::surface::{Surface};

fn combine(at: Surface, inputs: ptr<function, array<Input, MAX_INPUTS>>, count: u32, rng: ptr<function, Rng>) -> Reservoir {
    var s: Selection;
    var chosen = 0u;
    for (var i = 0u; i < count; i++) {
        let y = candidate(at, (*inputs)[i], i == 0u);
        let c = (*inputs)[i].confidence;
        if (merge(&s, y.sample, y.p_hat, c * y.p_hat * y.weight, c, rng_next4(rng).x)) { chosen = i; }
    }
    if (s.sum <= 0.0) { return finish(s); }
    // The canonical can make all that the receiver's target is positive at; the input that made the sample can make it.
    var z = 0.0;
    for (var j = 0u; j < count; j++) {
        if (j == 0u || j == chosen || target_from(s.sample, at, surface_of_input((*inputs)[j])) > 0.0) { z += (*inputs)[j].confidence; }
    }
    s.sum /= z;
    return finish(s);
}
