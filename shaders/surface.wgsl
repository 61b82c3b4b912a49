//! A point that scatters light, and the entry that the g-buffer keeps of it.
//!
//! `Surface` is what every sampling routine works on. `SurfaceRecord` is its 64 bytes in memory: halves for reflectances (a
//! rounding of at most 0.05 %, the same for every technique that reads the record), f32 for places.

import package::base::math::{HUGE, frame_of, max3};
import package::base::pack::{pack_half4, pack_unit, unpack_half4, unpack_unit};
import package::bsdf::{Bsdf, BsdfSample, MIN_ALPHA, bsdf_pdf, bsdf_sample, bsdf_value};
import package::frame::frame::{camera_at};
import package::scene::geometry::{Instance, NONE, info_of, instance_at, normal_to_world, point_to_world, triangle_at, vector_to_world};
import package::scene::material::{Material, material_at};
@if(emissive_meshes) import package::scene::material::{emission_at, stored_material};
@if(unlit) import package::scene::material::{UNLIT};
@if(double_sided) import package::scene::material::{DOUBLE_SIDED};
import package::scene::ray::{Hit, Ray, leave};
@if(normal_maps) import package::base::table::{floats};
@if(normal_maps) import package::scene::material::{interpolate, textured, uvs_of};

struct Surface {
    position: vec3<f32>,
    /// `NOW` or `BEFORE`: the world that the point is in.
    when: u32,
    /// Unit, towards the viewer.
    view: vec3<f32>,
    instance: u32,
    /// Unit shading normal: of the viewer's side, before a normal map bent it.
    normal: vec3<f32>,
    triangle: u32,
    /// Unit normal of the triangle, on the viewer's side.
    geometric: vec3<f32>,
    /// Largest coordinate in the arithmetic that made `position`; see `leave`.
    size: f32,
    barycentrics: vec2<f32>,
    bsdf: Bsdf,
}

struct SurfaceRecord {
    /// World position; where nothing was hit, the unit direction of the camera ray.
    position: vec3<f32>,
    /// `NONE` where nothing was hit.
    instance: u32,
    triangle: u32,
    /// Packed shading normal.
    normal: u32,
    barycentrics: vec2<f32>,
    /// Packed geometric normal, on the viewer's side.
    geometric: u32,
    size: f32,
    /// Halves: base colour and metallic.
    base: vec2<u32>,
    /// Halves: f0 and f90 of the dielectric.
    reflectance: vec2<u32>,
    alpha: f32,
    /// Distance to the camera, metres.
    distance: f32,
}

fn is_surface(r: SurfaceRecord) -> bool {
    return r.instance != NONE;
}

fn pack_surface(s: Surface, distance: f32) -> SurfaceRecord {
    return SurfaceRecord(s.position, s.instance, s.triangle, pack_unit(s.normal), s.barycentrics, pack_unit(s.geometric), s.size,
        pack_half4(vec4<f32>(s.bsdf.base, s.bsdf.metallic)), pack_half4(vec4<f32>(s.bsdf.f0, s.bsdf.f90)), s.bsdf.alpha, distance);
}

fn no_surface(direction: vec3<f32>) -> SurfaceRecord {
    return SurfaceRecord(direction, NONE, 0u, 0u, vec2<f32>(0.0), 0u, 0.0, vec2<u32>(0u), vec2<u32>(0u), 0.0, HUGE);
}

fn unpack_surface(r: SurfaceRecord, when: u32) -> Surface {
    let base = unpack_half4(r.base);
    let reflectance = unpack_half4(r.reflectance);
    let bsdf = Bsdf(base.rgb, base.a, reflectance.rgb, reflectance.a, r.alpha);
    let view = normalize(camera_at(when).position - r.position);
    return Surface(r.position, when, view, r.instance, unpack_unit(r.normal), r.triangle, unpack_unit(r.geometric), r.size, r.barycentrics, bsdf);
}

fn bsdf_of(m: Material) -> Bsdf {
    let f0 = min(m.reflectance * m.specular_color, vec3<f32>(1.0)) * m.specular;
    var lit = 1.0;
    // An unlit surface is shown as its base colour and scatters nothing.
    @if(unlit) { lit = select(1.0, 0.0, (m.flags & UNLIT) != 0u); }
    return Bsdf(m.base_color.rgb * lit, m.metallic * lit, f0 * lit, m.specular * lit, max(m.roughness * m.roughness, MIN_ALPHA));
}

/// Unit normal of the triangle's front side, in the world.
fn front_normal(instance: Instance, triangle: u32) -> vec3<f32> {
    let t = triangle_at(triangle);
    return normalize(normal_to_world(instance, cross(t.b - t.a, t.c - t.a)));
}

/// The surface at a hit of a ray that came along `-view`.
fn surface_at(hit: Hit, view: vec3<f32>, when: u32) -> Surface {
    let instance = instance_at(hit.instance, when);
    let t = triangle_at(hit.triangle);
    let b = hit.barycentrics;
    let position = point_to_world(instance, t.a + b.x * (t.b - t.a) + b.y * (t.c - t.a));
    let front = front_normal(instance, hit.triangle);
    let m = material_at(info_of(hit.triangle).material, hit.triangle, b);
    let n = shading_normal(hit, instance, m, view);
    let reach = abs(instance.to_world_x.xyz) + abs(instance.to_world_y.xyz) + abs(instance.to_world_z.xyz);
    let size = max3(reach) * max(max3(abs(t.a)), max(max3(abs(t.b)), max3(abs(t.c))));
    return Surface(position, when, view, hit.instance, n, hit.triangle, towards(front, view), size, b, bsdf_of(m));
}

fn towards(n: vec3<f32>, view: vec3<f32>) -> vec3<f32> {
    return select(-n, n, dot(n, view) >= 0.0);
}

/// Interpolated, turned to the viewer's side, then bent by the normal map; unit. A bent normal may face away from the viewer: such a
/// point reflects nothing (turning the normal back would let it shine).
fn shading_normal(hit: Hit, instance: Instance, m: Material, view: vec3<f32>) -> vec3<f32> {
    let t = triangle_at(hit.triangle);
    let b = hit.barycentrics;
    let a = unpack_unit(t.na);
    let n = normalize(normal_to_world(instance, a + b.x * (unpack_unit(t.nb) - a) + b.y * (unpack_unit(t.nc) - a)));
    @if(normal_maps) {
        if (m.normal_texture != NONE) {
            let bent = normal_mapped(hit, instance, m, n);
            // Seen from behind, the map is the front's, mirrored in the surface.
            return select(bent - 2.0 * dot(bent, n) * n, bent, dot(n, view) >= 0.0);
        }
    }
    return towards(n, view);
}

/// Tangents with handedness of a triangle's corners, 3 texels a triangle.
@if(normal_maps) @group(0) @binding(0) var triangle_tangents: texture_2d<u32>;

@if(normal_maps) fn normal_mapped(hit: Hit, instance: Instance, m: Material, n: vec3<f32>) -> vec3<f32> {
    let at = 3u * hit.triangle;
    let b = hit.barycentrics;
    let t = interpolate(floats(triangle_tangents, at), floats(triangle_tangents, at + 1u), floats(triangle_tangents, at + 2u), b);
    let along = vector_to_world(instance, t.xyz);
    let tangent = along - n * dot(n, along);
    if (dot(tangent, tangent) <= 0.0) { return n; }
    let hand = select(1.0, -1.0, (t.w < 0.0) != (instance.mirrored != 0u));
    let x = normalize(tangent);
    let y = cross(n, x) * hand;
    let map = textured(m.normal_texture, uvs_of(hit.triangle, b)).xyz * 2.0 - 1.0;
    let bent = x * (map.x * m.normal_scale) + y * (map.y * m.normal_scale) + n * map.z;
    return normalize(bent);
}

/// Radiance that leaves the hit towards `view` because the surface itself emits: front faces, both sides where double-sided.
fn emitted(hit: Hit, view: vec3<f32>, when: u32) -> vec3<f32> {
    @if(emissive_meshes) {
        let id = info_of(hit.triangle).material;
        @if(unlit) {
            if ((stored_material(id).flags & UNLIT) != 0u) { return vec3<f32>(0.0); }
        }
        var shines = dot(front_normal(instance_at(hit.instance, when), hit.triangle), view) > 0.0;
        @if(double_sided) { shines = shines || (stored_material(id).flags & DOUBLE_SIDED) != 0u; }
        if (shines) { return emission_at(id, hit.triangle, hit.barycentrics); }
    }
    return vec3<f32>(0.0);
}

/// What the camera sees of the surface's own: emission, or the base colour of an unlit one.
fn shown(r: SurfaceRecord, view: vec3<f32>, when: u32) -> vec3<f32> {
    let hit = Hit(r.distance, r.instance, r.triangle, r.barycentrics);
    @if(unlit) {
        let m = material_at(info_of(r.triangle).material, r.triangle, r.barycentrics);
        if ((m.flags & UNLIT) != 0u) { return m.base_color.rgb; }
    }
    return emitted(hit, view, when);
}

/// f · cos towards unit `direction`.
fn scatter(s: Surface, direction: vec3<f32>) -> vec3<f32> {
    let f = frame_of(s.normal);
    return bsdf_value(s.bsdf, s.view * f, direction * f);
}

fn scatter_pdf(s: Surface, direction: vec3<f32>) -> f32 {
    let f = frame_of(s.normal);
    return bsdf_pdf(s.bsdf, s.view * f, direction * f);
}

/// A world direction drawn from the BSDF.
fn scatter_sample(s: Surface, u: vec3<f32>) -> BsdfSample {
    let f = frame_of(s.normal);
    var drawn = bsdf_sample(s.bsdf, s.view * f, u);
    drawn.direction = f * drawn.direction;
    return drawn;
}

/// The ray that leaves the surface along unit `direction`.
fn ray_from(s: Surface, direction: vec3<f32>) -> Ray {
    return Ray(leave(s.position, s.geometric, direction, s.size), HUGE, direction);
}
