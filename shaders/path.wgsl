//! One walk along a light path: next-event estimation and BSDF sampling at every vertex, joined by the power heuristic
//! (Veach 1997, eq. 9.13 with β = 2).
//!
//! A path with k scatterings counts when transport_min ≤ k ≤ transport_max; the graph's transport is their only source. Emission seen
//! directly (k = 0) is the caller's.

import package::base::math::{HUGE, max3, square};
import package::base::rng::{Rng, rng_bits, rng_next4, rng_vertex};
import package::frame::frame::{NOW};
import package::scene::geometry::{NONE};
import package::scene::ray::{Hit, Ray, leave};
import package::slot::lights::{arrive, jacobian_of, light_count, light_of, light_point, shadow_ray};
@if(environment) import package::scene::environment::{environment_jacobian, environment_radiance};
import package::slot::proposal::{propose, proposal_pdf};
import package::slot::trace::{closest, occluded};
import package::surface::{Surface, emitted, ray_from, scatter, scatter_pdf, scatter_sample, surface_at};

/// Fewest scatterings of the paths that count.
override transport_min: u32 = 0u;
/// Most scatterings of the paths that count.
override transport_max: u32 = 5u;
/// Scatterings after which Russian roulette may end a path; the survivors are weighted up, so any value is unbiased.
/// @range 1 64
override roulette_after: u32 = 3u;

/// Rays that this invocation has traced.
var<private> rays_traced: u32;

/// Share of technique a against b.
fn power_heuristic(a: f32, b: f32) -> f32 {
    // By ratio: squares of densities near a mirror overflow.
    if (a <= 0.0) { return 0.0; }
    return 1.0 / (1.0 + square(b / a));
}

/// Light that one shadow ray to a proposed light brings through `s`, weighted against BSDF sampling.
fn next_event(s: Surface, rng: ptr<function, Rng>) -> vec3<f32> {
    if (light_count() == 0u) { return vec3<f32>(0.0); }
    let c = propose(s.position, rng_bits(rng));
    let p = light_point(c.light, c.uv, s.when);
    let arrival = arrive(p, s.position);
    let value = scatter(s, arrival.direction) * arrival.value * c.weight;
    if (max3(value) <= 0.0) { return vec3<f32>(0.0); }
    rays_traced += 1u;
    if (occluded(shadow_ray(leave(s.position, s.geometric, arrival.direction, s.size), p), s.when)) { return vec3<f32>(0.0); }
    if (arrival.jacobian == 0.0) { return value; }
    let by_light = proposal_pdf(c.light, s.position) / arrival.jacobian;
    return value * power_heuristic(by_light, scatter_pdf(s, arrival.direction));
}

/// Emission met by a BSDF-sampled ray of density `pdf`, weighted against next-event estimation.
fn met(hit: Hit, ray: Ray, pdf: f32, from_surface: Surface) -> vec3<f32> {
    if (hit.instance == NONE) {
        @if(environment) {
            let jacobian = environment_jacobian(ray.direction);
            return environment_radiance(ray.direction) * light_share(light_count() - 1u, jacobian, pdf, from_surface);
        }
        return vec3<f32>(0.0);
    }
    let light = light_of(hit);
    if (light == NONE) { return vec3<f32>(0.0); }
    let radiance = emitted(hit, -ray.direction, from_surface.when);
    if (max3(radiance) <= 0.0) { return vec3<f32>(0.0); }
    return radiance * light_share(light, jacobian_of(light, hit, from_surface.position, from_surface.when), pdf, from_surface);
}

/// BSDF sampling's share of light `light`, whose dω/duv is `jacobian`.
fn light_share(light: u32, jacobian: f32, pdf: f32, s: Surface) -> f32 {
    if (jacobian <= 0.0) { return 1.0; }
    return power_heuristic(pdf, proposal_pdf(light, s.position) / jacobian);
}

/// Radiance through `start` towards its viewer, from paths of the transport's lengths.
fn walk(start: Surface, rng: ptr<function, Rng>) -> vec3<f32> {
    var s = start;
    var throughput = vec3<f32>(1.0);
    var radiance = vec3<f32>(0.0);
    for (var k = 1u; k <= transport_max; k++) {
        rng_vertex(rng, k);
        let counts = k >= transport_min;
        if (counts) { radiance += throughput * next_event(s, rng); }
        rng_vertex(rng, k + 128u);
        let u = rng_next4(rng);
        let drawn = scatter_sample(s, u.xyz);
        if (drawn.pdf <= 0.0 || max3(drawn.value) <= 0.0) { break; }
        throughput *= drawn.value / drawn.pdf;
        let ray = ray_from(s, drawn.direction);
        rays_traced += 1u;
        let hit = closest(ray, s.when);
        if (counts) { radiance += throughput * met(hit, ray, drawn.pdf, s); }
        if (hit.instance == NONE || k == transport_max) { break; }
        if (k >= roulette_after) {
            let survive = min(max3(throughput), 0.95);
            if (u.w >= survive) { break; }
            throughput /= survive;
        }
        s = surface_at(hit, -drawn.direction, s.when);
    }
    return radiance;
}
