//! Fills slot `domain`: direct light. A sample is a point of a light: its id and its place in the light's own uv (Bitterli et al. 2020).
//!
//! The measure is uv: targets carry dω/duv (for a triangle, area · cos / r²), so that a sample means the same point of the same light at every
//! pixel and in every frame, also of lights that move or deform, and the shift's Jacobian is 1. Ids of lights are the same at every moment of a
//! scene; a light that has gone out has value 0.
//!
//! Of a pixel's n candidates, n_b are met by rays drawn from the BSDF and n_l are drawn by slot `proposal`. With q the density by uv that the
//! proposal is taken for and p_b that of the BSDF, the balance heuristic gives a candidate the MIS weight p_b / (n_l q + n_b p_b) if a BSDF ray met it, and
//! q / (n_l q + n_b p_b) if it was proposed; n times that times its contribution weight (1 / p_b; the proposal's W) is n / (n_l q + n_b p_b), and
//! n q W / (n_l q + n_b p_b): unbiased for any q > 0, also where the proposal's own density is not known. A light that no ray can meet has p_b = 0.
//! @paths 1
//! @default

import package::base::rng::{Rng, rng_bits, rng_next4};
import package::scene::geometry::{NONE};
import package::scene::ray::{leave};
import package::slot::lights::{arrive, light_count, light_of, light_point, shadow_ray, uv_of};
import package::slot::magnitude::{magnitude};
import package::slot::proposal::{propose, weighting_pdf};
import package::slot::trace::{closest, occluded};
import package::surface::{Surface, ray_from, scatter, scatter_pdf, scatter_sample};

/// Candidates of a pixel that rays drawn from the BSDF meet; the others, of which there is always one, are drawn by slot `proposal`.
/// @range 0 64
/// @unbiased 0
/// @unless visibility in_target
/// @why rays meet only what their own pixel sees, which targets without visibility do not know of
override bsdf_rays: u32 = 0u;

/// Drawn by no ray.
const DRAWN_IS_SEEN = false;

/// 12 bytes.
struct Sample { light: u32, u: f32, v: f32 }

/// `weight` estimates 1 / density by uv; 0 where nothing was drawn.
struct Drawn { sample: Sample, weight: f32 }

/// `jacobian` 0: the shift does not exist.
struct Shifted { sample: Sample, value: vec3<f32>, p_hat: f32, jacobian: f32 }

/// Candidate `index` of `count`; its weight holds its share, so that all count alike.
fn draw(at: Surface, index: u32, count: u32, rng: ptr<function, Rng>) -> Drawn {
    if (light_count() == 0u) { return Drawn(Sample(0u, 0.0, 0.0), 0.0); }
    let rays = min(bsdf_rays, count - 1u);
    if (index < rays) { return meet(at, rays, count, rng_next4(rng).xyz); }
    let c = propose(at.position, rng_bits(rng));
    let s = Sample(c.light, c.uv.x, c.uv.y);
    if (rays == 0u) { return Drawn(s, c.weight); }
    let q = weighting_pdf(s.light, at.position);
    return Drawn(s, c.weight * f32(count) * q / mixed_density(s, at, rays, count, q));
}

/// What a ray drawn from the BSDF meets.
fn meet(at: Surface, rays: u32, count: u32, u: vec3<f32>) -> Drawn {
    let nothing = Drawn(Sample(0u, 0.0, 0.0), 0.0);
    let drawn = scatter_sample(at, u);
    if (drawn.pdf <= 0.0) { return nothing; }
    let hit = closest(ray_from(at, drawn.direction), at.when);
    let light = light_of(hit);
    if (light == NONE) { return nothing; }
    let uv = uv_of(hit, drawn.direction);
    let s = Sample(light, uv.x, uv.y);
    let density = mixed_density(s, at, rays, count, weighting_pdf(light, at.position));
    if (density <= 0.0) { return nothing; }
    return Drawn(s, f32(count) / density);
}

/// n_l q + n_b p_b, by uv.
fn mixed_density(s: Sample, at: Surface, rays: u32, count: u32, q: f32) -> f32 {
    let p = light_point(s.light, vec2<f32>(s.u, s.v), at.when);
    let arrival = arrive(p, at.position);
    var met = scatter_pdf(at, arrival.direction) * arrival.jacobian;
    @if(alpha) { met *= p.opacity; }
    return f32(count - rays) * q + f32(rays) * met;
}

/// f · L_e · cos · dω/duv, without visibility.
fn value(s: Sample, at: Surface) -> vec3<f32> {
    let arrival = arrive(light_point(s.light, vec2<f32>(s.u, s.v), at.when), at.position);
    return scatter(at, arrival.direction) * arrival.value;
}

fn p_hat(s: Sample, at: Surface) -> f32 {
    return magnitude(value(s, at));
}

fn visible(s: Sample, at: Surface) -> bool {
    let p = light_point(s.light, vec2<f32>(s.u, s.v), at.when);
    let direction = arrive(p, at.position).direction;
    return !occluded(shadow_ray(leave(at.position, at.geometric, direction, at.size), p), at.when);
}

fn shift(s: Sample, src: Surface, dst: Surface) -> Shifted {
    if (s.light >= light_count()) { return Shifted(s, vec3<f32>(0.0), 0.0, 0.0); }
    let there = value(s, dst);
    return Shifted(s, there, magnitude(there), 1.0);
}

/// A point of a light needs no replay: its radiance is looked up anew whenever it is used.
fn changed(s: Sample, tolerance: f32) -> bool {
    return false;
}
