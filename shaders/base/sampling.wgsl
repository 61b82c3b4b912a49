//! Warps of the unit square, each with its pdf beside it. Local frames: z is the normal.

import package::base::math::{PI, INV_PI};

/// Uniform on the unit hemisphere around +z; pdf 1 / 2π.
fn sample_hemisphere(u: vec2<f32>) -> vec3<f32> {
    let r = sqrt(max(0.0, 1.0 - u.x * u.x));
    return vec3<f32>(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), u.x);
}

fn pdf_hemisphere() -> f32 {
    return 0.5 * INV_PI;
}

/// Cosine-weighted around +z, by area-preserving polar coordinates; pdf cos θ / π.
fn sample_cosine(u: vec2<f32>) -> vec3<f32> {
    let r = sqrt(u.x);
    return vec3<f32>(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), sqrt(max(0.0, 1.0 - u.x)));
}

fn pdf_cosine(cos_theta: f32) -> f32 {
    return max(cos_theta, 0.0) * INV_PI;
}

/// Uniform on the unit sphere; pdf 1 / 4π.
fn sample_sphere(u: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - 2.0 * u.x;
    let r = sqrt(max(0.0, 1.0 - z * z));
    return vec3<f32>(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), z);
}

/// Barycentrics (of the second and third corner), uniform on the triangle's area; pdf 1 / area.
fn sample_triangle(u: vec2<f32>) -> vec2<f32> {
    let s = sqrt(u.x);
    return vec2<f32>(s * (1.0 - u.y), s * u.y);
}

/// The u of `sample_triangle`, from barycentrics.
fn triangle_uv(barycentrics: vec2<f32>) -> vec2<f32> {
    let s = barycentrics.x + barycentrics.y;
    if (s <= 0.0) { return vec2<f32>(0.0); }
    return vec2<f32>(s * s, barycentrics.y / s);
}
