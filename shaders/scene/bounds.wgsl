//! The box of everything that rays can hit, now; a point at the origin when there is nothing.

struct Bounds { low: vec3<f32>, high: vec3<f32> }

@group(0) @binding(0) var<storage, read> bounds: Bounds;
