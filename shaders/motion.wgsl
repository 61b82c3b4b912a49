//! How far the image of a surface has moved since the last frame.

import package::frame::frame::{BEFORE, NOW, camera_at, project};
import package::scene::geometry::{NONE, position_of};
import package::scene::ray::{Hit};

/// From this frame's film position of what a camera ray along unit `direction` hit to last frame's, pixels, without jitter; (0, 0) where it was behind
/// the camera. Both are found by the same arithmetic, so that what stands still has moved by exactly 0.
fn motion_of(hit: Hit, direction: vec3<f32>) -> vec2<f32> {
    let there = film_of(hit, direction, BEFORE);
    return select(vec2<f32>(0.0), there.xy - film_of(hit, direction, NOW).xy, there.z > 0.0);
}

fn film_of(hit: Hit, direction: vec3<f32>, when: u32) -> vec3<f32> {
    let camera = camera_at(when);
    if (hit.instance == NONE) { return project(camera, camera.position + direction); }
    return project(camera, position_of(hit.instance, hit.triangle, hit.barycentrics, when));
}
