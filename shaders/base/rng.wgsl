//! Counter-based random numbers: a pure function of (64-bit seed, pixel, frame, stage, vertex, draw).
//!
//! Nothing depends on how many numbers another vertex or stage has drawn, so that two graphs that differ in one pass
//! still see the same numbers in the others. The hash is pcg4d of Jarzynski and Olano 2020, "Hash Functions for GPU
//! Rendering", applied twice: once to what is constant over a pass, once to the counter.

struct Rng { key: vec4<u32>, counter: u32 }

fn pcg4d(seed: vec4<u32>) -> vec4<u32> {
    var v = seed * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> vec4<u32>(16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

/// `stage` tells passes (and their repeats) apart.
fn rng_begin(seed: vec2<u32>, pixel: vec2<u32>, frame: u32, stage: u32) -> Rng {
    let place = pcg4d(vec4<u32>(pixel, frame, stage));
    return Rng(pcg4d(place ^ vec4<u32>(seed, seed.y, seed.x)), 0u);
}

/// Moves to the numbers of path vertex `vertex`; each vertex has 256 draws.
fn rng_vertex(rng: ptr<function, Rng>, vertex: u32) {
    (*rng).counter = vertex << 8u;
}

fn rng_bits(rng: ptr<function, Rng>) -> vec4<u32> {
    let bits = pcg4d((*rng).key + vec4<u32>((*rng).counter, 0x9e3779b9u, (*rng).counter * 0x85ebca6bu, 0x27220a95u));
    (*rng).counter += 1u;
    return bits;
}

/// Four numbers in [0, 1), multiples of 2⁻²⁴.
fn rng_next4(rng: ptr<function, Rng>) -> vec4<f32> {
    return vec4<f32>(rng_bits(rng) >> vec4<u32>(8u)) * 5.9604644775390625e-8;
}

/// A number below `count` from 32 bits: the high word of their product, by 16-bit halves.
fn below(bits: u32, count: u32) -> u32 {
    let low = (bits & 0xffffu) * (count & 0xffffu);
    let cross_a = (bits >> 16u) * (count & 0xffffu);
    let cross_b = (bits & 0xffffu) * (count >> 16u);
    let middle = (low >> 16u) + (cross_a & 0xffffu) + (cross_b & 0xffffu);
    return (bits >> 16u) * (count >> 16u) + (cross_a >> 16u) + (cross_b >> 16u) + (middle >> 16u);
}
