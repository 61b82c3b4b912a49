//! Which pixels may lend their reservoirs. Chosen and rejected by what the g-buffer holds, never by a sample: that would bias.

import package::base::math::{PI};
import package::base::pack::{unpack_unit};
import package::surface::{SurfaceRecord};

/// Similarity of two surfaces (Bitterli et al. 2020, § 5: 25° and 10 %).
struct Similarity {
    /// Least cosine between shading normals.
    cosine: f32,
    /// Largest difference of camera distances, as a share.
    depth: f32,
}

fn similarity(degrees: f32, depth: f32) -> Similarity {
    return Similarity(cos(degrees * (PI / 180.0)), depth);
}

/// Is `other` like `a`, seen from `distance`? Both are surfaces.
fn similar(a: SurfaceRecord, distance: f32, other: SurfaceRecord, limits: Similarity) -> bool {
    if (abs(other.distance - distance) > limits.depth * distance) { return false; }
    return dot(unpack_unit(a.normal), unpack_unit(other.normal)) >= limits.cosine;
}

/// A point of the unit disk, uniform by area.
fn disk(u: vec2<f32>) -> vec2<f32> {
    let angle = 2.0 * PI * u.y;
    return sqrt(u.x) * vec2<f32>(cos(angle), sin(angle));
}

/// Is there such a pixel?
fn on_film(pixel: vec2<i32>, extent: vec2<u32>) -> bool {
    return all(pixel >= vec2<i32>(0)) && all(pixel < vec2<i32>(extent));
}
