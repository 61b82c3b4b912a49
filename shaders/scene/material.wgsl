//! Materials as stored, and their values at a point of a triangle.

@if(textures) import package::scene::texture::{sample_texture};
@if(vertex_colors) import package::base::pack::{unpack_half4};
import package::base::table::{floats, words};
import package::scene::geometry::{NONE};

/// glTF metallic-roughness with KHR_materials_ior, specular, emissive_strength, unlit.
struct Material {
    base_color: vec4<f32>,
    /// Radiance, W·m⁻²·sr⁻¹.
    emission: vec3<f32>,
    /// Bit 0 double-sided, 1 unlit, 2 alpha mask, 3 alpha blend.
    flags: u32,
    specular_color: vec3<f32>,
    specular: f32,
    metallic: f32,
    roughness: f32,
    /// ((ior − 1) / (ior + 1))².
    reflectance: f32,
    alpha_cutoff: f32,
    /// Indices into `textures`; `NONE` where there is none.
    base_color_texture: u32,
    metallic_roughness_texture: u32,
    emission_texture: u32,
    normal_texture: u32,
    normal_scale: f32,
}

const DOUBLE_SIDED: u32 = 1u;
const UNLIT: u32 = 2u;
const ALPHA_MASK: u32 = 4u;
const ALPHA_BLEND: u32 = 8u;

/// Texture coordinates of a triangle's corners, both sets.
struct TriangleUvs { a: vec4<f32>, b: vec4<f32>, c: vec4<f32> }

/// Of `Material`, 6 texels each.
@group(0) @binding(0) var materials: texture_2d<u32>;
/// Of `TriangleUvs`, 3 texels each.
@if(textures) @group(0) @binding(1) var triangle_uvs: texture_2d<u32>;
/// Linear RGBA halves of the corners, 2 texels a triangle.
@if(vertex_colors) @group(0) @binding(2) var triangle_colors: texture_2d<u32>;

/// As it is stored, without textures and vertex colours.
fn stored_material(id: u32) -> Material {
    let at = 6u * id;
    let emission = words(materials, at + 1u);
    let specular = floats(materials, at + 2u);
    let rest = floats(materials, at + 3u);
    let textures = words(materials, at + 4u);
    return Material(
        floats(materials, at), bitcast<vec3<f32>>(emission.xyz), emission.w, specular.xyz, specular.w, rest.x, rest.y, rest.z, rest.w,
        textures.x, textures.y, textures.z, textures.w, floats(materials, at + 5u).x,
    );
}

fn interpolate(a: vec4<f32>, b: vec4<f32>, c: vec4<f32>, barycentrics: vec2<f32>) -> vec4<f32> {
    return a + barycentrics.x * (b - a) + barycentrics.y * (c - a);
}

/// (u0, v0, u1, v1).
@if(textures) fn uvs_of(triangle: u32, barycentrics: vec2<f32>) -> vec4<f32> {
    let at = 3u * triangle;
    return interpolate(floats(triangle_uvs, at), floats(triangle_uvs, at + 1u), floats(triangle_uvs, at + 2u), barycentrics);
}

@if(vertex_colors) fn vertex_color(triangle: u32, barycentrics: vec2<f32>) -> vec4<f32> {
    let both = words(triangle_colors, 2u * triangle);
    let third = words(triangle_colors, 2u * triangle + 1u).xy;
    return interpolate(unpack_half4(both.xy), unpack_half4(both.zw), unpack_half4(third), barycentrics);
}

@if(textures) fn textured(id: u32, uvs: vec4<f32>) -> vec4<f32> {
    if (id == NONE) { return vec4<f32>(1.0); }
    return sample_texture(id, uvs.xy, uvs.zw);
}

/// The material with its textures and vertex colours applied at one point.
fn material_at(id: u32, triangle: u32, barycentrics: vec2<f32>) -> Material {
    var m = stored_material(id);
    @if(textures) {
        let uvs = uvs_of(triangle, barycentrics);
        m.base_color *= textured(m.base_color_texture, uvs);
        let mr = textured(m.metallic_roughness_texture, uvs);
        m.roughness *= mr.g;
        m.metallic *= mr.b;
        m.emission *= textured(m.emission_texture, uvs).rgb;
    }
    @if(vertex_colors) {
        m.base_color *= vertex_color(triangle, barycentrics);
    }
    return m;
}

/// Emitted radiance alone, for lights.
fn emission_at(id: u32, triangle: u32, barycentrics: vec2<f32>) -> vec3<f32> {
    let m = stored_material(id);
    var emission = m.emission;
    @if(textures) {
        emission *= textured(m.emission_texture, uvs_of(triangle, barycentrics)).rgb;
    }
    return emission;
}

/// Opacity at a point: 0 or 1 for masks.
@if(alpha) fn opacity_at(id: u32, triangle: u32, barycentrics: vec2<f32>) -> f32 {
    let m = stored_material(id);
    if ((m.flags & (ALPHA_MASK | ALPHA_BLEND)) == 0u) { return 1.0; }
    var alpha = m.base_color.a;
    @if(textures) {
        alpha *= textured(m.base_color_texture, uvs_of(triangle, barycentrics)).a;
    }
    @if(vertex_colors) {
        alpha *= vertex_color(triangle, barycentrics).a;
    }
    if ((m.flags & ALPHA_MASK) != 0u) { return select(0.0, 1.0, alpha >= m.alpha_cutoff); }
    return alpha;
}
