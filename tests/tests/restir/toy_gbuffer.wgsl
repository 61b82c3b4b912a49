//! The toy's g-buffer: nine pixels in a row, again and again.

import package::frame::frame::{NOW, frame, index_of, inside};
import package::scene::geometry::{position_of};
import package::slot::domain::{pixel, surface_of};
import package::surface::{SurfaceRecord, pack_surface};

@group(1) @binding(0) var<storage, read_write> surface: array<SurfaceRecord>;
/// None: film samples move with the jitter, so that the nearest of last frame is now and then a neighbour's.
@group(1) @binding(1) var<storage, read_write> motion: array<vec2<f32>>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    // All stand where the first triangle has its first corner.
    let distance = length(position_of(0u, 0u, vec2<f32>(0.0), NOW) - frame.camera.position);
    surface[at] = pack_surface(surface_of(pixel(at % 9u), NOW), distance);
    motion[at] = vec2<f32>(0.0);
}
