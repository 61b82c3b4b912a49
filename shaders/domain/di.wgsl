//! Fills slot `domain`: direct light. A sample is a point of a light: its id and its place in the light's own uv (Bitterli et al. 2020).
//!
//! The measure is uv: targets carry dω/duv (for a triangle, area · cos / r²), so that a sample means the same point of the same light at every
//! pixel and in every frame, also of lights that move or deform, and the shift's Jacobian is 1. Ids of lights are the same at every moment of a
//! scene; a light that has gone out has value 0.
//! @default

import package::base::math::{luminance};
import package::base::rng::{Rng, rng_bits};
import package::slot::lights::{arrive, light_count, light_point, shadow_ray};
import package::slot::proposal::{propose};
import package::slot::trace::{occluded};
import package::surface::{Surface, scatter};
import package::scene::ray::{leave};

/// Drawn by no ray.
const DRAWN_IS_SEEN = false;

/// 12 bytes.
struct Sample { light: u32, u: f32, v: f32 }

/// `weight` estimates 1 / density by uv; 0 where nothing was drawn.
struct Drawn { sample: Sample, weight: f32 }

/// `jacobian` 0: the shift does not exist.
struct Shifted { sample: Sample, value: vec3<f32>, p_hat: f32, jacobian: f32 }

fn draw(at: Surface, index: u32, rng: ptr<function, Rng>) -> Drawn {
    if (light_count() == 0u) { return Drawn(Sample(0u, 0.0, 0.0), 0.0); }
    let c = propose(at.position, rng_bits(rng));
    return Drawn(Sample(c.light, c.uv.x, c.uv.y), c.weight);
}

/// f · L_e · cos · dω/duv, without visibility.
fn value(s: Sample, at: Surface) -> vec3<f32> {
    let arrival = arrive(light_point(s.light, vec2<f32>(s.u, s.v), at.when), at.position);
    return scatter(at, arrival.direction) * arrival.value;
}

fn p_hat(s: Sample, at: Surface) -> f32 {
    return luminance(value(s, at));
}

fn visible(s: Sample, at: Surface) -> bool {
    let p = light_point(s.light, vec2<f32>(s.u, s.v), at.when);
    let direction = arrive(p, at.position).direction;
    return !occluded(shadow_ray(leave(at.position, at.geometric, direction, at.size), p), at.when);
}

fn shift(s: Sample, src: Surface, dst: Surface) -> Shifted {
    if (s.light >= light_count()) { return Shifted(s, vec3<f32>(0.0), 0.0, 0.0); }
    let there = value(s, dst);
    return Shifted(s, there, luminance(there), 1.0);
}

/// A point of a light needs no replay: its radiance is looked up anew whenever it is used.
fn changed(s: Sample, tolerance: f32) -> bool {
    return false;
}
