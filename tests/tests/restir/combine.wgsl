//! Combines the reservoirs of each nine pixels by the rule in slot `mis`: of the first alone, of the first two, and so on.

import package::base::math::{HUGE};
import package::frame::frame::{BEFORE, NOW, index_of, inside};
import package::frame::random::{rng_for};
import package::restir::inputs::{Input, MAX_INPUTS, input_of, surface, surface_of_input};
import package::slot::domain::{value, visible};
import package::slot::mis::{combine};
import package::slot::visibility::{TEST_SHADED};

struct Params {
    /// What is written: the estimate f(Y) W, the confidence, or the contribution weight.
    /// @choices estimate confidence weight
    written: u32,
}

@group(1) @binding(0) var<uniform> params: Params;
/// For 1 input all trials, then for 2, and so on.
@group(1) @binding(1) var<storage, read_write> results: array<f32>;

@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let index = index_of(id.xy);
    let trials = arrayLength(&surface) / 9u;
    let count = 1u + index / trials;
    let trial = index % trials;
    var inputs: array<Input, MAX_INPUTS>;
    for (var i = 0u; i < count; i++) {
        // Every third is of last frame. Confidences of all kinds; the canonical's is large, which keeps the noise of the whole small.
        inputs[i] = input_of(9u * trial + i, select(NOW, BEFORE, i % 3u == 2u), HUGE);
        inputs[i].confidence = select(f32(1u + (5u * i) % 3u), 8.0, i == 0u);
    }
    let at = surface_of_input(inputs[0]);
    var rng = rng_for(id.xy);
    let r = combine(at, &inputs, count, &rng);
    var estimate = 0.0;
    if (r.weight.value > 0.0 && (!TEST_SHADED || visible(r.sample, at))) { estimate = value(r.sample, at).x * r.weight.value; }
    results[index] = vec3<f32>(estimate, r.confidence, r.weight.value)[params.written];
}
