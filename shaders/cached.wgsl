//! The end of a path that a reservoir keeps: where it arrived, and what light leaves from there.
//!
//! Packed to 40 bytes, so that a reservoir takes 48. What is drawn is packed first: targets, Jacobians and weights are all computed from what comes out
//! again, so that rounding changes the sample, never the estimate's mean by more than the sample's own radiance is rounded.

import package::base::pack::{pack_radiance, pack_unit, unpack_radiance, unpack_unit};

/// A point where light arrived that was seen from another point.
struct PathEnd {
    position: vec3<f32>,
    /// The largest coordinate in the arithmetic that made the position: rays leave it by that (`scene::ray::leave`).
    size: f32,
    /// Unit normal of the triangle, on the side of who drew it.
    normal: vec3<f32>,
    /// Leaves towards who drew it.
    radiance: vec3<f32>,
    /// Of the random numbers that found the radiance; see `bounce`.
    seed: vec2<u32>,
    /// Unit direction to the point that drew it, and how far that is.
    back: vec3<f32>,
    distance: f32,
}

/// The same, packed: no member needs more than 8 bytes of alignment, which would leave gaps.
struct Cached {
    radiance: vec2<u32>,
    seed: vec2<u32>,
    x: f32,
    y: f32,
    z: f32,
    normal: u32,
    back: u32,
    /// Upper 24 bits: the distance, with 15 bits of fraction. Lower 8: exponent of the least power of two that is no less than the size.
    reach: u32,
}

fn pack_reach(distance: f32, size: f32) -> u32 {
    return (bitcast<u32>(distance) & 0xffffff00u) | min((bitcast<u32>(size) + 0x7fffffu) >> 23u, 254u);
}

fn keep(e: PathEnd) -> Cached {
    let reach = pack_reach(e.distance, e.size);
    return Cached(pack_radiance(e.radiance), e.seed, e.position.x, e.position.y, e.position.z, pack_unit(e.normal), pack_unit(e.back), reach);
}

fn recall(c: Cached) -> PathEnd {
    let position = vec3<f32>(c.x, c.y, c.z);
    let size = bitcast<f32>((c.reach & 0xffu) << 23u);
    let distance = bitcast<f32>(c.reach & 0xffffff00u);
    return PathEnd(position, size, unpack_unit(c.normal), unpack_radiance(c.radiance), c.seed, unpack_unit(c.back), distance);
}
