//! Rays, hits, and origins that do not hit what they leave.

import package::base::math::{max3};

struct Ray { origin: vec3<f32>, t_max: f32, direction: vec3<f32> }

/// `t` in lengths of the ray's direction; `instance` is `NONE` when nothing was hit.
struct Hit { t: f32, instance: u32, triangle: u32, barycentrics: vec2<f32> }

/// How far a point may lie from where arithmetic puts it, as a share of the largest number in it: 32 units in the last place cover the
/// rounding of barycentric interpolation and of the two transforms.
const RELATIVE_ERROR: f32 = 3.814697265625e-6;

/// `point` moved off its surface to the side that `direction` goes to. `size` is the largest coordinate among point, corners and
/// edges in the world: the step scales with the scene, so that scaling the scene does not change the image.
fn leave(point: vec3<f32>, geometric: vec3<f32>, direction: vec3<f32>, size: f32) -> vec3<f32> {
    let side = select(-1.0, 1.0, dot(geometric, direction) >= 0.0);
    return point + geometric * (side * RELATIVE_ERROR * max(size, max3(abs(point))));
}
