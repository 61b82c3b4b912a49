//! KHR_lights_punctual.

import package::frame::frame::{NOW};

struct Punctual {
    position: vec3<f32>,
    /// 0 directional, 1 point, 2 spot.
    kind: u32,
    /// Unit direction in which it shines.
    direction: vec3<f32>,
    /// 0 for no limit.
    range: f32,
    intensity: vec3<f32>,
    /// Scale and offset of the cone's edge, as the extension writes them.
    cone_scale: f32,
    cone_offset: f32,
}

@group(0) @binding(0) var<storage, read> punctuals: array<Punctual>;
@if(moving_lights) @group(0) @binding(1) var<storage, read> punctuals_prev: array<Punctual>;

fn punctual_at(id: u32, when: u32) -> Punctual {
    @if(moving_lights) {
        if (when != NOW) { return punctuals_prev[id]; }
    }
    return punctuals[id];
}

/// Share that reaches a receiver which sees the light along unit `direction`, from squared distance `d2`: the cone's smooth edge,
/// and the window max(min(1 − (d / range)⁴, 1), 0) that the extension recommends.
fn punctual_falloff(id: u32, direction: vec3<f32>, d2: f32, when: u32) -> f32 {
    let l = punctual_at(id, when);
    var share = 1.0;
    if (l.kind == 2u) {
        let edge = clamp(-dot(l.direction, direction) * l.cone_scale + l.cone_offset, 0.0, 1.0);
        share = edge * edge;
    }
    if (l.range > 0.0) {
        let r = d2 / (l.range * l.range);
        share *= clamp(1.0 - r * r, 0.0, 1.0);
    }
    return share;
}
