//! Shows one property of the g-buffer as colour.

import package::base::rng::{pcg4d};
import package::frame::frame::{NOW, frame, index_of, inside};
import package::surface::{SurfaceRecord, is_surface, unpack_surface};

struct Params {
    /// What to show: unit vectors map from [−1, 1] to [0, 1]; `distance` is in units of `scale`; `motion` is red (x) and green (y), grey at rest.
    /// @default 0
    /// @choices normal geometric base_color roughness metallic distance instance triangle motion
    channel: u32,
    /// Metres (distance) or pixels (motion) that come out as full brightness.
    /// @default 10
    /// @range 0.0001 1000000
    scale: f32,
}

@group(1) @binding(0) var<uniform> params: Params;
/// What the pixels see.
@group(1) @binding(1) var<storage, read> surface: array<SurfaceRecord>;
/// Only read by channel `motion`.
/// @optional
@if(moving_camera || moving_objects) @group(1) @binding(2) var<storage, read> motion: array<vec2<f32>>;
/// The picture; black where nothing was hit.
@group(1) @binding(3) var<storage, read_write> color: array<vec4<f32>>;

/// A colour that tells neighbouring numbers apart.
fn label(id: u32) -> vec3<f32> {
    return vec3<f32>(pcg4d(vec4<u32>(id, 7u, 11u, 13u)).xyz >> vec3<u32>(8u)) * 5.9604644775390625e-8;
}

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    let record = surface[at];
    if (!is_surface(record)) {
        color[at] = vec4<f32>(0.0);
        return;
    }
    let s = unpack_surface(record, NOW);
    var c = s.normal * 0.5 + 0.5;
    switch params.channel {
        case 1u: { c = s.geometric * 0.5 + 0.5; }
        case 2u: { c = s.bsdf.base; }
        case 3u: { c = vec3<f32>(sqrt(s.bsdf.alpha)); }
        case 4u: { c = vec3<f32>(s.bsdf.metallic); }
        case 5u: { c = vec3<f32>(record.distance / params.scale); }
        case 6u: { c = label(record.instance); }
        case 7u: { c = label(record.triangle); }
        case 8u: {
            c = vec3<f32>(0.5);
            @if(moving_camera || moving_objects) { c = vec3<f32>(motion[at] / params.scale * 0.5 + 0.5, 0.5); }
        }
        default: {}
    }
    color[at] = vec4<f32>(c, 1.0);
}
