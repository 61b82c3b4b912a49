//! Reconnection: a path x1 – x2 – … of pixel q becomes one of pixel r by keeping x2 and all that follows.
//!
//! Samples are measured by the solid angle ω of x2 at x1. One area dA around x2 is seen from both:
//! dω_q = |cos φ_q| dA / ‖x1q − x2‖² and dω_r = |cos φ_r| dA / ‖x1r − x2‖², with φ at x2 between its geometric normal and the way to x1. So
//!
//!   J = |∂ω_r / ∂ω_q| = (|cos φ_r| / |cos φ_q|) · (‖x1q − x2‖² / ‖x1r − x2‖²)        (Ouyang et al. 2021, eq. 11)
//!
//! A density divides by J, so a contribution weight multiplies: W_r = W_q J. The paper's algorithm 4, line 11, divides there by mistake. Where
//! only one of the two is before x2's front the shift does not exist, and J is 0.

import package::scene::ray::{Ray, leave};
import package::surface::{Surface};

/// How contribution weights change under reconnection.
/// @choices on off inverted
/// @unbiased on
/// @why without its true value samples count too much or too little at pixels nearer to or farther from what they hit
override jacobian: u32 = 0u;
/// Where J or 1 / J is larger the shift is taken not to exist; 0: nowhere; below 1 there is none at all. Being the same both ways it biases no rule
/// that is unbiased without it. Weights 1/M need it: they do not know that an input could hardly have made a sample, and J is unbounded where a
/// receiver is near to it.
/// @range 0 1000000
override jacobian_limit: f32 = 0.0;

/// dω/dA at a point with unit `normal`, seen from `viewer`; 0 from behind.
fn seen_by(viewer: vec3<f32>, point: vec3<f32>, normal: vec3<f32>) -> f32 {
    let d = viewer - point;
    let d2 = dot(d, d);
    return max(dot(normal, d), 0.0) / (d2 * sqrt(d2));
}

/// J, from what q and r see of dA. Where the point has moved rigidly between two worlds, each sees it in its own.
fn reconnection_jacobian(by_q: f32, by_r: f32) -> f32 {
    if (by_q <= 0.0 || by_r <= 0.0) { return 0.0; }
    if (jacobian_limit > 0.0 && max(by_q / by_r, by_r / by_q) > jacobian_limit) { return 0.0; }
    switch jacobian {
        case 1u: { return 1.0; }
        case 2u: { return by_q / by_r; }
        default: { return by_r / by_q; }
    }
}

/// The ray whose being clear means that `s` sees the point; it leaves both ends. `size` is the largest coordinate in the arithmetic that made the point.
fn segment(s: Surface, point: vec3<f32>, normal: vec3<f32>, size: f32) -> Ray {
    let direction = normalize(point - s.position);
    let origin = leave(s.position, s.geometric, direction, s.size);
    let d = leave(point, normal, s.position - point, size) - origin;
    let distance = length(d);
    return Ray(origin, distance, d / distance);
}
