//! Spatial reuse: joins each pixel's reservoir with those of pixels around it, and with what this pass itself left there last frame.
//!
//! Pixels are drawn uniformly in a disk, and rejected by the g-buffer alone. Rounds are `repeat`, with `feed.current = "reservoir"`
//! (Bitterli et al. 2020, § 3.2 and § 5). With `history`, `previous_surface` and `motion` wired, the pixel's own result of last frame joins, and
//! while it counts little more pixels are asked, and their results of last frame too (Ouyang et al. 2021, alg. 4). The paper's listing leaves
//! the pixel's own temporal reservoir out; here it is always the canonical input, which alone covers all that the pixel can use.
//! With an unbiased rule in slot `mis` the pass is unbiased: who is asked depends on the g-buffer and on confidences, never on a sample.
//! @needs emissive_meshes punctual_lights environment

import package::base::math::{HUGE};
import package::base::rng::{rng_next4};
import package::frame::frame::{BEFORE, NOW, frame, index_of, inside, pixel_of};
import package::frame::random::{rng_for};
import package::restir::inputs::{Input, MAX_INPUTS, current, input_of, surface};
import package::restir::neighbour::{NOWHERE, neighbour, similarity};
import package::restir::reproject::{exactly, pixel_before};
import package::restir::reservoir::{Reservoir};
import package::restir::stale::{is_stale};
import package::restir::witness::{tell_of};
import package::slot::mis::{combine};
import package::slot::shading::{keep_light};
import package::surface::{is_surface, unpack_surface};

struct Params {
    /// Radius of the disk, in pixels of an image of `rows` rows.
    /// @default 30
    /// @range 0 1000
    radius: f32,
    /// Rows of the image that `radius` is meant for: it scales with the image. 0: it does not.
    /// @default 1080
    /// @range 0 16384
    rows: f32,
    /// What the radius shrinks by, for the pixel's further draws, where a drawn pixel was not alike. 1: it stays.
    /// @default 1
    /// @range 0 1
    shrink: f32,
    /// Radius at which it shrinks no further, pixels.
    /// @default 3
    /// @range 0 1000
    least: f32,
    /// Largest angle between normals, degrees.
    /// @default 25
    /// @range 0 180
    normal: f32,
    /// Largest difference of camera distances, as a share.
    /// @default 0.1
    /// @range 0 1
    depth: f32,
    /// Most that a history counts, in confidences of a fresh reservoir.
    /// @default 500
    /// @range 1 500
    cap: f32,
    /// Confidence of the pixel's own history below which `more_taps` pixels are asked instead, and their histories too. 0: never.
    /// @default 0
    /// @range 0 500
    low: f32,
}

/// Pixels that are asked.
/// @range 1 11
override taps: u32 = 5u;
/// Pixels that are asked while the pixel's own history counts less than `low`.
/// @range 1 9
override more_taps: u32 = 9u;

/// How the places of pixels follow each other: at random, or evenly from a random start (R2 sequence, Roberts 2018).
/// @choices random even
override pattern: u32 = 0u;

const EVEN: u32 = 1u;
/// 1 / g and 1 / g², g³ = g + 1.
const R2 = vec2<f32>(0.7548776662, 0.5698402910);

@group(1) @binding(0) var<uniform> params: Params;
/// From this frame's film position to last frame's, pixels.
/// @optional
@if(moving_camera || moving_objects) @group(1) @binding(1) var<storage, read> motion: array<vec2<f32>>;
/// Joined.
@group(1) @binding(3) var<storage, read_write> reservoir: array<Reservoir>;

fn moved(pixel: u32) -> vec2<f32> {
    @if(moving_camera || moving_objects) { return motion[pixel]; }
    return vec2<f32>(0.0);
}

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    tell_of(id.xy);
    let record = surface[at];
    if (!is_surface(record)) {
        reservoir[at] = current[at];
        keep_light(at);
        return;
    }
    var rng = rng_for(id.xy);
    let limits = similarity(params.normal, params.depth);
    let exact = exactly();
    var inputs: array<Input, MAX_INPUTS>;
    inputs[0] = input_of(at, NOW, HUGE);
    var count = 1u;
    var own = 0.0;
    let before = pixel_before(id.xy, moved(at), record, exact, limits, &rng);
    if (before != NOWHERE && !is_stale(at)) {
        inputs[1] = input_of(before, BEFORE, params.cap);
        own = inputs[1].confidence;
        // What counts nothing is no input: where no history is wired, its surfaces are zeros.
        count += u32(own > 0.0);
    }
    let few = own < params.low;
    var radius = params.radius * select(1.0, f32(frame.extent.y) / params.rows, params.rows > 0.0);
    var place = vec2<f32>(0.0);
    for (var i = 0u; i < select(taps, more_taps, few); i++) {
        place = select(rng_next4(&rng).xy, fract(place + R2), pattern == EVEN && i > 0u);
        let other = neighbour(id.xy, record, radius, limits, place);
        if (other == NOWHERE) {
            radius = max(radius * params.shrink, min(radius, params.least));
            continue;
        }
        inputs[count] = input_of(other, NOW, HUGE);
        count += 1u;
        if (!few || is_stale(other)) { continue; }
        let other_before = pixel_before(pixel_of(other), moved(other), surface[other], exact, limits, &rng);
        if (other_before != NOWHERE) {
            inputs[count] = input_of(other_before, BEFORE, params.cap);
            count += u32(inputs[count].confidence > 0.0);
        }
    }
    reservoir[at] = combine(unpack_surface(record, NOW), &inputs, count, &rng);
    keep_light(at);
}
