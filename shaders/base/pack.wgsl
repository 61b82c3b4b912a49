//! Packed forms that survive a round trip: f32 → packed → f32 → packed gives the same bits.

import package::base::math::{LUMINANCE, luminance};

/// A unit vector in 32 bits: octahedral map, 16 bits a coordinate.
/// Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors".
fn pack_unit(v: vec3<f32>) -> u32 {
    let p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    let folded = (1.0 - abs(p.yx)) * select(vec2<f32>(-1.0), vec2<f32>(1.0), p >= vec2<f32>(0.0));
    return pack2x16snorm(select(folded, p, v.z >= 0.0));
}

fn unpack_unit(bits: u32) -> vec3<f32> {
    let p = unpack2x16snorm(bits);
    let z = 1.0 - abs(p.x) - abs(p.y);
    let fold = max(-z, 0.0);
    let xy = p - fold * select(vec2<f32>(-1.0), vec2<f32>(1.0), p >= vec2<f32>(0.0));
    return normalize(vec3<f32>(xy, z));
}

/// Four halves; the values must be within ±65,504.
fn pack_half4(v: vec4<f32>) -> vec2<u32> {
    return vec2<u32>(pack2x16float(v.xy), pack2x16float(v.zw));
}

fn unpack_half4(bits: vec2<u32>) -> vec4<f32> {
    return vec4<f32>(unpack2x16float(bits.x), unpack2x16float(bits.y));
}

/// A radiance of any magnitude: its luminance in full, and in 16 bits each the shares of it that red and blue make up. Light below the
/// least normal f32 is black.
fn pack_radiance(c: vec3<f32>) -> vec2<u32> {
    let y = luminance(c);
    let shares = LUMINANCE.rb * c.rb / max(y, 1.17549435e-38);
    return vec2<u32>(bitcast<u32>(y), pack2x16unorm(shares));
}

fn unpack_radiance(bits: vec2<u32>) -> vec3<f32> {
    let y = bitcast<f32>(bits.x);
    let shares = unpack2x16unorm(bits.y);
    let green = max(1.0 - shares.x - shares.y, 0.0);
    return y * vec3<f32>(shares.x, green, shares.y) / LUMINANCE;
}
