//! Fills slot `domain`: an integrand on a line, with everything that a rule must cope with and an integral in closed form.
//!
//! A sample is x = h(u) = u + k u², with k the pixel's own; the shift keeps u, so that its Jacobian is (1 + 2 k' u) / (1 + 2 k u). It does not exist
//! beyond u = REACH. The integrand by x is alpha + beta u within the pixel's support, and the target differs from it by 1 + gamma u. The pixel
//! does not see u between `dark_from` and `dark_to`. These numbers travel in fields of the surface that a g-buffer keeps.
//!
//! Last frame's targets are not this frame's: in odd frames beta is another, and the support is one of two by the side that the pixel is viewed from,
//! while the camera jumps from one side to the other between any two frames.

import package::base::rng::{Rng, pcg4d, rng_next4};
import package::frame::frame::{frame};
import package::surface::{Surface};

/// Drawn by no ray.
const DRAWN_IS_SEEN = false;

struct Sample { x: f32 }
struct Drawn { sample: Sample, weight: f32 }
struct Shifted { sample: Sample, value: vec3<f32>, p_hat: f32, jacobian: f32 }

/// `place` is the pixel's x in the world; supports are those seen from its left and from its right.
struct Toy { place: f32, k: f32, left: vec2<f32>, right: vec2<f32>, alpha: f32, beta: vec2<f32>, gamma: f32, dark: vec2<f32> }

/// What the integrand needs of it, at one time and from one side.
struct Seen { k: f32, low: f32, high: f32, alpha: f32, beta: f32, gamma: f32, dark_from: f32, dark_to: f32 }

const REACH = 0.93;

/// The surface that stands for a pixel.
fn surface_of(t: Toy, when: u32) -> Surface {
    var s: Surface;
    s.position = vec3<f32>(t.place, t.k, t.gamma);
    s.when = when;
    s.normal = vec3<f32>(0.0, 0.0, 1.0);
    s.geometric = s.normal;
    s.size = t.alpha;
    s.bsdf.alpha = t.beta.x;
    s.bsdf.metallic = t.beta.y;
    s.bsdf.base = vec3<f32>(t.dark, 0.0);
    s.bsdf.f0 = vec3<f32>(t.left, t.right.x);
    s.bsdf.f90 = t.right.y;
    return s;
}

fn toy_at(at: Surface) -> Seen {
    let odd = ((frame.index + at.when) & 1u) == 1u;
    let beta = select(at.bsdf.alpha, at.bsdf.metallic, odd);
    let support = select(at.bsdf.f0.xy, vec2<f32>(at.bsdf.f0.z, at.bsdf.f90), at.view.x > 0.0);
    return Seen(at.position.y, support.x, support.y, at.size, beta, at.position.z, at.bsdf.base.x, at.bsdf.base.y);
}

/// Pixel i of the table.
fn pixel(i: u32) -> Toy {
    switch i {
        // TABLE
        default: { return Toy(0.0, 0.0, vec2<f32>(0.0), vec2<f32>(0.0), 0.0, vec2<f32>(0.0), 0.0, vec2<f32>(0.0)); }
    }
}

/// u of x, without cancellation at k = 0.
fn parameter(t: Seen, x: f32) -> f32 {
    return 2.0 * x / (1.0 + sqrt(1.0 + 4.0 * t.k * x));
}

/// Uniform in u: a random start, then golden-ratio steps from candidate to candidate.
fn draw(at: Surface, index: u32, count: u32, rng: ptr<function, Rng>) -> Drawn {
    let t = toy_at(at);
    let start = f32(pcg4d((*rng).key).x >> 8u) * 5.9604644775390625e-8;
    let u = fract(start + f32(index) * 0.61803398875);
    return Drawn(Sample(u + t.k * u * u), 1.0 + 2.0 * t.k * u);
}

fn value(s: Sample, at: Surface) -> vec3<f32> {
    let t = toy_at(at);
    let u = parameter(t, s.x);
    return vec3<f32>(select(0.0, t.alpha + t.beta * u, u >= t.low && u <= t.high));
}

fn p_hat(s: Sample, at: Surface) -> f32 {
    let t = toy_at(at);
    return value(s, at).x * (1.0 + t.gamma * parameter(t, s.x));
}

fn visible(s: Sample, at: Surface) -> bool {
    let t = toy_at(at);
    let u = parameter(t, s.x);
    return u < t.dark_from || u > t.dark_to;
}

fn shift(s: Sample, src: Surface, dst: Surface) -> Shifted {
    let a = toy_at(src);
    let b = toy_at(dst);
    let u = parameter(a, s.x);
    if (u > REACH) { return Shifted(s, vec3<f32>(0.0), 0.0, 0.0); }
    let y = Sample(u + b.k * u * u);
    return Shifted(y, value(y, dst), p_hat(y, dst), (1.0 + 2.0 * b.k * u) / (1.0 + 2.0 * a.k * u));
}

fn changed(s: Sample, tolerance: f32) -> bool {
    return false;
}
