//! Spatial reuse: joins each pixel's reservoir with those of pixels around it.
//!
//! Bitterli et al. 2020, § 3.2 and § 5. Pixels are drawn uniformly in a disk, and rejected by the g-buffer alone. Rounds are `repeat`, with
//! `feed.current = "reservoir"`. With an unbiased rule in slot `mis` the pass is unbiased.

import package::base::math::{HUGE};
import package::base::rng::{rng_next4};
import package::frame::frame::{NOW, frame, index_of, inside};
import package::frame::random::{rng_for};
import package::restir::inputs::{Input, MAX_INPUTS, current, input_of, surface};
import package::restir::neighbour::{disk, on_film, similar, similarity};
import package::restir::reservoir::{Reservoir};
import package::slot::mis::{combine};
import package::surface::{SurfaceRecord, is_surface, unpack_surface};

struct Params {
    /// Radius of the disk, in pixels of an image of `rows` rows.
    /// @default 30
    /// @range 0 1000
    radius: f32,
    /// Rows of the image that `radius` is meant for: it scales with the image. 0: it does not.
    /// @default 1080
    /// @range 0 16384
    rows: f32,
    /// Largest angle between normals, degrees.
    /// @default 25
    /// @range 0 180
    normal: f32,
    /// Largest difference of camera distances, as a share.
    /// @default 0.1
    /// @range 0 1
    depth: f32,
}

/// Pixels that are asked.
/// @range 1 11
override taps: u32 = 5u;

@group(1) @binding(0) var<uniform> params: Params;
/// Joined.
@group(1) @binding(1) var<storage, read_write> reservoir: array<Reservoir>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    let record = surface[at];
    if (!is_surface(record)) {
        reservoir[at] = current[at];
        return;
    }
    var rng = rng_for(id.xy);
    let s = unpack_surface(record, NOW);
    let radius = params.radius * select(1.0, f32(frame.extent.y) / params.rows, params.rows > 0.0);
    let limits = similarity(params.normal, params.depth);
    var inputs: array<Input, MAX_INPUTS>;
    inputs[0] = input_of(at, NOW, HUGE);
    var count = 1u;
    for (var i = 0u; i < min(taps, MAX_INPUTS - 1u); i++) {
        let there = vec2<i32>(id.xy) + vec2<i32>(round(radius * disk(rng_next4(&rng).xy)));
        if (!on_film(there, frame.extent) || all(there == vec2<i32>(id.xy))) { continue; }
        let index = index_of(vec2<u32>(there));
        let other = surface[index];
        if (!is_surface(other) || !similar(record, record.distance, other, limits)) { continue; }
        inputs[count] = input_of(index, NOW, HUGE);
        count += 1u;
    }
    reservoir[at] = combine(s, &inputs, count, &rng);
}
