//! Mean over frames, with the variance of that mean.
//!
//! Welford's recurrence (Knuth 1998, vol. 2, § 4.2.2), the mean and the sum of squares each carried with its rounding error (Kahan), so that
//! 10⁶ frames lose nothing. For a graph without history, frames are independent and the variance of the mean is M₂ / (n (n − 1)). Frames of a graph
//! with history are not: no variance can be told from them.

import package::frame::frame::{frame, index_of, inside};

struct Moments {
    mean: vec3<f32>,
    /// Frames so far.
    count: u32,
    /// What rounding has kept out of `mean`.
    mean_rest: vec3<f32>,
    /// Sum of squared distances from the mean.
    squares: vec3<f32>,
    /// What rounding has kept out of `squares`.
    squares_rest: vec3<f32>,
}

/// This frame.
@group(1) @binding(0) var<storage, read> color: array<vec4<f32>>;
/// The frames before; wire it to `moments@prev`.
/// @optional
@group(1) @binding(1) var<storage, read> history: array<Moments>;
/// With this frame.
@group(1) @binding(2) var<storage, read_write> moments: array<Moments>;
/// The mean.
@group(1) @binding(3) var<storage, read_write> image: array<vec4<f32>>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    let x = color[at];
    var m = history[at];
    m.count += 1u;
    let before = x.rgb - m.mean - m.mean_rest;
    let step = before / f32(m.count) + m.mean_rest;
    let mean = m.mean + step;
    m.mean_rest = step - (mean - m.mean);
    m.mean = mean;
    let square = before * (x.rgb - m.mean - m.mean_rest) + m.squares_rest;
    let squares = m.squares + square;
    m.squares_rest = square - (squares - m.squares);
    m.squares = squares;
    moments[at] = m;
    image[at] = vec4<f32>(m.mean, x.a);
}
