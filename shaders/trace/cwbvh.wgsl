//! Fills slot `trace`: compressed wide hierarchies of the meshes (Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs"), eight children a node, under the binary upper level.
//!
//! A node is 80 bytes as obvhs lays them out. Its children's boxes are bytes on a grid of the node's own: plane q of an axis lies at
//! p + q · 2^e, so the ray meets it at q · a + b with a = 2^e / d and b = (p − o) / d. Hits are bits: of inner children bits 24 to 31, in the
//! order in which the ray's octant meets them; of leaf children one bit a triangle below.

import package::base::table::{word, words};
import package::scene::geometry::{NONE, instance_at, point_to_object, vector_to_object};
import package::scene::hierarchy::{LEAF, Stack, first_of, intersect, inverse_direction, onto_grid, pop, stack_overflow, upper_root, upper_step};
import package::scene::limits::{STACK};
import package::scene::ray::{Hit, Ray};
@if(alpha) import package::scene::alpha::{stops};

/// The nodes of all meshes, 5 texels each.
@group(0) @binding(0) var wide_nodes: texture_2d<u32>;
/// Triangles in the order of the leaves, four a texel.
@group(0) @binding(1) var wide_order: texture_2d<u32>;
/// One an instance: where its mesh begins in `wide_nodes` and in `wide_order`.
@group(0) @binding(2) var wide_roots: texture_2d<u32>;

/// Rounding of q · a + b, as a share of 255 · |a| + |b|: planes are put off by it.
const SLACK: f32 = 2.4e-7;

/// A ray as a node sees it.
struct Seen { origin: vec3<f32>, inverse: vec3<f32>, octant: u32 }

/// Nodes of one parent that are left to visit: index of its first child, and hits in bits 24 to 31 over the mask of inner children.
struct Group { base: u32, hits: u32 }

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
        descend_instance(ray, first_of(id), when, any, &hit);
        if (any && hit.instance != NONE) { break; }
        id = pop(&stack, 0u);
    }
    return hit;
}

/// One mesh, in object space.
fn descend_instance(ray: Ray, instance: u32, when: u32, any: bool, hit: ptr<function, Hit>) {
    let placed = instance_at(instance, when);
    let first = words(wide_roots, instance);
    let origin = point_to_object(placed, ray.origin);
    let direction = vector_to_object(placed, ray.direction);
    let bits = select(vec3<u32>(0x04040404u, 0x02020202u, 0x01010101u), vec3<u32>(0u), direction < vec3<f32>(0.0));
    let seen = Seen(origin, inverse_direction(direction), bits.x | bits.y | bits.z);
    var stack: array<vec2<u32>, STACK>;
    var top = 0u;
    // The root, as if it were the only child of a node.
    var group = Group(first.x, 0x80000000u);
    loop {
        let place = firstLeadingBit(group.hits);
        let slot = (place - 24u) ^ (seen.octant & 7u);
        let node = group.base + countOneBits(group.hits & ((1u << slot) - 1u));
        group.hits &= ~(1u << place);
        if (group.hits >= 0x1000000u) {
            if (top == STACK) { stack_overflow = true; } else { stack[top] = vec2<u32>(group.base, group.hits); top += 1u; }
        }
        let head = words(wide_nodes, 5u * node);
        let links = words(wide_nodes, 5u * node + 1u);
        let found = entered(node, head, links.zw, seen, (*hit).t);
        group = Group(first.x + links.x, (found & 0xff000000u) | (head.w >> 24u));
        var left = found & 0xffffffu;
        while (left != 0u) {
            let at = firstLeadingBit(left);
            left &= ~(1u << at);
            let triangle = placed.first_triangle + word(wide_order, first.y + links.y + at);
            let met = intersect(origin, direction, triangle);
            if (met.x > 0.0 && met.x < (*hit).t) {
                var stopped = true;
                @if(alpha) { stopped = stops(instance, triangle, met.yz, met.x); }
                if (stopped) { *hit = Hit(met.x, instance, triangle, met.yz); }
            }
        }
        if (any && (*hit).instance != NONE) { break; }
        if (group.hits < 0x1000000u) {
            if (top == 0u) { break; }
            top -= 1u;
            group = Group(stack[top].x, stack[top].y);
        }
    }
}

/// Which children the ray enters, as hits.
fn entered(node: u32, head: vec4<u32>, kinds: vec2<u32>, seen: Seen, t_max: f32) -> u32 {
    let exponents = (vec3<u32>(head.w) >> vec3<u32>(0u, 8u, 16u)) & vec3<u32>(255u);
    let a = bitcast<vec3<f32>>(exponents << vec3<u32>(23u)) * seen.inverse;
    let b = (bitcast<vec3<f32>>(head.xyz) - seen.origin) * seen.inverse;
    let x = words(wide_nodes, 5u * node + 2u);
    let y = words(wide_nodes, 5u * node + 3u);
    let z = words(wide_nodes, 5u * node + 4u);
    return half(kinds.x, vec2<u32>(x.x, x.z), vec2<u32>(y.x, y.z), vec2<u32>(z.x, z.z), a, b, seen, t_max)
        | half(kinds.y, vec2<u32>(x.y, x.w), vec2<u32>(y.y, y.w), vec2<u32>(z.y, z.w), a, b, seen, t_max);
}

/// Four of the children: their lower and upper planes by axis, a byte each.
fn half(kinds: u32, x: vec2<u32>, y: vec2<u32>, z: vec2<u32>, a: vec3<f32>, b: vec3<f32>, seen: Seen, t_max: f32) -> u32 {
    let back = seen.inverse < vec3<f32>(0.0);
    let slack = SLACK * (255.0 * abs(a) + abs(b));
    let near_b = b - slack;
    let far_b = b + slack;
    let near = max(
        max(planes(select(x.x, x.y, back.x), a.x, near_b.x), planes(select(y.x, y.y, back.y), a.y, near_b.y)),
        max(planes(select(z.x, z.y, back.z), a.z, near_b.z), vec4<f32>(0.0)),
    );
    let far = min(
        min(planes(select(x.y, x.x, back.x), a.x, far_b.x), planes(select(y.y, y.x, back.y), a.y, far_b.y)),
        min(planes(select(z.y, z.x, back.z), a.z, far_b.z), vec4<f32>(t_max)),
    );
    // Of inner children bits 3 and 4 are set: their place goes by the octant. Of leaves there are as many bits as triangles.
    let inner = (((kinds & (kinds << 1u)) & 0x10101010u) >> 4u) * 255u;
    let places = unpack4xU8((kinds ^ (seen.octant & inner)) & 0x1f1f1f1fu);
    let bits = unpack4xU8((kinds >> 5u) & 0x07070707u);
    let hits = select(vec4<u32>(0u), bits << places, near <= far);
    return hits.x | hits.y | hits.z | hits.w;
}

/// Where the ray meets four planes.
fn planes(bytes: u32, a: f32, b: f32) -> vec4<f32> {
    return vec4<f32>(unpack4xU8(bytes)) * a + b;
}
