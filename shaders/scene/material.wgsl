//! Materials as stored, and their values at a point of a triangle.

@if(textures) import package::scene::texture::{sample_texture};
@if(vertex_colors) import package::base::pack::{unpack_half4};
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

@group(0) @binding(0) var<storage, read> materials: array<Material>;
@if(textures) @group(0) @binding(1) var<storage, read> triangle_uvs: array<TriangleUvs>;
/// Linear RGBA halves of the corners.
@if(vertex_colors) @group(0) @binding(2) var<storage, read> triangle_colors: array<array<vec2<u32>, 3>>;

fn interpolate(a: vec4<f32>, b: vec4<f32>, c: vec4<f32>, barycentrics: vec2<f32>) -> vec4<f32> {
    return a + barycentrics.x * (b - a) + barycentrics.y * (c - a);
}

/// (u0, v0, u1, v1).
@if(textures) fn uvs_of(triangle: u32, barycentrics: vec2<f32>) -> vec4<f32> {
    let t = triangle_uvs[triangle];
    return interpolate(t.a, t.b, t.c, barycentrics);
}

@if(textures) fn textured(id: u32, uvs: vec4<f32>) -> vec4<f32> {
    if (id == NONE) { return vec4<f32>(1.0); }
    return sample_texture(id, uvs.xy, uvs.zw);
}

/// The material with its textures and vertex colours applied at one point.
fn material_at(id: u32, triangle: u32, barycentrics: vec2<f32>) -> Material {
    var m = materials[id];
    @if(textures) {
        let uvs = uvs_of(triangle, barycentrics);
        m.base_color *= textured(m.base_color_texture, uvs);
        let mr = textured(m.metallic_roughness_texture, uvs);
        m.roughness *= mr.g;
        m.metallic *= mr.b;
        m.emission *= textured(m.emission_texture, uvs).rgb;
    }
    @if(vertex_colors) {
        let c = triangle_colors[triangle];
        m.base_color *= interpolate(unpack_half4(c[0]), unpack_half4(c[1]), unpack_half4(c[2]), barycentrics);
    }
    return m;
}

/// Emitted radiance alone, for lights.
fn emission_at(id: u32, triangle: u32, barycentrics: vec2<f32>) -> vec3<f32> {
    var emission = materials[id].emission;
    @if(textures) {
        emission *= textured(materials[id].emission_texture, uvs_of(triangle, barycentrics)).rgb;
    }
    return emission;
}

/// Opacity at a point: 0 or 1 for masks.
@if(alpha) fn opacity_at(id: u32, triangle: u32, barycentrics: vec2<f32>) -> f32 {
    let flags = materials[id].flags;
    if ((flags & (ALPHA_MASK | ALPHA_BLEND)) == 0u) { return 1.0; }
    var alpha = materials[id].base_color.a;
    @if(textures) {
        alpha *= textured(materials[id].base_color_texture, uvs_of(triangle, barycentrics)).a;
    }
    @if(vertex_colors) {
        let c = triangle_colors[triangle];
        alpha *= interpolate(unpack_half4(c[0]), unpack_half4(c[1]), unpack_half4(c[2]), barycentrics).a;
    }
    if ((flags & ALPHA_MASK) != 0u) { return select(0.0, 1.0, alpha >= materials[id].alpha_cutoff); }
    return alpha;
}
