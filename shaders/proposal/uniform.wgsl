//! Fills slot `proposal`: every light with the same probability, uv uniform.

import package::base::rng::{below};
import package::slot::lights::{light_count};

/// A light, a place in its uv, and its contribution weight: here 1 / P.
struct Candidate { light: u32, uv: vec2<f32>, weight: f32 }

fn propose(receiver: vec3<f32>, bits: vec4<u32>) -> Candidate {
    let count = light_count();
    return Candidate(below(bits.x, count), vec2<f32>(bits.zw >> vec2<u32>(8u)) * 5.9604644775390625e-8, f32(count));
}

/// Density by uv that MIS weights take this proposal for. Here it is the true one: P(light), with uv uniform.
fn weighting_pdf(light: u32, receiver: vec3<f32>) -> f32 {
    return 1.0 / f32(light_count());
}
