//! Fills slot `domain`: indirect light. A sample is the point x_s that a path from the pixel's surface arrives at, with the radiance that leaves it
//! towards that surface (Ouyang et al. 2021).
//!
//! The measure is the solid angle of x_s at the pixel's surface; a sample moves between pixels by reconnection to x_s. The radiance is an estimate by
//! path tracing, kept as it is: for other pixels too, as if x_s looked the same from all sides. Paths count from two scatterings on: what x_s emits
//! itself is direct light.
//! @paths 2..
//! bias (glossy) [domain = gi_path]: the radiance that left a glossy point one way is taken for that of all ways
//! bias (normal_maps) [domain = gi_path]: the radiance that left a point by a normal turned to one viewer is taken for that of all viewers
//! bias (moving_objects): radiance found in earlier frames is kept, though what it came from has moved since
//! bias (moving_lights): radiance found in earlier frames is kept, though lights have moved since
//! bias (visibility = at_shading) [visibility = in_target]: samples exist only where the pixel that drew them sees them, which no MIS weight knows

import package::base::math::{HUGE, luminance, max3};
import package::base::rng::{Rng};
import package::bounce::{first_bounce, onward, suffix_rng, suffix_seed};
import package::cached::{Cached, PathEnd, keep, recall};
import package::path::{walk};
import package::reconnect::{reconnection_jacobian, seen_by, segment};
import package::frame::frame::{NOW};
import package::scene::geometry::{NONE};
import package::scene::ray::{Ray};
import package::slot::magnitude::{magnitude};
import package::slot::trace::{closest, occluded};
import package::surface::{Surface, ray_from, scatter, surface_at};

/// What the target function is: eq. 9, magnitude of the integrand; or eq. 10, of the radiance alone, which suits more pixels.
/// @choices integrand radiance
override target_of: u32 = 0u;

/// Drawn by a ray: what is drawn is seen.
const DRAWN_IS_SEEN = true;

/// 40 bytes.
struct Sample { end: Cached }

/// `weight` is 1 / density by solid angle; 0 where nothing was drawn.
struct Drawn { sample: Sample, weight: f32 }

/// `jacobian` 0: the shift does not exist.
struct Shifted { sample: Sample, value: vec3<f32>, p_hat: f32, jacobian: f32 }

fn draw(at: Surface, index: u32, count: u32, rng: ptr<function, Rng>) -> Drawn {
    var none: Drawn;
    let bounce = first_bounce(at, rng);
    let seed = suffix_seed(at, rng);
    if (bounce.pdf <= 0.0) { return none; }
    let hit = closest(ray_from(at, bounce.direction), at.when);
    if (hit.instance == NONE) { return none; }
    let s = surface_at(hit, -bounce.direction, at.when);
    var suffix = suffix_rng(seed);
    let radiance = walk(s, 2u, onward(seed), &suffix);
    let end = keep(PathEnd(s.position, s.size, s.geometric, radiance, seed, -bounce.direction, hit.t));
    return Drawn(Sample(end), 1.0 / bounce.pdf);
}

/// f · L · cos, without visibility.
fn value(s: Sample, at: Surface) -> vec3<f32> {
    let end = recall(s.end);
    return scatter(at, normalize(end.position - at.position)) * end.radiance;
}

/// Zero below the horizon of `at`, where it draws nothing.
fn p_hat(s: Sample, at: Surface) -> f32 {
    let f = value(s, at);
    if (target_of == 0u || max3(f) <= 0.0) { return magnitude(f); }
    return magnitude(recall(s.end).radiance);
}

fn visible(s: Sample, at: Surface) -> bool {
    let end = recall(s.end);
    return !occluded(segment(at, end.position, end.normal, end.size), at.when);
}

fn shift(s: Sample, src: Surface, dst: Surface) -> Shifted {
    let end = recall(s.end);
    let j = reconnection_jacobian(seen_by(src.position, end.position, end.normal), seen_by(dst.position, end.position, end.normal));
    return Shifted(s, value(s, dst), p_hat(s, dst), j);
}

/// Does the path that found the sample, traced anew from where it began, bring another radiance now? It begins a thousandth of the way on: where
/// exactly is known to 16 bits of direction, which might lie below the surface.
fn changed(s: Sample, tolerance: f32) -> bool {
    let end = recall(s.end);
    let hit = closest(Ray(end.position + 0.999 * end.distance * end.back, HUGE, -end.back), NOW);
    if (hit.instance == NONE || abs(hit.t - 0.999 * end.distance) > tolerance * end.distance) { return true; }
    var suffix = suffix_rng(end.seed);
    let radiance = luminance(walk(surface_at(hit, end.back, NOW), 2u, onward(end.seed), &suffix));
    let kept = luminance(end.radiance);
    return abs(radiance - kept) > tolerance * kept;
}
