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
import package::slot::proposal::{propose, weighting_pdf};
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

/// Light that comes to a surface along unit `direction`: `value` · `weight` is what one sample of a technique stands for.
struct Incident {
    direction: vec3<f32>,
    /// Radiance by solid angle; of lights without extent, what they send.
    value: vec3<f32>,
    /// 1 / density, times the technique's share; 0 where nothing comes.
    weight: f32,
}

/// One proposed light, seen through one shadow ray, weighted against BSDF sampling.
fn next_event(s: Surface, rng: ptr<function, Rng>) -> Incident {
    var none: Incident;
    if (light_count() == 0u) { return none; }
    let c = propose(s.position, rng_bits(rng));
    let p = light_point(c.light, c.uv, s.when);
    let arrival = arrive(p, s.position);
    if (max3(scatter(s, arrival.direction) * arrival.value) <= 0.0) { return none; }
    rays_traced += 1u;
    if (occluded(shadow_ray(leave(s.position, s.geometric, arrival.direction, s.size), p), s.when)) { return none; }
    if (arrival.jacobian == 0.0) { return Incident(arrival.direction, arrival.value, c.weight); }
    let by_light = weighting_pdf(c.light, s.position) / arrival.jacobian;
    let share = power_heuristic(by_light, scatter_pdf(s, arrival.direction));
    return Incident(arrival.direction, arrival.value / arrival.jacobian, c.weight * arrival.jacobian * share);
}

/// Emission met by a ray from `s` whose direction the BSDF drew with density `pdf`, weighted against next-event estimation.
fn met(hit: Hit, ray: Ray, pdf: f32, s: Surface) -> Incident {
    let light = light_of(hit);
    var radiance = vec3<f32>(0.0);
    var jacobian = 0.0;
    if (hit.instance == NONE) {
        @if(environment) {
            radiance = environment_radiance(ray.direction);
            jacobian = environment_jacobian(ray.direction);
        }
    } else {
        if (light != NONE) { radiance = emitted(hit, -ray.direction, s.when); }
        if (max3(radiance) > 0.0) { jacobian = jacobian_of(light, hit, s.position, s.when); }
    }
    if (light == NONE || max3(radiance) <= 0.0) { return Incident(ray.direction, vec3<f32>(0.0), 0.0); }
    var share = 1.0;
    if (jacobian > 0.0) { share = power_heuristic(pdf, weighting_pdf(light, s.position) / jacobian); }
    return Incident(ray.direction, radiance, share / pdf);
}

/// Radiance through `start` towards its viewer, from paths of the transport's lengths. `start` is their scattering `first`; what scatters
/// again after it is weighted by `onward`, and not traced where that is 0.
fn walk(start: Surface, first: u32, onward: f32, rng: ptr<function, Rng>) -> vec3<f32> {
    var s = start;
    var throughput = vec3<f32>(1.0);
    var radiance = vec3<f32>(0.0);
    for (var k = first; k <= transport_max; k++) {
        rng_vertex(rng, k);
        let counts = k >= transport_min;
        if (counts) {
            let event = next_event(s, rng);
            if (event.weight > 0.0) { radiance += throughput * scatter(s, event.direction) * event.value * event.weight; }
        }
        rng_vertex(rng, k + 128u);
        let u = rng_next4(rng);
        let drawn = scatter_sample(s, u.xyz);
        if (drawn.pdf <= 0.0 || max3(drawn.value) <= 0.0) { break; }
        let ray = ray_from(s, drawn.direction);
        rays_traced += 1u;
        let hit = closest(ray, s.when);
        if (counts) {
            let emission = met(hit, ray, drawn.pdf, s);
            radiance += throughput * drawn.value * emission.value * emission.weight;
        }
        throughput *= drawn.value / drawn.pdf;
        if (hit.instance == NONE || k == transport_max) { break; }
        if (k == first) {
            if (onward <= 0.0) { break; }
            throughput *= onward;
        }
        if (k >= roulette_after) {
            let survive = min(max3(throughput), 0.95);
            if (u.w >= survive) { break; }
            throughput /= survive;
        }
        s = surface_at(hit, -drawn.direction, s.when);
    }
    return radiance;
}
