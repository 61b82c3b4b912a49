//! What every pass may know of the frame: its size, number, seed, and the camera now and before.

struct Camera {
    /// World position of the pinhole.
    position: vec3<f32>,
    /// tan(vertical field of view / 2).
    tan_half_fov: f32,
    /// Unit world directions of the camera's axes; it looks along `forward`.
    right: vec3<f32>,
    near: f32,
    up: vec3<f32>,
    /// Offset of this frame's film sample within the pixel, each in [0, 1).
    jitter_x: f32,
    forward: vec3<f32>,
    jitter_y: f32,
}

struct Frame {
    extent: vec2<u32>,
    /// Number of the frame, from 0 at the first frame of the sequence.
    index: u32,
    /// 1 when last frame's resources hold last frame's values, 0 after a restart.
    history_valid: u32,
    /// Low and high word of the run's seed.
    seed: vec2<u32>,
    /// Lights that can be drawn; 0 when nothing shines.
    lights: u32,
    /// 1 where lights or objects move: what was found in earlier frames may hold no longer.
    moving: u32,
    camera: Camera,
    camera_prev: Camera,
}

@group(0) @binding(0) var<uniform> frame: Frame;

/// Which world: of this frame, or of the last.
const NOW: u32 = 0u;
const BEFORE: u32 = 1u;

fn camera_at(when: u32) -> Camera {
    if (when == NOW) { return frame.camera; }
    return frame.camera_prev;
}

fn inside(pixel: vec2<u32>) -> bool {
    return all(pixel < frame.extent);
}

fn index_of(pixel: vec2<u32>) -> u32 {
    return pixel.y * frame.extent.x + pixel.x;
}

fn pixel_of(index: u32) -> vec2<u32> {
    return vec2<u32>(index % frame.extent.x, index / frame.extent.x);
}

/// Unit world direction through film point `film`, in pixels from the top left.
fn camera_direction(camera: Camera, film: vec2<f32>) -> vec3<f32> {
    let extent = vec2<f32>(frame.extent);
    let p = (2.0 * film - extent) / extent.y * camera.tan_half_fov;
    return normalize(camera.forward + p.x * camera.right - p.y * camera.up);
}

/// Film point that `position` is seen at, in pixels from the top left; behind the camera z is ≤ 0.
fn project(camera: Camera, position: vec3<f32>) -> vec3<f32> {
    let d = position - camera.position;
    let z = dot(d, camera.forward);
    let p = vec2<f32>(dot(d, camera.right), -dot(d, camera.up)) / (z * camera.tan_half_fov);
    let extent = vec2<f32>(frame.extent);
    return vec3<f32>(0.5 * (p * extent.y + extent), z);
}

/// This frame's film sample of a pixel. One jitter for the whole image: every pass of a frame then sees the same surfaces.
fn film_sample(camera: Camera, pixel: vec2<u32>) -> vec2<f32> {
    return vec2<f32>(pixel) + vec2<f32>(camera.jitter_x, camera.jitter_y);
}
