//! Which pixel each takes its history from.
//! @needs emissive_meshes punctual_lights environment

import package::base::math::{HUGE};
import package::frame::frame::{index_of, inside, pixel_of};
import package::frame::random::{rng_for};
import package::restir::inputs::{surface};
import package::restir::neighbour::{NOWHERE, Similarity};
import package::restir::reproject::{exactly, pixel_before};
import package::surface::{is_surface};

/// From this frame's film position to last frame's, pixels.
@group(1) @binding(0) var<storage, read> motion: array<vec2<f32>>;
/// From the pixel to the one it takes its history from, pixels; `HUGE` where it takes none.
@group(1) @binding(1) var<storage, read_write> found: array<vec2<f32>>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    found[at] = vec2<f32>(HUGE);
    if (!is_surface(surface[at])) { return; }
    var rng = rng_for(id.xy);
    // All surfaces are alike: where the pixel lies is what is tested.
    let before = pixel_before(id.xy, motion[at], surface[at], exactly(), Similarity(-2.0, HUGE), &rng);
    if (before != NOWHERE) { found[at] = vec2<f32>(pixel_of(before)) - vec2<f32>(id.xy); }
}
