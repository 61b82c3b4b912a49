//! Triangles and where they stand. Triangles are in the order of the leaves of their mesh's hierarchy.

import package::base::table::{floats, words};
import package::frame::frame::{NOW};

/// Three corners in object space, each with its packed shading normal.
struct Triangle { a: vec3<f32>, na: u32, b: vec3<f32>, nb: u32, c: vec3<f32>, nc: u32 }

/// What a triangle is made of.
struct TriangleInfo {
    material: u32,
    /// Its place among the emissive triangles of its mesh; `NONE` where it does not emit.
    emissive: u32,
}

/// A mesh in the world. Rows of affine maps: dot(row, vec4(p, 1)).
struct Instance {
    to_world_x: vec4<f32>, to_world_y: vec4<f32>, to_world_z: vec4<f32>,
    to_object_x: vec4<f32>, to_object_y: vec4<f32>, to_object_z: vec4<f32>,
    /// Index of the mesh's first triangle.
    first_triangle: u32,
    /// Index of the light made of the mesh's first emissive triangle.
    first_light: u32,
    /// 1 where the map to the world mirrors: front faces are then clockwise in object space.
    mirrored: u32,
}

const NONE: u32 = 0xffffffffu;

/// Of `Triangle`, 3 texels each.
@group(0) @binding(0) var triangles: texture_2d<u32>;
/// Of `TriangleInfo`, two a texel.
@group(0) @binding(1) var triangle_infos: texture_2d<u32>;
/// Of `Instance`, 7 texels each.
@group(0) @binding(2) var instances: texture_2d<u32>;
/// The same instances last frame.
@if(moving_objects) @group(0) @binding(3) var instances_prev: texture_2d<u32>;

fn triangle_at(id: u32) -> Triangle {
    let a = words(triangles, 3u * id);
    let b = words(triangles, 3u * id + 1u);
    let c = words(triangles, 3u * id + 2u);
    return Triangle(bitcast<vec3<f32>>(a.xyz), a.w, bitcast<vec3<f32>>(b.xyz), b.w, bitcast<vec3<f32>>(c.xyz), c.w);
}

fn info_of(triangle: u32) -> TriangleInfo {
    let two = words(triangle_infos, triangle / 2u);
    let one = select(two.xy, two.zw, (triangle & 1u) != 0u);
    return TriangleInfo(one.x, one.y);
}

fn instance_at(id: u32, when: u32) -> Instance {
    @if(moving_objects) {
        if (when != NOW) { return instance_in(instances_prev, id); }
    }
    return instance_in(instances, id);
}

fn instance_in(table: texture_2d<u32>, id: u32) -> Instance {
    let at = 7u * id;
    let last = words(table, at + 6u);
    return Instance(
        floats(table, at), floats(table, at + 1u), floats(table, at + 2u),
        floats(table, at + 3u), floats(table, at + 4u), floats(table, at + 5u),
        last.x, last.y, last.z,
    );
}

/// False where the map to the world squashes the mesh flat: nothing can hit it. The host then leaves the inverse zeros.
fn is_solid(i: Instance) -> bool {
    return any(i.to_object_x.xyz != vec3<f32>(0.0));
}

fn point_to_world(i: Instance, p: vec3<f32>) -> vec3<f32> {
    let q = vec4<f32>(p, 1.0);
    return vec3<f32>(dot(i.to_world_x, q), dot(i.to_world_y, q), dot(i.to_world_z, q));
}

fn point_to_object(i: Instance, p: vec3<f32>) -> vec3<f32> {
    let q = vec4<f32>(p, 1.0);
    return vec3<f32>(dot(i.to_object_x, q), dot(i.to_object_y, q), dot(i.to_object_z, q));
}

fn vector_to_world(i: Instance, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(i.to_world_x.xyz, v), dot(i.to_world_y.xyz, v), dot(i.to_world_z.xyz, v));
}

fn vector_to_object(i: Instance, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(i.to_object_x.xyz, v), dot(i.to_object_y.xyz, v), dot(i.to_object_z.xyz, v));
}

/// Normals go by the inverse transpose. Not unit.
fn normal_to_world(i: Instance, n: vec3<f32>) -> vec3<f32> {
    return n.x * i.to_object_x.xyz + n.y * i.to_object_y.xyz + n.z * i.to_object_z.xyz;
}

/// World position of a point of a triangle.
fn position_of(instance: u32, triangle: u32, barycentrics: vec2<f32>, when: u32) -> vec3<f32> {
    let t = triangle_at(triangle);
    let p = t.a + barycentrics.x * (t.b - t.a) + barycentrics.y * (t.c - t.a);
    return point_to_world(instance_at(instance, when), p);
}
