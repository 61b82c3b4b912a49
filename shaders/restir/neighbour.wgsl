//! Which pixels may lend their reservoirs. Chosen and rejected by what the g-buffer holds, never by a sample: that would bias.

import package::base::math::{PI};
import package::base::pack::{unpack_unit};
import package::frame::frame::{frame, index_of};
import package::restir::inputs::{surface};
import package::surface::{SurfaceRecord, is_surface};

/// No pixel.
const NOWHERE: u32 = 0xffffffffu;

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

/// Index of a pixel uniform in the disk of that radius around `pixel`, whose surface is like `record`; `NOWHERE` where the one drawn is not.
fn neighbour(pixel: vec2<u32>, record: SurfaceRecord, radius: f32, limits: Similarity, u: vec2<f32>) -> u32 {
    let there = vec2<i32>(pixel) + vec2<i32>(round(radius * disk(u)));
    if (!on_film(there, frame.extent) || all(there == vec2<i32>(pixel))) { return NOWHERE; }
    let index = index_of(vec2<u32>(there));
    let other = surface[index];
    if (!is_surface(other) || !similar(record, record.distance, other, limits)) { return NOWHERE; }
    return index;
}
