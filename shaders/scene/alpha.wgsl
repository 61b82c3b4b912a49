//! Does a ray stop at a hit? Opacity is a probability: no bounce is counted and no order of hits is needed.

@if(alpha) import package::base::rng::{pcg4d};
@if(alpha) import package::frame::frame::{frame};
@if(alpha) import package::scene::geometry::{info_of};
@if(alpha) import package::scene::material::{opacity_at};

/// The coin is a hash of the hit and of the frame, so that every ray tosses its own.
@if(alpha) fn stops(instance: u32, triangle: u32, barycentrics: vec2<f32>, t: f32) -> bool {
    let opacity = opacity_at(info_of(triangle).material, triangle, barycentrics);
    if (opacity >= 1.0) { return true; }
    let place = vec4<u32>(bitcast<vec2<u32>>(barycentrics), bitcast<u32>(t), triangle ^ (instance * 0x9e3779b9u));
    let bits = pcg4d(pcg4d(place) ^ vec4<u32>(frame.seed, frame.index, 0x51ed270bu));
    return f32(bits.x >> 8u) * 5.9604644775390625e-8 < opacity;
}
