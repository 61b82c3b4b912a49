//! Binary hierarchies of boxes, the upper level of the scene's, and where rays meet triangles: what the fillings of slot `trace` share.
//!
//! An inner node is 2 texels of a table, one a child: lower plane (16 bits) and upper plane by axis, and a reference. Planes are those of a
//! grid over the whole hierarchy; the ray meets plane q at q · a + b with a = step / d and b = (low − o) / d. A reference is the index of an inner node,
//! or of a leaf's first primitive with `LEAF` set and the number of its primitives less 1 in bits 28 to 30.

import package::base::math::{HUGE};
import package::base::table::{floats, words};
import package::frame::frame::{NOW};
import package::scene::geometry::{NONE, triangle_at};
import package::scene::limits::{STACK};

/// Of instances, one a leaf. In place of node 0 stands its `Root`.
@group(0) @binding(0) var tlas: texture_2d<u32>;
/// The same last frame.
@if(moving_objects) @group(0) @binding(1) var tlas_prev: texture_2d<u32>;

const LEAF: u32 = 0x80000000u;

/// Set when a push found the stack full, which the size of the stack rules out.
var<private> stack_overflow: bool;

/// The primitive of a leaf, its first.
fn first_of(leaf: u32) -> u32 {
    return leaf & 0xfffffffu;
}

fn count_of(leaf: u32) -> u32 {
    return ((leaf >> 28u) & 7u) + 1u;
}

/// No component is infinite: 0 · ∞ would be NaN where an origin lies on a slab.
fn inverse_direction(d: vec3<f32>) -> vec3<f32> {
    let tiny = vec3<f32>(1e-30);
    return 1.0 / select(d, select(-tiny, tiny, d >= vec3<f32>(0.0)), abs(d) < tiny);
}

/// A hierarchy as a table has it in 2 texels: the grid's origin, its step, and a reference to the root, `NONE` where nothing can be hit.
struct Root { low: vec3<f32>, reference: u32, step: vec3<f32> }

fn root_in(table: texture_2d<u32>, at: u32) -> Root {
    let first = words(table, 2u * at);
    return Root(bitcast<vec3<f32>>(first.xyz), first.w, floats(table, 2u * at + 1u).xyz);
}

/// A ray as a grid has it.
struct GridRay { a: vec3<f32>, b: vec3<f32>, slack: vec3<f32> }

/// Rounding of q · a + b, as a share of 65535 · |a| + |b|.
const ROUNDING: f32 = 2.4e-7;

fn onto_grid(root: Root, origin: vec3<f32>, direction: vec3<f32>) -> GridRay {
    let inverse = inverse_direction(direction);
    let a = root.step * inverse;
    let b = (root.low - origin) * inverse;
    return GridRay(a, b, ROUNDING * (65535.0 * abs(a) + abs(b)));
}

/// Distance at which the ray enters a child's box, or `HUGE`.
fn enter(child: vec4<u32>, ray: GridRay, t_max: f32) -> f32 {
    let p = vec3<f32>(child.xyz & vec3<u32>(0xffffu)) * ray.a + ray.b;
    let q = vec3<f32>(child.xyz >> vec3<u32>(16u)) * ray.a + ray.b;
    let near = min(p, q) - ray.slack;
    let far = max(p, q) + ray.slack;
    let t0 = max(max(near.x, near.y), max(near.z, 0.0));
    let t1 = min(min(far.x, far.y), min(far.z, t_max));
    return select(HUGE, t0, t0 <= t1);
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

/// References to what is left to visit.
struct Stack { entries: array<u32, STACK>, top: u32 }

/// `NONE` when there is nothing above `bottom`.
fn pop(stack: ptr<function, Stack>, bottom: u32) -> u32 {
    if ((*stack).top == bottom) { return NONE; }
    (*stack).top -= 1u;
    return (*stack).entries[(*stack).top];
}

/// Where to go from inner node `id`: the nearer child that the ray enters, with the other on the stack; else what is on the stack. Where any
/// hit will do, the left child goes first. Without branches: lavapipe computes both sides of each.
fn step(table: texture_2d<u32>, id: u32, ray: GridRay, t_max: f32, any: bool, stack: ptr<function, Stack>, bottom: u32) -> u32 {
    let left = words(table, 2u * id);
    let right = words(table, 2u * id + 1u);
    let t_left = enter(left, ray, t_max);
    let t_right = enter(right, ray, t_max);
    let swap = select(t_right < t_left, t_left == HUGE, any);
    let both = max(t_left, t_right) != HUGE;
    let none = min(t_left, t_right) == HUGE;
    let top = (*stack).top;
    if (both && top == STACK) { stack_overflow = true; }
    // What lies above the top counts for nothing.
    (*stack).entries[min(top, STACK - 1u)] = select(right.w, left.w, swap);
    let now = min(top + u32(both), STACK);
    let empty = now == bottom;
    let popped = select((*stack).entries[max(now, 1u) - 1u], NONE, empty);
    (*stack).top = now - u32(none && !empty);
    return select(select(left.w, right.w, swap), popped, none);
}

fn upper_root(when: u32) -> Root {
    @if(moving_objects) {
        if (when != NOW) { return root_in(tlas_prev, 0u); }
    }
    return root_in(tlas, 0u);
}

fn upper_step(when: u32, id: u32, ray: GridRay, t_max: f32, any: bool, stack: ptr<function, Stack>) -> u32 {
    @if(moving_objects) {
        if (when != NOW) { return step(tlas_prev, id, ray, t_max, any, stack, 0u); }
    }
    return step(tlas, id, ray, t_max, any, stack, 0u);
}
