//! Fills slot `trace`: a stack traversal of binary hierarchies, near child first.
//!
//! Two levels: a leaf of the upper one holds one instance, whose mesh's hierarchy is then descended in object space with the
//! direction left unnormalised, so that `t` means the same everywhere. Both children of a node stand together and are tested at
//! once; the stack holds at most one of them a level, and is sized from the levels of the loaded scene. Each level descends to a leaf
//! in a loop of its own (while-while: Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs").
//! @default

import package::scene::geometry::{NONE, instance_at, point_to_object, vector_to_object};
import package::scene::hierarchy::{LEAF, Stack, count_of, first_of, intersect, onto_grid, pop, root_in, step, upper_root, upper_step};
import package::scene::ray::{Hit, Ray};
@if(alpha) import package::scene::alpha::{stops};

/// The inner nodes of all meshes' hierarchies, as `scene/hierarchy` says; their primitives are the scene's triangles.
@group(0) @binding(0) var nodes: texture_2d<u32>;
/// One `Root` an instance: that of its mesh.
@group(0) @binding(1) var roots: texture_2d<u32>;

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
    var stack: Stack;
    let root = upper_root(when);
    let on_grid = onto_grid(root, ray.origin, ray.direction);
    var id = root.reference;
    while (id != NONE) {
        while ((id & LEAF) == 0u) { id = upper_step(when, id, on_grid, hit.t, any, &stack); }
        if (id == NONE) { break; }
        descend_instance(ray, first_of(id), when, any, &stack, &hit);
        if (any && hit.instance != NONE) { break; }
        id = pop(&stack, 0u);
    }
    return hit;
}

/// One mesh, in object space; its part of the stack begins where the stack stands.
fn descend_instance(ray: Ray, instance: u32, when: u32, any: bool, stack: ptr<function, Stack>, hit: ptr<function, Hit>) {
    let placed = instance_at(instance, when);
    let origin = point_to_object(placed, ray.origin);
    let direction = vector_to_object(placed, ray.direction);
    let root = root_in(roots, instance);
    let on_grid = onto_grid(root, origin, direction);
    let bottom = (*stack).top;
    var id = root.reference;
    while (id != NONE) {
        while ((id & LEAF) == 0u) { id = step(nodes, id, on_grid, (*hit).t, any, stack, bottom); }
        if (id == NONE) { break; }
        let first = first_of(id);
        let end = first + count_of(id);
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
