//! What a combination rule works on: reservoirs with the surfaces they were made for, and targets carried between them.
//!
//! The target of input i, carried to the receiver by its shift T_i: p̂_{←i}(y) = p̂_i(T_i⁻¹ y) |∂T_i⁻¹/∂y|, and 0 where y is not an image of T_i
//! (Lin et al. 2022). It holds visibility exactly where the reservoirs were made with it (slot `visibility`): at every y that counts, the
//! shares of those inputs that can really have produced y must sum to 1.

import package::restir::reservoir::{Reservoir};
import package::slot::domain::{Sample, p_hat, shift, visible};
import package::slot::visibility::{IN_TARGET};
import package::surface::{Surface};

const MAX_INPUTS = 12u;

/// Input 0 is the canonical: the receiver's own, whose support is the receiver's whole domain.
struct Input { reservoir: Reservoir, surface: Surface }

/// The sample of an input in the receiver's domain.
struct Candidate {
    sample: Sample,
    /// For the receiver; 0 where there is nothing to merge.
    p_hat: f32,
    /// W |∂T/∂x|: the contribution weight in the receiver's domain.
    weight: f32,
    /// |∂T/∂x|.
    jacobian: f32,
}

/// A sample carried from one surface's domain to another's; `p_hat` is 0 where the shift does not exist.
struct Moved { sample: Sample, p_hat: f32, jacobian: f32 }

fn move_to(s: Sample, src: Surface, dst: Surface) -> Moved {
    let t = shift(s, src, dst);
    if (t.jacobian <= 0.0 || t.p_hat <= 0.0) { return Moved(t.sample, 0.0, 0.0); }
    if (IN_TARGET && !visible(t.sample, dst)) { return Moved(t.sample, 0.0, 0.0); }
    return Moved(t.sample, t.p_hat, t.jacobian);
}

/// p̂_{←i}(y) of the input at `src`, for y of the domain of `at`.
fn target_from(y: Sample, at: Surface, src: Surface) -> f32 {
    let x = move_to(y, at, src);
    return x.p_hat * x.jacobian;
}

/// Sample of input i, carried to the receiver.
fn candidate(at: Surface, inputs: ptr<function, array<Input, MAX_INPUTS>>, i: u32) -> Candidate {
    let r = (*inputs)[i].reservoir;
    if (r.weight.value <= 0.0) { return Candidate(r.sample, 0.0, 0.0, 0.0); }
    // The canonical is at home; where its target holds visibility, it was tested when it was made.
    if (i == 0u) { return Candidate(r.sample, p_hat(r.sample, at), r.weight.value, 1.0); }
    let y = move_to(r.sample, (*inputs)[i].surface, at);
    return Candidate(y.sample, y.p_hat, r.weight.value * y.jacobian, y.jacobian);
}

/// p̂_{←i} at input i's own candidate: p̂_i(X_i) / |∂T/∂x|, without shifting back. Visibility was tested when the input was made.
fn own_target(c: Candidate, inputs: ptr<function, array<Input, MAX_INPUTS>>, i: u32) -> f32 {
    if (i == 0u) { return c.p_hat; }
    return p_hat((*inputs)[i].reservoir.sample, (*inputs)[i].surface) / c.jacobian;
}

/// C = Σc. An empty reservoir counts: that it found nothing is knowledge too.
fn total_confidence(inputs: ptr<function, array<Input, MAX_INPUTS>>, count: u32) -> f32 {
    var total = 0.0;
    for (var i = 0u; i < count; i++) { total += (*inputs)[i].reservoir.confidence; }
    return total;
}
