//! What a pixel keeps of its samples, and how one is chosen.
//!
//! Resampled importance sampling: candidates X_i with contribution weights W_i (estimates of 1 / p(X_i)) get the resampling weights
//! w_i = m_i(X_i) p̂(X_i) W_i, and one is kept with probability w_i / Σw. Its own contribution weight is then W = Σw / p̂(Y), and f(Y) W
//! estimates ∫ f without bias wherever Σ m_i = 1 on f's support (Bitterli et al. 2020, § 3.1; Lin et al. 2022).

import package::base::math::{is_finite};
import package::restir::witness::{tell_offered};
import package::slot::domain::{Sample};
import package::slot::visibility::{Weight};

/// All zeros: empty, of no confidence.
struct Reservoir {
    sample: Sample,
    /// Contribution weight W; 0 where nothing was kept.
    weight: Weight,
    /// How much the reservoir counts beside others (c, also called M). Bookkeeping: it must not depend on samples.
    confidence: f32,
}

/// A choice under way.
struct Selection {
    sample: Sample,
    /// Of `sample`, for the receiver.
    p_hat: f32,
    /// Σw.
    sum: f32,
    confidence: f32,
}

/// Offers one fresh sample: it counts as one.
fn update(s: ptr<function, Selection>, sample: Sample, p_hat: f32, w: f32, u: f32) -> bool {
    (*s).confidence += 1.0;
    return offer(s, sample, p_hat, w, u);
}

/// Offers what a reservoir kept: it counts with the reservoir's confidence, also where nothing was kept.
fn merge(s: ptr<function, Selection>, sample: Sample, p_hat: f32, w: f32, confidence: f32, u: f32) -> bool {
    (*s).confidence += confidence;
    let adopted = offer(s, sample, p_hat, w, u);
    tell_offered(p_hat, w, adopted);
    return adopted;
}

/// True when the sample was adopted. A weight that is no number is dropped: it would never leave the history again.
fn offer(s: ptr<function, Selection>, sample: Sample, p_hat: f32, w: f32, u: f32) -> bool {
    if (!is_finite(w) || w <= 0.0) { return false; }
    (*s).sum += w;
    if (u * (*s).sum >= w) { return false; }
    (*s).sample = sample;
    (*s).p_hat = p_hat;
    return true;
}

/// The choice as a reservoir.
fn finish(s: Selection) -> Reservoir {
    var w = 0.0;
    if (s.p_hat > 0.0) { w = s.sum / s.p_hat; }
    return Reservoir(s.sample, Weight(select(0.0, w, is_finite(w))), s.confidence);
}
