//! Radiance to display: exposure, then a curve. The result is linear in [0, 1]; encoding for a file or a screen is theirs.
//!
//! `linear` clips; `reinhard` is L / (1 + L) on luminance (Reinhard et al. 2002, eq. 3); `aces` is Hill's fit of the ACES RRT and ODT, with its input
//! and output matrices; `agx` is Wrensch's polynomial fit of Sobotka's AgX base look.

import package::base::math::{luminance};
import package::frame::frame::{frame, index_of, inside};

struct Params {
    /// Exposure in stops.
    /// @default 0
    /// @range -32 32
    exposure: f32,
    /// The curve.
    /// @default 0
    /// @choices linear reinhard aces agx
    curve: u32,
}

@group(1) @binding(0) var<uniform> params: Params;
/// Radiance.
@group(1) @binding(1) var<storage, read> color: array<vec4<f32>>;
/// Display-referred, linear, in [0, 1].
/// @display_of color
@group(1) @binding(2) var<storage, read_write> image: array<vec4<f32>>;

fn reinhard(c: vec3<f32>) -> vec3<f32> {
    return c / (1.0 + luminance(c));
}

fn aces(c: vec3<f32>) -> vec3<f32> {
    let to = mat3x3<f32>(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    let back = mat3x3<f32>(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    let v = to * c;
    return back * ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

fn agx(c: vec3<f32>) -> vec3<f32> {
    let to = mat3x3<f32>(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992, 0.878468636469772, 0.0784336,
        0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    let back = mat3x3<f32>(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
        -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    let stops = clamp(log2(max(to * c, vec3<f32>(1e-10))), vec3<f32>(-12.47393), vec3<f32>(4.026069));
    let x = (stops + 12.47393) / 16.5;
    let x2 = x * x;
    let x4 = x2 * x2;
    let curve = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    return pow(max(back * curve, vec3<f32>(0.0)), vec3<f32>(2.2));
}

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    let c = max(color[at].rgb, vec3<f32>(0.0)) * exp2(params.exposure);
    var shown = c;
    switch params.curve {
        case 1u: { shown = reinhard(c); }
        case 2u: { shown = aces(c); }
        case 3u: { shown = agx(c); }
        default: {}
    }
    image[at] = vec4<f32>(clamp(shown, vec3<f32>(0.0), vec3<f32>(1.0)), color[at].a);
}
