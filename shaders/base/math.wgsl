//! Constants and small geometry.

const PI: f32 = 3.14159265358979;
const INV_PI: f32 = 0.318309886183791;
/// Largest finite f32.
const HUGE: f32 = 3.4028234e38;

/// A frame around unit `n`: columns tangent, bitangent, n.
/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
fn frame_of(n: vec3<f32>) -> mat3x3<f32> {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return mat3x3<f32>(vec3<f32>(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3<f32>(b, s + n.y * n.y * a, -n.y), n);
}

/// Weights of linear Rec. 709 in its luminance.
const LUMINANCE = vec3<f32>(0.2126, 0.7152, 0.0722);

fn luminance(c: vec3<f32>) -> f32 {
    return dot(c, LUMINANCE);
}

fn max3(v: vec3<f32>) -> f32 {
    return max(v.x, max(v.y, v.z));
}

fn square(x: f32) -> f32 {
    return x * x;
}

/// By bit pattern: `x != x` may be folded away by a compiler that assumes no NaN.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

fn all_finite(v: vec3<f32>) -> bool {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}
