//! Which pixels may lend their reservoirs. Chosen and rejected by what the g-buffer holds, never by a sample: that would bias.

import package::base::math::{PI};
import package::base::pack::{unpack_unit};
import package::frame::frame::{NOW, frame, index_of};
import package::restir::inputs::{surface};
import package::restir::witness::{tell_looked};
import package::surface::{SurfaceRecord, is_surface};

/// What speaks against a pixel: nothing; it is not on the film, or the receiver itself; nothing was hit there; it lies too near or too far; its
/// normal differs.
const LIKE: u32 = 0u;
const NOT_THERE: u32 = 1u;
const NO_SURFACE: u32 = 2u;
const OTHER_DEPTH: u32 = 3u;
const OTHER_NORMAL: u32 = 4u;

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

/// What speaks against `other` being like `a`, a surface seen from `distance`.
fn unlike(a: SurfaceRecord, distance: f32, other: SurfaceRecord, limits: Similarity) -> u32 {
    if (!is_surface(other)) { return NO_SURFACE; }
    if (abs(other.distance - distance) > limits.depth * distance) { return OTHER_DEPTH; }
    return select(OTHER_NORMAL, LIKE, dot(unpack_unit(a.normal), unpack_unit(other.normal)) >= limits.cosine);
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
    if (!on_film(there, frame.extent) || all(there == vec2<i32>(pixel))) {
        tell_looked(there, NOW, NOT_THERE);
        return NOWHERE;
    }
    let index = index_of(vec2<u32>(there));
    let verdict = unlike(record, record.distance, surface[index], limits);
    tell_looked(there, NOW, verdict);
    return select(NOWHERE, index, verdict == LIKE);
}
