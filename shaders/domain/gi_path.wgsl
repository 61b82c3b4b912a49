//! Fills slot `domain`: indirect light, exact on every material. A sample is the point x_s that a path arrives at, with one of the ways that light reaches
//! it: where from (ω₃), and how much (L).
//!
//! A whole tree of paths behind x_s cannot be evaluated for another viewer, but one branch can: the integrand is f(x_v; ω) cos · f(x_s; ω₃ → x_v)
//! cos₃ · L, and x_s, ω₃ and L are shared between pixels, so that reconnection's Jacobian is that of ω alone. A drawn path resamples one of three
//! branches: a proposed light, what the BSDF's ray meets, and the light that comes through what it meets. The first two find the same emission; their
//! MIS weights enter the contribution weight alone, so that L given (x_s, ω₃) means the same at every pixel: a share of it kept in L would depend on
//! the pixel that drew it. ω₃ is kept to 16 bits a coordinate, some 4·10⁻⁵ rad, which is less than a lobe is wide unless its roughness is below some
//! 0.01.
//! @paths 2..
//! bias (moving_objects): light found in earlier frames is kept, though what it came from has moved since
//! bias (moving_lights): light found in earlier frames is kept, though lights have moved since
//! bias (visibility = at_shading) [visibility = in_target]: samples exist only where the pixel that drew them sees them, which no MIS weight knows

import package::base::math::{is_finite, max3};
import package::base::pack::{pack_radiance, pack_unit, unpack_radiance, unpack_unit};
import package::base::rng::{Rng, rng_next4, rng_vertex};
import package::bounce::{first_bounce, onward, suffix_rng, suffix_seed};
import package::path::{Incident, met, next_event, transport_max, transport_min, walk};
import package::reconnect::{reconnection_jacobian, seen_by, segment};
import package::scene::geometry::{NONE, position_of};
import package::scene::ray::{Hit};
import package::slot::magnitude::{magnitude};
import package::slot::trace::{closest, occluded};
import package::surface::{Surface, ray_from, scatter, scatter_sample, surface_at};

/// What the target function is: eq. 9, magnitude of the integrand; or eq. 10, of the radiance that leaves x_s, which suits more pixels.
/// @choices integrand radiance
override target_of: u32 = 0u;

/// Drawn by a ray: what is drawn is seen.
const DRAWN_IS_SEEN = true;

/// 28 bytes, 32 in an array. All zeros bring no light.
struct Sample {
    /// L, packed.
    light: vec2<u32>,
    barycentrics: vec2<f32>,
    instance: u32,
    triangle: u32,
    /// ω₃, packed.
    incoming: u32,
}

/// `weight` estimates 1 / density by solid angles; 0 where nothing was drawn.
struct Drawn { sample: Sample, weight: f32 }

/// `jacobian` 0: the shift does not exist.
struct Shifted { sample: Sample, value: vec3<f32>, p_hat: f32, jacobian: f32 }

/// A branch under choice: by f · cos₃ · L at x_s, which any positive number may stand for.
struct Choice { sample: Sample, sum: f32, chosen: f32 }

fn draw(at: Surface, index: u32, count: u32, rng: ptr<function, Rng>) -> Drawn {
    var none: Drawn;
    let bounce = first_bounce(at, rng);
    let seed = suffix_seed(at, rng);
    if (bounce.pdf <= 0.0) { return none; }
    let hit = closest(ray_from(at, bounce.direction), at.when);
    if (hit.instance == NONE) { return none; }
    let s = surface_at(hit, -bounce.direction, at.when);
    var suffix = suffix_rng(seed);
    var choice: Choice;
    rng_vertex(&suffix, 0u);
    let coins = rng_next4(&suffix);
    let counts = transport_min <= 2u && transport_max >= 2u;
    rng_vertex(&suffix, 2u);
    if (counts) { offer_branch(&choice, s, next_event(s, &suffix), coins.x); }
    rng_vertex(&suffix, 2u + 128u);
    let drawn = scatter_sample(s, rng_next4(&suffix).xyz);
    if (drawn.pdf > 0.0 && max3(drawn.value) > 0.0) {
        let ray = ray_from(s, drawn.direction);
        let beyond = closest(ray, s.when);
        if (counts) { offer_branch(&choice, s, met(beyond, ray, drawn.pdf, s), coins.y); }
        let weight = onward(seed);
        if (beyond.instance != NONE && transport_max > 2u && weight > 0.0) {
            let radiance = walk(surface_at(beyond, -drawn.direction, s.when), 3u, 1.0, &suffix);
            offer_branch(&choice, s, Incident(drawn.direction, radiance * weight, 1.0 / drawn.pdf), coins.z);
        }
    }
    if (choice.chosen <= 0.0) { return none; }
    return Drawn(choice.sample, choice.sum / choice.chosen / bounce.pdf);
}

fn offer_branch(c: ptr<function, Choice>, s: Surface, branch: Incident, u: f32) {
    let light = pack_radiance(branch.value);
    let incoming = pack_unit(branch.direction);
    // From what is packed: this is what others will see.
    let p = magnitude(scatter(s, unpack_unit(incoming)) * unpack_radiance(light));
    let w = p * branch.weight;
    if (!is_finite(w) || w <= 0.0) { return; }
    (*c).sum += w;
    if (u * (*c).sum >= w) { return; }
    (*c).sample = Sample(light, s.barycentrics, s.instance, s.triangle, incoming);
    (*c).chosen = p;
}

/// x_s as `at` sees it.
fn end_of(s: Sample, at: Surface) -> Surface {
    let position = position_of(s.instance, s.triangle, s.barycentrics, at.when);
    return surface_at(Hit(0.0, s.instance, s.triangle, s.barycentrics), normalize(at.position - position), at.when);
}

/// Radiance that leaves x_s towards `at`.
fn leaving(s: Sample, end: Surface) -> vec3<f32> {
    return scatter(end, unpack_unit(s.incoming)) * unpack_radiance(s.light);
}

/// Without visibility.
fn value(s: Sample, at: Surface) -> vec3<f32> {
    let end = end_of(s, at);
    return scatter(at, -end.view) * leaving(s, end);
}

/// Zero below the horizon of `at`, where it draws nothing.
fn p_hat(s: Sample, at: Surface) -> f32 {
    let end = end_of(s, at);
    let f = scatter(at, -end.view);
    let radiance = leaving(s, end);
    if (target_of == 0u || max3(f) <= 0.0) { return magnitude(f * radiance); }
    return magnitude(radiance);
}

fn visible(s: Sample, at: Surface) -> bool {
    let end = end_of(s, at);
    return !occluded(segment(at, end.position, end.geometric, end.size), at.when);
}

fn shift(s: Sample, src: Surface, dst: Surface) -> Shifted {
    let from_src = end_of(s, src);
    let from_dst = end_of(s, dst);
    // The normal faces who looks: the same side for both, or none. In two frames x_s may be at two places.
    if (dot(from_src.geometric, from_dst.geometric) <= 0.0) { return Shifted(s, vec3<f32>(0.0), 0.0, 0.0); }
    let j = reconnection_jacobian(seen_by(src.position, from_src.position, from_src.geometric),
        seen_by(dst.position, from_dst.position, from_dst.geometric));
    return Shifted(s, value(s, dst), p_hat(s, dst), j);
}

/// Not told: the random numbers behind L are not kept.
fn changed(s: Sample, tolerance: f32) -> bool {
    return false;
}
