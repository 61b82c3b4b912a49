//! Which pixel of last frame saw what a pixel sees now. Chosen from the g-buffer alone.
//!
//! Motion is between pixels, whatever the film samples in them: the pixel nearest to the film sample itself would stand off by the difference of two
//! frames' jitters, rounded, whose mean is not 0 for a low-discrepancy sequence (R2: 0.25 and 0.43 pixels a frame), and histories would wander over the
//! image, lost where they come to an edge. Parts of a pixel are rounded down after adding a number in [0, 1) that all pixels of the frame share: right
//! in the mean, where motion is uniform no history is taken twice, and what stands still keeps its pixel.

import package::base::rng::{Rng, pcg4d, rng_next4};
import package::frame::frame::{BEFORE, camera_at, frame, index_of};
import package::frame::random::{random_stage, rng_of_frame};
import package::restir::inputs::{previous_surface};
import package::restir::neighbour::{LIKE, NOT_THERE, NOWHERE, Similarity, disk, on_film, unlike};
import package::restir::witness::{tell_looked};
import package::scene::geometry::{position_of};
import package::surface::{SurfaceRecord, is_surface};

struct Search {
    /// Further pixels that are tried where the first is not alike.
    tries: u32,
    /// How far around it they may lie, pixels.
    radius: f32,
    /// The first is not the pixel itself but another of 4×4 around it, by a rule that changes with every frame.
    permute: bool,
}

/// The pixel itself is looked for, and no other.
fn exactly() -> Search {
    return Search(0u, 0.0, false);
}

/// Index of the pixel of last frame that saw the surface of `pixel`, or one like it; `NOWHERE` where there is none, or no last frame.
/// `motion` is what the g-buffer says of the pixel.
fn pixel_before(pixel: vec2<u32>, motion: vec2<f32>, record: SurfaceRecord, search: Search, limits: Similarity, rng: ptr<function, Rng>) -> u32 {
    if (frame.history_valid == 0u) { return NOWHERE; }
    var shared_by_all = rng_of_frame();
    let moved = motion + rng_next4(&shared_by_all).xy;
    let before = position_of(record.instance, record.triangle, record.barycentrics, BEFORE);
    let distance = length(before - camera_at(BEFORE).position);
    for (var i = 0u; i <= search.tries; i++) {
        var offset = vec2<f32>(0.0);
        if (i > 0u) { offset = search.radius * disk(rng_next4(rng).xy); }
        var there = vec2<i32>(pixel) + vec2<i32>(floor(moved + offset));
        if (i == 0u && search.permute) { there = permuted(there); }
        if (!on_film(there, frame.extent)) {
            tell_looked(there, BEFORE, NOT_THERE);
            continue;
        }
        let index = index_of(vec2<u32>(there));
        let other = previous_surface[index];
        let verdict = unlike(record, distance, other, limits);
        // Where no history is wired its surfaces are zeros, and there is nothing to be told.
        if (!is_surface(other) || other.distance > 0.0) { tell_looked(there, BEFORE, verdict); }
        if (verdict == LIKE) { return index; }
    }
    return NOWHERE;
}

/// The film is cut into blocks of 4×4 pixels, from a place that every frame draws anew; each pixel changes places with the one opposite (as in
/// NVIDIA's RTXDI). All pixels of a frame draw the same, so that no history is taken twice.
fn permuted(pixel: vec2<i32>) -> vec2<i32> {
    let bits = pcg4d(vec4<u32>(frame.seed, frame.index, random_stage)).x;
    let corner = vec2<i32>(i32(bits & 3u), i32((bits >> 2u) & 3u));
    return ((pixel + corner) ^ vec2<i32>(3)) - corner;
}
