//! Fills slot `trace`: `trace/bvh2`, and every ray counted. Counting costs time of its own: measure that without it.

import package::scene::ray::{Hit, Ray};
import package::trace::bvh2::{closest as closest_hit, occluded as is_occluded};

/// Rays that the pass traced.
/// @optional
@group(1) @binding(40) var<storage, read_write> traced: atomic<u32>;

fn closest(ray: Ray, when: u32) -> Hit {
    atomicAdd(&traced, 1u);
    return closest_hit(ray, when);
}

fn occluded(ray: Ray, when: u32) -> bool {
    atomicAdd(&traced, 1u);
    return is_occluded(ray, when);
}
