//! What a combination rule works on: reservoirs with the surfaces they were made for, and targets carried between them. Input 0 is the canonical:
//! the receiver's own, whose support is the receiver's whole domain.
//!
//! The target of input i, carried to the receiver by its shift T_i: p̂_{←i}(y) = p̂_i(T_i⁻¹ y) |∂T_i⁻¹/∂y|, and 0 where y is not an image of T_i
//! (Lin et al. 2022). It holds visibility exactly where the reservoirs were made with it (slot `visibility`): at every y that counts, the
//! shares of those inputs that can really have produced y must sum to 1.

import package::frame::frame::{NOW};
import package::restir::reservoir::{Reservoir};
import package::restir::witness::{tell_carried};
import package::slot::domain::{Sample, p_hat, shift, visible};
import package::slot::visibility::{IN_TARGET};
import package::surface::{Surface, SurfaceRecord, unpack_surface};

/// The receiver, its own history, nine neighbours and their histories.
const MAX_INPUTS = 20u;

/// Names a reservoir and the surface that it was made for. Names, not copies: an array of copies would not fit into registers.
struct Input {
    pixel: u32,
    /// `NOW` or `BEFORE`.
    when: u32,
    /// What the reservoir counts here, capped.
    confidence: f32,
}

/// Whose transforms, lights and hierarchy last frame's targets are evaluated with: last frame's, or today's. Camera and surfaces are last frame's.
/// @choices before now
/// @unbiased before
/// @why where things move, last frame's samples are not weighted by the targets that they were made with
override history_world: u32 = 0u;

/// Where p̂ |∂T/∂x| at the one end of a shift and p̂ at the other differ by a larger factor, the shift is taken not to exist; 0: nowhere; below 1
/// there is none. Being the same both ways it biases no rule that is unbiased without it. It bounds what an input brings under shares by confidence
/// alone (`mis = contribution`), which do not know that an input could hardly have made a sample: narrow lobes that point elsewhere otherwise bring
/// few large pieces.
/// @range 0 1000000
override target_limit: f32 = 0.0;

/// Surfaces of this frame.
@group(1) @binding(10) var<storage, read> surface: array<SurfaceRecord>;
/// Reservoirs of this frame.
@group(1) @binding(11) var<storage, read> current: array<Reservoir>;
/// Surfaces of last frame; wire it to `….surface@prev`.
/// @optional
@group(1) @binding(12) var<storage, read> previous_surface: array<SurfaceRecord>;
/// Reservoirs of last frame, or of frames before.
/// @optional
@group(1) @binding(13) var<storage, read> history: array<Reservoir>;

fn input_of(pixel: u32, when: u32, cap: f32) -> Input {
    return Input(pixel, when, min(reservoir_at(pixel, when).confidence, cap));
}

fn reservoir_at(pixel: u32, when: u32) -> Reservoir {
    if (when == NOW) { return current[pixel]; }
    return history[pixel];
}

fn surface_at_pixel(pixel: u32, when: u32) -> Surface {
    if (when == NOW) { return unpack_surface(surface[pixel], when); }
    var s = unpack_surface(previous_surface[pixel], when);
    if (history_world == 1u) { s.when = NOW; }
    return s;
}

fn surface_of_input(i: Input) -> Surface {
    return surface_at_pixel(i.pixel, i.when);
}

/// The sample of an input in the receiver's domain.
struct Candidate {
    sample: Sample,
    /// For the receiver; 0 where there is nothing to merge.
    p_hat: f32,
    /// W |∂T/∂x|: the contribution weight in the receiver's domain.
    weight: f32,
    /// p̂_{←i} of its own input: p̂_i(X_i) / |∂T/∂x|, without shifting back. Visibility was tested when the input was made.
    own: f32,
}

/// A sample carried from one surface's domain to another's; `p_hat` is 0 where the shift does not exist.
struct Moved { sample: Sample, p_hat: f32, jacobian: f32 }

fn move_to(s: Sample, src: Surface, dst: Surface) -> Moved {
    let t = shift(s, src, dst);
    if (t.jacobian <= 0.0 || t.p_hat <= 0.0 || is_too_unlike(t.p_hat * t.jacobian, s, src)) { return Moved(t.sample, 0.0, 0.0); }
    if (IN_TARGET && !visible(t.sample, dst)) { return Moved(t.sample, 0.0, 0.0); }
    return Moved(t.sample, t.p_hat, t.jacobian);
}

/// Is the target `there`, where `s` is carried to, beyond `target_limit` of what it is at home?
fn is_too_unlike(there: f32, s: Sample, src: Surface) -> bool {
    if (target_limit <= 0.0) { return false; }
    let here = p_hat(s, src);
    return max(there, here) > target_limit * min(there, here);
}

/// p̂_{←i}(y) of the input at `src`, for y of the domain of `at`.
fn target_from(y: Sample, at: Surface, src: Surface) -> f32 {
    let x = move_to(y, at, src);
    return x.p_hat * x.jacobian;
}

/// The sample of an input, carried to the receiver. The canonical is at home: where targets hold visibility, it was tested when it was made.
fn candidate(at: Surface, from_input: Input, is_canonical: bool) -> Candidate {
    let r = reservoir_at(from_input.pixel, from_input.when);
    if (r.weight.value <= 0.0) {
        tell_carried(from_input.pixel, from_input.when, 0.0, 0.0);
        return Candidate(r.sample, 0.0, 0.0, 0.0);
    }
    if (is_canonical) {
        let here = p_hat(r.sample, at);
        tell_carried(from_input.pixel, from_input.when, r.weight.value, 1.0);
        return Candidate(r.sample, here, r.weight.value, here);
    }
    let src = surface_of_input(from_input);
    let y = move_to(r.sample, src, at);
    tell_carried(from_input.pixel, from_input.when, r.weight.value, y.jacobian);
    if (y.p_hat <= 0.0) { return Candidate(r.sample, 0.0, 0.0, 0.0); }
    return Candidate(y.sample, y.p_hat, r.weight.value * y.jacobian, p_hat(r.sample, src) / y.jacobian);
}

/// C = Σc. An empty reservoir counts: that it found nothing is knowledge too.
fn total_confidence(inputs: ptr<function, array<Input, MAX_INPUTS>>, count: u32) -> f32 {
    var total = 0.0;
    for (var i = 0u; i < count; i++) { total += (*inputs)[i].confidence; }
    return total;
}
