//! Fills slot `trace`: a stack traversal of binary hierarchies, near child first.
//!
//! Two levels: a leaf of the upper one holds one instance, whose mesh's hierarchy is then descended in object space with the
//! direction left unnormalised, so that `t` means the same everywhere. The boxes are tested at the parent; the stack holds at
//! most one node a level, and is sized from the levels of the loaded scene.
//! @default

import package::base::math::{HUGE};
import package::frame::frame::{NOW};
import package::scene::geometry::{Instance, NONE, instance_at, point_to_object, triangles, vector_to_object};
import package::scene::limits::{STACK};
import package::scene::ray::{Hit, Ray};
@if(alpha) import package::scene::alpha::{stops};

/// `count` is 0 for inner nodes: their children are `first` and `first + 1`. A leaf holds primitives `first` to `first + count`.
struct Node { low: vec3<f32>, first: u32, high: vec3<f32>, count: u32 }

@group(0) @binding(0) var<storage, read> nodes: array<Node>;
@group(0) @binding(1) var<storage, read> tlas: array<Node>;
@if(moving_objects) @group(0) @binding(2) var<storage, read> tlas_prev: array<Node>;

/// Set when a push found the stack full, which the size of the stack rules out.
var<private> stack_overflow: bool;

fn tlas_node(id: u32, when: u32) -> Node {
    @if(moving_objects) {
        if (when != NOW) { return tlas_prev[id]; }
    }
    return tlas[id];
}

/// No component is infinite: 0 · ∞ would be NaN where an origin lies on a slab.
fn inverse_direction(d: vec3<f32>) -> vec3<f32> {
    let tiny = vec3<f32>(1e-30);
    return 1.0 / select(d, select(-tiny, tiny, d >= vec3<f32>(0.0)), abs(d) < tiny);
}

/// Distance at which the ray enters the box, or `HUGE`. The far side is widened by 2 ulp (Ize 2013, "Robust BVH Ray Traversal").
fn enter(n: Node, origin: vec3<f32>, inverse: vec3<f32>, t_max: f32) -> f32 {
    let a = (n.low - origin) * inverse;
    let b = (n.high - origin) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    let t0 = max(max(near.x, near.y), max(near.z, 0.0));
    let t1 = min(min(far.x, far.y), far.z) * 1.00000024;
    return select(HUGE, t0, t0 <= min(t1, t_max));
}

/// (t, second and third barycentric coordinate); t is negative for a miss. Möller and Trumbore 1997, both sides.
fn intersect(origin: vec3<f32>, direction: vec3<f32>, triangle: u32) -> vec3<f32> {
    let t = triangles[triangle];
    let e1 = t.b - t.a;
    let e2 = t.c - t.a;
    let p = cross(direction, e2);
    let det = dot(e1, p);
    if (det == 0.0) { return vec3<f32>(-1.0, 0.0, 0.0); }
    let s = origin - t.a;
    let u = dot(s, p) / det;
    let q = cross(s, e1);
    let v = dot(direction, q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) { return vec3<f32>(-1.0, 0.0, 0.0); }
    return vec3<f32>(dot(e2, q) / det, u, v);
}

/// The nearest hit in (0, t_max).
fn closest(ray: Ray, when: u32) -> Hit {
    return traverse(ray, when, false);
}

/// Anything in (0, t_max)?
fn occluded(ray: Ray, when: u32) -> bool {
    return traverse(ray, when, true).instance != NONE;
}

fn traverse(ray: Ray, when: u32, any: bool) -> Hit {
    var hit = Hit(ray.t_max, NONE, 0u, vec2<f32>(0.0));
    var stack: array<u32, STACK>;
    var top = 0u;
    let inverse = inverse_direction(ray.direction);
    var id = 0u;
    loop {
        let n = tlas_node(id, when);
        if (n.count == 0u) {
            let near = descend(tlas_node(n.first, when), tlas_node(n.first + 1u, when), n.first, ray.origin, inverse, hit.t);
            if (near.y != NONE) { push(&stack, &top, near.y); }
            if (near.x != NONE) {
                id = near.x;
                continue;
            }
        } else {
            descend_instance(ray, n.first, when, any, &stack, top, &hit);
            if (any && hit.instance != NONE) { return hit; }
        }
        if (top == 0u) { return hit; }
        top -= 1u;
        id = stack[top];
    }
    return hit;
}

/// Children to visit, nearer first; `NONE` for those that are missed.
fn descend(left: Node, right: Node, first: u32, origin: vec3<f32>, inverse: vec3<f32>, t_max: f32) -> vec2<u32> {
    let t_left = enter(left, origin, inverse, t_max);
    let t_right = enter(right, origin, inverse, t_max);
    let swap = t_right < t_left;
    let near = select(first, first + 1u, swap);
    let far = select(first + 1u, first, swap);
    return vec2<u32>(select(near, NONE, min(t_left, t_right) == HUGE), select(far, NONE, max(t_left, t_right) == HUGE));
}

fn push(stack: ptr<function, array<u32, STACK>>, top: ptr<function, u32>, id: u32) {
    if (*top < STACK) {
        (*stack)[*top] = id;
        *top += 1u;
    } else {
        stack_overflow = true;
    }
}

/// One mesh, in object space; its part of the stack begins at `bottom`.
fn descend_instance(ray: Ray, id: u32, when: u32, any: bool, stack: ptr<function, array<u32, STACK>>, bottom: u32, hit: ptr<function, Hit>) {
    let instance = instance_at(id, when);
    let origin = point_to_object(instance, ray.origin);
    let direction = vector_to_object(instance, ray.direction);
    let inverse = inverse_direction(direction);
    var top = bottom;
    var node = instance.root;
    loop {
        let n = nodes[node];
        if (n.count == 0u) {
            let first = instance.root + n.first;
            let near = descend(nodes[first], nodes[first + 1u], first, origin, inverse, (*hit).t);
            if (near.y != NONE) { push(stack, &top, near.y); }
            if (near.x != NONE) {
                node = near.x;
                continue;
            }
        } else {
            for (var i = 0u; i < n.count; i++) {
                let triangle = instance.first_triangle + n.first + i;
                let found = intersect(origin, direction, triangle);
                if (found.x > 0.0 && found.x < (*hit).t) {
                    var stopped = true;
                    @if(alpha) { stopped = stops(id, triangle, found.yz, found.x); }
                    if (stopped) {
                        *hit = Hit(found.x, id, triangle, found.yz);
                        if (any) { return; }
                    }
                }
            }
        }
        if (top == bottom) { return; }
        top -= 1u;
        node = (*stack)[top];
    }
}
