//! The first reservoir of a pixel: candidates drawn by the domain, one kept.
//!
//! Streaming resampled importance sampling (Bitterli et al. 2020, alg. 3). All candidates come from one density, so that m_i = 1 / M;
//! where a domain draws them in two ways, their shares are in the weights that it gives.
//!
//! Whether the winner is seen is one coin for all its candidates: with a share q of their light seen, the relative variance that it brings is
//! (1 - q) / q, however many they are. So K winners may be drawn, each of candidates of its own and tested, and one of them kept. W_k = Σ_k w / p̂(Y_k)
//! estimates 1 / p without bias for the target p̂ V, so that p̂(Y_k) W_k / K = Σ_k w / K are resampling weights again, with m_k = 1 / K.

import package::base::rng::{Rng, rng_next4};
import package::restir::reservoir::{Reservoir, Selection, finish, offer, update};
import package::slot::domain::{DRAWN_IS_SEEN, draw, p_hat, visible};
import package::slot::visibility::{TEST_CANDIDATE};
import package::surface::{Surface};

/// Of confidence 1, however many candidates and winners there were, and also where nothing was found.
fn resample(at: Surface, candidates: u32, winners: u32, rng: ptr<function, Rng>) -> Reservoir {
    var kept: Selection;
    for (var k = 0u; k < winners; k++) {
        let s = winner(at, candidates, rng);
        if (winners == 1u) {
            kept = s;
        } else {
            offer(&kept, s.sample, s.p_hat, s.sum / f32(winners), rng_next4(rng).x);
        }
    }
    kept.confidence = 1.0;
    return finish(kept);
}

/// One of so many candidates; of sum 0 where it was tested, and is hidden.
fn winner(at: Surface, candidates: u32, rng: ptr<function, Rng>) -> Selection {
    var s: Selection;
    let m = 1.0 / f32(candidates);
    for (var i = 0u; i < candidates; i++) {
        let drawn = draw(at, i, candidates, rng);
        var target_value = 0.0;
        if (drawn.weight > 0.0) { target_value = p_hat(drawn.sample, at); }
        update(&s, drawn.sample, target_value, m * target_value * drawn.weight, rng_next4(rng).x);
    }
    if (TEST_CANDIDATE && !DRAWN_IS_SEEN && s.sum > 0.0 && !visible(s.sample, at)) { s.sum = 0.0; }
    return s;
}
