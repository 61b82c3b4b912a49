//! Which pixel of last frame saw what a pixel sees now. Chosen from the g-buffer alone.

import package::base::rng::{Rng, pcg4d, rng_next4};
import package::frame::frame::{BEFORE, camera_at, film_sample, frame, index_of};
import package::frame::random::{random_stage};
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
    let film = film_sample(frame.camera, pixel) + motion;
    let jitter = vec2<f32>(frame.camera_prev.jitter_x, frame.camera_prev.jitter_y);
    let before = position_of(record.instance, record.triangle, record.barycentrics, BEFORE);
    let distance = length(before - camera_at(BEFORE).position);
    for (var i = 0u; i <= search.tries; i++) {
        var offset = vec2<f32>(0.0);
        if (i > 0u) { offset = search.radius * disk(rng_next4(rng).xy); }
        // The nearest of last frame's film samples.
        var there = vec2<i32>(floor(film + offset - jitter + 0.5));
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
