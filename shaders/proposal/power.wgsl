//! Fills slot `proposal`: a light with probability proportional to its emitted power, uv uniform.
//! @default

import package::base::rng::{below};
import package::slot::lights::{light_count, lights};

/// A light, a place in its uv, and its contribution weight: here 1 / P.
struct Candidate { light: u32, uv: vec2<f32>, weight: f32 }

/// Vose's alias method: one entry, one comparison. The entry, the coin and uv use bits of their own.
fn propose(receiver: vec3<f32>, bits: vec4<u32>) -> Candidate {
    let entry = below(bits.x, light_count());
    let keep = f32(bits.y >> 8u) * 5.9604644775390625e-8 < lights[entry].threshold;
    let id = select(lights[entry].other, entry, keep);
    return Candidate(id, vec2<f32>(bits.zw >> vec2<u32>(8u)) * 5.9604644775390625e-8, 1.0 / lights[id].pmf);
}

/// Density by uv that MIS weights take this proposal for. Here it is the true one: P(light), with uv uniform.
fn weighting_pdf(light: u32, receiver: vec3<f32>) -> f32 {
    return lights[light].pmf;
}
