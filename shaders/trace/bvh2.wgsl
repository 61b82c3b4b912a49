//! Fills slot `trace`: a stack traversal of binary hierarchies, near child first.
//!
//! Two levels: a leaf of the upper one holds one instance, whose mesh's hierarchy is then descended in object space with the
//! direction left unnormalised, so that `t` means the same everywhere. Both children of a node stand together and are tested at
//! once; the stack holds at most one of them a level, and is sized from the levels of the loaded scene. Each level descends to a leaf
//! in a loop of its own (while-while: Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs").
//! @default

import package::base::math::{HUGE};
import package::base::table::{floats, words};
import package::frame::frame::{NOW};
import package::scene::geometry::{Instance, NONE, instance_at, point_to_object, triangle_at, vector_to_object};
import package::scene::limits::{STACK};
import package::scene::ray::{Hit, Ray};
@if(alpha) import package::scene::alpha::{stops};

/// The inner nodes of all meshes, 4 texels each, child by child: low corner and reference, high corner and nothing. A reference is
/// the index of an inner node, or of a leaf's first triangle with `LEAF` set and the number of its triangles less 1 in bits 28 to 30.
@group(0) @binding(0) var nodes: texture_2d<u32>;
/// The same of instances, one a leaf. In place of node 0 stands a reference to the root, `NONE` where nothing can be hit.
@group(0) @binding(1) var tlas: texture_2d<u32>;
@if(moving_objects) @group(0) @binding(2) var tlas_prev: texture_2d<u32>;

const LEAF: u32 = 0x80000000u;

/// Set when a push found the stack full, which the size of the stack rules out.
var<private> stack_overflow: bool;

/// No component is infinite: 0 · ∞ would be NaN where an origin lies on a slab.
fn inverse_direction(d: vec3<f32>) -> vec3<f32> {
    let tiny = vec3<f32>(1e-30);
    return 1.0 / select(d, select(-tiny, tiny, d >= vec3<f32>(0.0)), abs(d) < tiny);
}

/// Distance at which the ray enters the box, or `HUGE`. The far side is widened by 2 ulp (Ize 2013, "Robust BVH Ray Traversal").
fn enter(low: vec3<f32>, high: vec3<f32>, origin: vec3<f32>, inverse: vec3<f32>, t_max: f32) -> f32 {
    let a = (low - origin) * inverse;
    let b = (high - origin) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    let t0 = max(max(near.x, near.y), max(near.z, 0.0));
    let t1 = min(min(far.x, far.y), far.z) * 1.00000024;
    return select(HUGE, t0, t0 <= min(t1, t_max));
}

/// (t, second and third barycentric coordinate); t is negative for a miss. Möller and Trumbore 1997, both sides.
fn intersect(origin: vec3<f32>, direction: vec3<f32>, triangle: u32) -> vec3<f32> {
    let t = triangle_at(triangle);
    let e1 = t.b - t.a;
    let e2 = t.c - t.a;
    let p = cross(direction, e2);
    let det = dot(e1, p);
    let s = origin - t.a;
    let u = dot(s, p) / det;
    let q = cross(s, e1);
    let v = dot(direction, q) / det;
    let inside = det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    return vec3<f32>(select(-1.0, dot(e2, q) / det, inside), u, v);
}

/// The nearest hit in (0, t_max).
fn closest(ray: Ray, when: u32) -> Hit {
    return traverse(ray, when, false);
}

/// Anything in (0, t_max)?
fn occluded(ray: Ray, when: u32) -> bool {
    return traverse(ray, when, true).instance != NONE;
}

struct Stack { entries: array<u32, STACK>, top: u32 }

fn push(stack: ptr<function, Stack>, reference: u32) {
    if ((*stack).top < STACK) {
        (*stack).entries[(*stack).top] = reference;
        (*stack).top += 1u;
    } else {
        stack_overflow = true;
    }
}

/// `NONE` when there is nothing above `bottom`.
fn pop(stack: ptr<function, Stack>, bottom: u32) -> u32 {
    if ((*stack).top == bottom) { return NONE; }
    (*stack).top -= 1u;
    return (*stack).entries[(*stack).top];
}

/// Where to go from inner node `id`: the nearer child that the ray enters, with the other on the stack; else what is on the stack.
fn step(table: texture_2d<u32>, id: u32, origin: vec3<f32>, inverse: vec3<f32>, t_max: f32, stack: ptr<function, Stack>, bottom: u32) -> u32 {
    let left = words(table, 4u * id);
    let right = words(table, 4u * id + 2u);
    let t_left = enter(bitcast<vec3<f32>>(left.xyz), floats(table, 4u * id + 1u).xyz, origin, inverse, t_max);
    let t_right = enter(bitcast<vec3<f32>>(right.xyz), floats(table, 4u * id + 3u).xyz, origin, inverse, t_max);
    let swap = t_right < t_left;
    if (max(t_left, t_right) != HUGE) { push(stack, select(right.w, left.w, swap)); }
    if (min(t_left, t_right) == HUGE) { return pop(stack, bottom); }
    return select(left.w, right.w, swap);
}

fn traverse(ray: Ray, when: u32, any: bool) -> Hit {
    var hit = Hit(ray.t_max, NONE, 0u, vec2<f32>(0.0));
    var stack: Stack;
    let inverse = inverse_direction(ray.direction);
    var id = upper_root(when);
    while (id != NONE) {
        while ((id & LEAF) == 0u) { id = upper_step(when, id, ray.origin, inverse, hit.t, &stack); }
        if (id == NONE) { break; }
        descend_instance(ray, id & 0xfffffffu, when, any, &stack, &hit);
        if (any && hit.instance != NONE) { break; }
        id = pop(&stack, 0u);
    }
    return hit;
}

fn upper_root(when: u32) -> u32 {
    @if(moving_objects) {
        if (when != NOW) { return words(tlas_prev, 0u).x; }
    }
    return words(tlas, 0u).x;
}

fn upper_step(when: u32, id: u32, origin: vec3<f32>, inverse: vec3<f32>, t_max: f32, stack: ptr<function, Stack>) -> u32 {
    @if(moving_objects) {
        if (when != NOW) { return step(tlas_prev, id, origin, inverse, t_max, stack, 0u); }
    }
    return step(tlas, id, origin, inverse, t_max, stack, 0u);
}

/// One mesh, in object space; its part of the stack begins where the stack stands.
fn descend_instance(ray: Ray, instance: u32, when: u32, any: bool, stack: ptr<function, Stack>, hit: ptr<function, Hit>) {
    let placed = instance_at(instance, when);
    let origin = point_to_object(placed, ray.origin);
    let direction = vector_to_object(placed, ray.direction);
    let inverse = inverse_direction(direction);
    let bottom = (*stack).top;
    var id = placed.root;
    while (id != NONE) {
        while ((id & LEAF) == 0u) { id = step(nodes, id, origin, inverse, (*hit).t, stack, bottom); }
        if (id == NONE) { break; }
        let first = id & 0xfffffffu;
        let end = first + ((id >> 28u) & 7u) + 1u;
        for (var triangle = first; triangle < end; triangle++) {
            let found = intersect(origin, direction, triangle);
            if (found.x > 0.0 && found.x < (*hit).t) {
                var stopped = true;
                @if(alpha) { stopped = stops(instance, triangle, found.yz, found.x); }
                if (stopped) { *hit = Hit(found.x, instance, triangle, found.yz); }
            }
        }
        if (any && (*hit).instance != NONE) { break; }
        id = pop(stack, bottom);
    }
}
