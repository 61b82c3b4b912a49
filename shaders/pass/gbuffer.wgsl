//! G-buffer by rasterisation.
//!
//! The same ports, film samples and motion as `gbuffer_traced`, without a hierarchy: every triangle of the scene is drawn, and each pixel keeps the
//! number of the nearest one (Burns and Hunt 2013, "The Visibility Buffer"). Only then is the camera ray met with that triangle and its
//! material evaluated, so that where both passes see the same triangle, they store the same bits.
//!
//! The image is shifted by half a pixel less the jitter, which puts this frame's film samples where the rasteriser samples. A rasteriser rounds
//! corners to a fraction of a pixel (1/256 is usual): next to an edge it may take the neighbour. A hit outside of the triangle that
//! was taken is moved to its rim.

import package::base::math::{HUGE};
import package::frame::frame::{NOW, camera_direction, film_sample, frame, index_of, inside};
@if(moving_camera || moving_objects) import package::motion::{motion_of};
import package::scene::geometry::{Instance, NONE, Triangle, instance_at, point_to_object, point_to_world, triangle_at, vector_to_object};
import package::scene::ray::{Hit};
import package::surface::{SurfaceRecord, no_surface, pack_surface, surface_at};
@if(alpha) import package::scene::alpha::{stops};

/// What the pixel sees, 64 bytes.
@group(1) @binding(0) var<storage, read_write> surface: array<SurfaceRecord>;
/// From this frame's film position of the surface to last frame's, pixels, without jitter. (0, 0) where it was behind the camera.
@if(moving_camera || moving_objects) @group(1) @binding(1) var<storage, read_write> motion: array<vec2<f32>>;
/// Number of the instance plus one, and of the triangle; zeros where nothing was drawn.
@group(1) @binding(2) var seen: texture_2d<u32>;

/// Nothing nearer to the pinhole is drawn, metres.
const NEAREST: f32 = 1e-5;

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) instance: u32,
    @location(1) @interpolate(flat) triangle: u32,
}

struct Seen {
    @location(0) seen: vec2<u32>,
    @builtin(frag_depth) depth: f32,
}

@vertex fn corner(@builtin(vertex_index) vertex: u32, @builtin(instance_index) id: u32) -> Corner {
    let instance = instance_at(id, NOW);
    let triangle = instance.first_triangle + vertex / 3u;
    let t = triangle_at(triangle);
    let p = select(select(t.a, t.b, vertex % 3u == 1u), t.c, vertex % 3u == 2u);
    return Corner(clip(instance, point_to_world(instance, p)), id, triangle);
}

/// Clip coordinates in which pixel centres are this frame's film samples.
fn clip(instance: Instance, position: vec3<f32>) -> vec4<f32> {
    let camera = frame.camera;
    // An instance squashed flat has no map back to its own space: no ray can meet it, and it is not drawn.
    if (all(instance.to_object_x.xyz == vec3<f32>(0.0))) { return vec4<f32>(0.0, 0.0, -1.0, 1.0); }
    let d = position - camera.position;
    let z = dot(d, camera.forward);
    let extent = vec2<f32>(frame.extent);
    let shift = (1.0 - 2.0 * vec2<f32>(camera.jitter_x, camera.jitter_y)) / extent;
    let p = vec2<f32>(dot(d, camera.right) * extent.y / extent.x, dot(d, camera.up)) / camera.tan_half_fov;
    return vec4<f32>(p + z * vec2<f32>(shift.x, -shift.y), NEAREST, z);
}

@fragment fn nearest(c: Corner) -> Seen {
    let ray = direction_of(vec2<u32>(c.clip.xy));
    let met = meet(c.instance, c.triangle, ray);
    if (!(met.x > 0.0)) { discard; }
    @if(alpha) {
        if (!stops(c.instance, c.triangle, met.yz, met.x)) { discard; }
    }
    return Seen(vec2<u32>(c.instance + 1u, c.triangle), min(NEAREST / met.x, 1.0));
}

fn direction_of(pixel: vec2<u32>) -> vec3<f32> {
    return camera_direction(frame.camera, film_sample(frame.camera, pixel));
}

/// (t, second and third barycentric coordinate) of the camera ray in the plane of a triangle, by the arithmetic of `trace/bvh2`: where the ray
/// hits, alpha tosses the same coin.
fn meet(id: u32, triangle: u32, direction: vec3<f32>) -> vec3<f32> {
    let instance = instance_at(id, NOW);
    let along = vector_to_object(instance, direction);
    let t = triangle_at(triangle);
    let e1 = t.b - t.a;
    let e2 = t.c - t.a;
    let p = cross(along, e2);
    let det = dot(e1, p);
    let s = point_to_object(instance, frame.camera.position) - t.a;
    let q = cross(s, e1);
    return vec3<f32>(dot(e2, q), dot(s, p), dot(along, q)) / det;
}

/// Of the triangle's rim where the coordinates lie outside.
fn onto(barycentrics: vec2<f32>) -> vec2<f32> {
    let b = max(barycentrics, vec2<f32>(0.0));
    return b / max(b.x + b.y, 1.0);
}

@compute @workgroup_size(8, 8) fn resolve(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let found = textureLoad(seen, id.xy, 0).xy;
    let direction = direction_of(id.xy);
    let at = index_of(id.xy);
    var hit = Hit(HUGE, NONE, 0u, vec2<f32>(0.0));
    if (found.x == 0u) {
        surface[at] = no_surface(direction);
    } else {
        let met = meet(found.x - 1u, found.y, direction);
        hit = Hit(met.x, found.x - 1u, found.y, onto(met.yz));
        surface[at] = pack_surface(surface_at(hit, -direction, NOW), hit.t);
    }
    @if(moving_camera || moving_objects) { motion[at] = motion_of(hit, direction); }
}
