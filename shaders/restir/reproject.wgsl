//! Which pixel of last frame saw what a pixel sees now. Chosen from the g-buffer alone.

import package::base::rng::{Rng, rng_next4};
import package::frame::frame::{BEFORE, camera_at, film_sample, frame, index_of};
import package::restir::inputs::{previous_surface};
import package::restir::neighbour::{NOWHERE, Similarity, disk, on_film, similar};
import package::scene::geometry::{position_of};
import package::surface::{SurfaceRecord, is_surface};

/// Further pixels that are tried where the first is not alike, and how far around it they may lie, pixels.
struct Search { tries: u32, radius: f32 }

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
        let there = vec2<i32>(floor(film + offset - jitter + 0.5));
        if (!on_film(there, frame.extent)) { continue; }
        let index = index_of(vec2<u32>(there));
        let other = previous_surface[index];
        if (is_surface(other) && similar(record, distance, other, limits)) { return index; }
    }
    return NOWHERE;
}
