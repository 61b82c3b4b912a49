//! Magnitudes of colours over forty decades, by slot `magnitude`.

import package::slot::magnitude::{magnitude};

/// Colours: 2 to the power of k / 2 - 64, times a hue that changes with k; and black.
/// @extent fixed 257
@group(1) @binding(0) var<storage, read_write> found: array<vec4<f32>>;

@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&found)) { return; }
    let k = f32(id.x);
    let hue = vec3<f32>(fract(k * 0.7548776662), fract(k * 0.5698402910), fract(k * 0.3819660113));
    let color = select(hue * exp2(0.5 * k - 64.0), vec3<f32>(0.0), id.x == 256u);
    found[id.x] = vec4<f32>(color, magnitude(color));
}
