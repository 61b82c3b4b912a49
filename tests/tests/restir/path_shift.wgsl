//! Fills slot `domain`: paths of two vertices, moved by random replay of the first direction and reconnection to the second vertex.

import package::base::math::{luminance};
import package::base::rng::{Rng, rng_begin, rng_bits, rng_next4};
import package::frame::frame::{frame};
import package::scene::geometry::{NONE};
import package::scene::ray::{Ray, leave};
import package::slot::trace::{closest, occluded};
import package::surface::{Surface, ray_from, scatter, scatter_sample, surface_at};

const DRAWN_IS_SEEN = true;

struct Sample { seed: u32, x: f32, y: f32, z: f32 }
struct Drawn { sample: Sample, weight: f32 }
struct Shifted { sample: Sample, value: vec3<f32>, p_hat: f32, jacobian: f32 }

/// The first vertex that the path's random numbers lead to from `at`; `instance` is `NONE` where there is none.
fn first_vertex(seed: u32, at: Surface) -> Surface {
    var rng = rng_begin(vec2<u32>(seed, 0u), vec2<u32>(0u), 0u, 0u);
    let drawn = scatter_sample(at, rng_next4(&rng).xyz);
    let hit = closest(ray_from(at, drawn.direction), at.when);
    var none: Surface;
    none.instance = NONE;
    if (drawn.pdf <= 0.0 || hit.instance == NONE) { return none; }
    return surface_at(hit, -drawn.direction, at.when);
}

fn draw(at: Surface, index: u32, count: u32, rng: ptr<function, Rng>) -> Drawn {
    let seed = rng_bits(rng).x;
    let first = first_vertex(seed, at);
    var none: Drawn;
    if (first.instance == NONE) { return none; }
    let drawn = scatter_sample(first, rng_next4(rng).xyz);
    let hit = closest(ray_from(first, drawn.direction), at.when);
    if (drawn.pdf <= 0.0 || hit.instance == NONE) { return none; }
    let p = surface_at(hit, -drawn.direction, at.when).position;
    return Drawn(Sample(seed, p.x, p.y, p.z), 1.0 / drawn.pdf);
}

fn value(s: Sample, at: Surface) -> vec3<f32> {
    let first = first_vertex(s.seed, at);
    if (first.instance == NONE) { return vec3<f32>(0.0); }
    return scatter(first, normalize(vec3<f32>(s.x, s.y, s.z) - first.position));
}

fn p_hat(s: Sample, at: Surface) -> f32 {
    return luminance(value(s, at));
}

fn visible(s: Sample, at: Surface) -> bool {
    let first = first_vertex(s.seed, at);
    let d = vec3<f32>(s.x, s.y, s.z) - first.position;
    let origin = leave(first.position, first.geometric, normalize(d), first.size);
    return first.instance != NONE && !occluded(Ray(origin, 0.999 * length(d), normalize(d)), at.when);
}

fn shift(s: Sample, src: Surface, dst: Surface) -> Shifted {
    let from_vertex = first_vertex(s.seed, src);
    let to_vertex = first_vertex(s.seed, dst);
    if (from_vertex.instance == NONE || to_vertex.instance == NONE) { return Shifted(s, vec3<f32>(0.0), 0.0, 0.0); }
    let p = vec3<f32>(s.x, s.y, s.z);
    let there = value(s, dst);
    let a = p - from_vertex.position;
    let b = p - to_vertex.position;
    return Shifted(s, there, luminance(there), dot(a, a) / dot(b, b));
}

fn changed(s: Sample, tolerance: f32) -> bool {
    return frame.index > 0u && tolerance < 0.0;
}
