//! G-buffer by tracing one camera ray a pixel.
//!
//! Each pixel gets the first surface on the ray through this frame's film sample (one jitter for the whole image, drawn from seed and
//! frame, box filter), with its material evaluated, and the motion of that surface since the last frame.

import package::frame::frame::{NOW, camera_direction, film_sample, frame, index_of, inside};
import package::base::math::{HUGE};
@if(moving_camera || moving_objects) import package::motion::{motion_of};
import package::scene::geometry::{NONE};
import package::scene::ray::{Ray};
import package::slot::trace::{closest};
import package::surface::{SurfaceRecord, no_surface, pack_surface, surface_at};

/// What the pixel sees, 64 bytes.
@group(1) @binding(0) var<storage, read_write> surface: array<SurfaceRecord>;
/// From this frame's film position of the surface to last frame's, pixels, without jitter. (0, 0) where it was behind the camera.
@if(moving_camera || moving_objects) @group(1) @binding(1) var<storage, read_write> motion: array<vec2<f32>>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let camera = frame.camera;
    let film = film_sample(camera, id.xy);
    let direction = camera_direction(camera, film);
    let hit = closest(Ray(camera.position, HUGE, direction), NOW);
    let at = index_of(id.xy);
    if (hit.instance == NONE) {
        surface[at] = no_surface(direction);
    } else {
        surface[at] = pack_surface(surface_at(hit, -direction, NOW), hit.t);
    }
    @if(moving_camera || moving_objects) { motion[at] = motion_of(hit, direction); }
}
