//! Traces given rays with whatever fills slot `trace`: the nearest hit, or any.

import package::frame::frame::{NOW};
import package::scene::geometry::{NONE};
import package::scene::ray::{Hit, Ray};
import package::scene::hierarchy::{stack_overflow};
import package::slot::trace::{closest, occluded};

/// Rays in a row of pixels.
override width: u32 = 1u;

/// Rows of pixels; none where `t_max` is 0.
@group(1) @binding(0) var<storage, read> rays: array<Ray>;
/// What each hits: instance (`NONE` for nothing), triangle, bits of t, and 1 where the stack ran over. Of any hit, the instance is 0.
@group(1) @binding(1) var<storage, read_write> hits: array<vec4<u32>>;

@compute @workgroup_size(8, 8) fn nearest(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = id.y * width + id.x;
    if (id.x >= width || at >= arrayLength(&rays)) { return; }
    let ray = rays[at];
    var hit = Hit(0.0, NONE, 0u, vec2<f32>(0.0));
    if (ray.t_max > 0.0) { hit = closest(ray, NOW); }
    hits[at] = vec4<u32>(hit.instance, hit.triangle, bitcast<u32>(hit.t), u32(stack_overflow));
}

@compute @workgroup_size(8, 8) fn any(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = id.y * width + id.x;
    if (id.x >= width || at >= arrayLength(&rays)) { return; }
    let ray = rays[at];
    var blocked = false;
    if (ray.t_max > 0.0) { blocked = occluded(ray, NOW); }
    hits[at] = vec4<u32>(select(NONE, 0u, blocked), 0u, 0u, u32(stack_overflow));
}
