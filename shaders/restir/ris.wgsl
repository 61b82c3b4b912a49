//! The first reservoir of a pixel: candidates drawn by the domain, one kept.
//!
//! Streaming resampled importance sampling (Bitterli et al. 2020, alg. 3). All candidates come from one density, so that m_i = 1 / M.

import package::base::rng::{Rng, rng_next4};
import package::restir::reservoir::{Reservoir, Selection, finish, update};
import package::slot::domain::{DRAWN_IS_SEEN, draw, p_hat, visible};
import package::slot::visibility::{TEST_CANDIDATE, Weight};
import package::surface::{Surface};

/// Of confidence 1, however many candidates there were, and also where nothing was found.
fn resample(at: Surface, candidates: u32, rng: ptr<function, Rng>) -> Reservoir {
    var s: Selection;
    let m = 1.0 / f32(candidates);
    for (var i = 0u; i < candidates; i++) {
        let drawn = draw(at, i, candidates, rng);
        var target_value = 0.0;
        if (drawn.weight > 0.0) { target_value = p_hat(drawn.sample, at); }
        update(&s, drawn.sample, target_value, m * target_value * drawn.weight, rng_next4(rng).x);
    }
    s.confidence = 1.0;
    var r = finish(s);
    if (TEST_CANDIDATE && !DRAWN_IS_SEEN && r.weight.value > 0.0 && !visible(r.sample, at)) { r.weight = Weight(0.0); }
    return r;
}
