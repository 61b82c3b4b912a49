//! The glTF 2.0 metallic-roughness BSDF (specification, Appendix B), with KHR_materials_ior and KHR_materials_specular.
//!
//! Directions are local: z is the shading normal, on the side of the viewer; both v and l point away from the surface.
//!
//!   f = (1 − metallic) · [(1 − max F_d) · base/π + F_d · D·V]  +  metallic · F_m · D·V
//!   F_d = f0 + (f90 − f0)(1 − v·h)⁵      f0 = min(((ior−1)/(ior+1))² · specular_color, 1) · specular,  f90 = specular
//!   F_m = base + (1 − base)(1 − v·h)⁵
//!   D   = GGX, α = roughness²; V = height-correlated Smith masking-shadowing / (4 n·l n·v)
//!
//! D is written with h's own x and y, which keeps its digits where α → 0: (n·h)² (α² − 1) + 1 would cancel.
//! Sampling: one of two lobes, cosine (diffuse) or visible normals (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals
//! with Spherical Caps"); the pdf is that of the mixture. Directions below the horizon are kept as samples of value 0.

import package::base::math::{PI, INV_PI, luminance, max3, square};
import package::base::sampling::{sample_cosine, pdf_cosine};

struct Bsdf {
    base: vec3<f32>,
    metallic: f32,
    /// Dielectric reflectance at normal incidence.
    f0: vec3<f32>,
    /// Dielectric reflectance at grazing incidence.
    f90: f32,
    alpha: f32,
}

struct BsdfSample {
    direction: vec3<f32>,
    /// By solid angle; 0 when nothing was drawn.
    pdf: f32,
    /// f · cos.
    value: vec3<f32>,
}

/// The least α: roughness 0.01. Below it a reflection is narrower than f32 directions resolve.
const MIN_ALPHA: f32 = 1e-4;

fn schlick(f0: vec3<f32>, f90: vec3<f32>, cos_theta: f32) -> vec3<f32> {
    let m = clamp(1.0 - cos_theta, 0.0, 1.0);
    let m2 = m * m;
    return f0 + (f90 - f0) * (m2 * m2 * m);
}

fn ggx(h: vec3<f32>, alpha: f32) -> f32 {
    let s = square(h.x / alpha) + square(h.y / alpha) + h.z * h.z;
    return 1.0 / (PI * alpha * alpha * s * s);
}

/// n·x + √(α² + (1 − α²)(n·x)²): twice the denominator of Smith's G1 over 2 n·x.
fn smith(cos_theta: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    return cos_theta + sqrt(a2 + (1.0 - a2) * cos_theta * cos_theta);
}

/// Height-correlated G2 / (4 n·l n·v).
fn visibility(cos_v: f32, cos_l: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let by_v = cos_l * sqrt(a2 + (1.0 - a2) * cos_v * cos_v);
    let by_l = cos_v * sqrt(a2 + (1.0 - a2) * cos_l * cos_l);
    return 0.5 / (by_v + by_l);
}

/// f · cos of the direction l.
fn bsdf_value(b: Bsdf, v: vec3<f32>, l: vec3<f32>) -> vec3<f32> {
    if (v.z <= 0.0 || l.z <= 0.0) { return vec3<f32>(0.0); }
    var diffuse = b.base;
    var specular = vec3<f32>(0.0);
    @if(glossy) {
        let h = normalize(v + l);
        let f_d = schlick(b.f0, vec3<f32>(b.f90), dot(v, h));
        diffuse = (1.0 - b.metallic) * (1.0 - max3(f_d)) * b.base;
        specular = reflected(b, f_d, dot(v, h)) * (ggx(h, b.alpha) * visibility(v.z, l.z, b.alpha));
    }
    return (diffuse * INV_PI + specular) * l.z;
}

/// Fresnel's share: of the dielectric `f_d`, mixed with the metal's.
@if(glossy) fn reflected(b: Bsdf, f_d: vec3<f32>, cos_theta: f32) -> vec3<f32> {
    @if(metals) { return mix(f_d, schlick(b.base, vec3<f32>(1.0), cos_theta), b.metallic); }
    return f_d;
}

/// Probability of the specular lobe, from reflectances at the view direction. 0 and 1 only where the other lobe is black.
@if(glossy) fn specular_share(b: Bsdf, v: vec3<f32>) -> f32 {
    let specular = luminance(reflected(b, schlick(b.f0, vec3<f32>(b.f90), v.z), v.z));
    let diffuse = luminance(b.base) * (1.0 - b.metallic);
    if (specular <= 0.0) { return 0.0; }
    if (diffuse <= 0.0) { return 1.0; }
    return clamp(specular / (specular + diffuse), 0.1, 0.9);
}

/// By solid angle; what `bsdf_sample` draws from.
fn bsdf_pdf(b: Bsdf, v: vec3<f32>, l: vec3<f32>) -> f32 {
    if (v.z <= 0.0 || l.z <= 0.0) { return 0.0; }
    var pdf = pdf_cosine(l.z);
    @if(glossy) {
        let specular = ggx(normalize(v + l), b.alpha) / (2.0 * smith(v.z, b.alpha));
        pdf = mix(pdf, specular, specular_share(b, v));
    }
    return pdf;
}

/// A visible normal: spherical cap, warped by α.
fn sample_visible_normal(v: vec3<f32>, alpha: f32, u: vec2<f32>) -> vec3<f32> {
    let w = normalize(vec3<f32>(alpha * v.xy, v.z));
    let phi = 2.0 * PI * u.x;
    let z = (1.0 - u.y) * (1.0 + w.z) - w.z;
    let r = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    let h = vec3<f32>(r * cos(phi), r * sin(phi), z) + w;
    return normalize(vec3<f32>(alpha * h.xy, max(h.z, 0.0)));
}

/// `u.z` chooses the lobe.
fn bsdf_sample(b: Bsdf, v: vec3<f32>, u: vec3<f32>) -> BsdfSample {
    if (v.z <= 0.0) { return BsdfSample(vec3<f32>(0.0, 0.0, 1.0), 0.0, vec3<f32>(0.0)); }
    var l = sample_cosine(u.xy);
    @if(glossy) {
        if (u.z < specular_share(b, v)) {
            let h = sample_visible_normal(v, b.alpha, u.xy);
            l = 2.0 * dot(v, h) * h - v;
        }
    }
    return BsdfSample(l, bsdf_pdf(b, v, l), bsdf_value(b, v, l));
}
