//! Light from infinitely far: an equirectangular map, sampled in proportion to its luminance.
//!
//! u = 0.5 + atan2(x, −z) / 2π, v = acos(y) / π, bilinear between texel centres. Sampling inverts two distributions: a marginal over rows,
//! then a conditional over the texels of the row; within a texel the direction is uniform in solid angle, so that the density has no
//! singularity at the poles. The host makes each texel's weight from the integral
//! of the bilinear map over it, so that the density is positive wherever the map is.

import package::base::math::{PI};
import package::base::table::{floats, word};

struct EnvironmentInfo {
    /// World direction to the map's: rows.
    to_map_x: vec3<f32>,
    width: u32,
    to_map_y: vec3<f32>,
    height: u32,
    to_map_z: vec3<f32>,
}

@group(0) @binding(0) var<uniform> environment_info: EnvironmentInfo;
@group(0) @binding(1) var environment_texels: texture_2d<u32>;
/// `height` cumulative sums of rows, then for each row `width` cumulative sums of its texels; each ends at 1. Four a texel.
@group(0) @binding(2) var environment_cdf: texture_2d<u32>;

fn cdf(at: u32) -> f32 {
    return bitcast<f32>(word(environment_cdf, at));
}

fn to_map(d: vec3<f32>) -> vec2<f32> {
    let m = vec3<f32>(dot(environment_info.to_map_x, d), dot(environment_info.to_map_y, d), dot(environment_info.to_map_z, d));
    return vec2<f32>(0.5 + atan2(m.x, -m.z) / (2.0 * PI), acos(clamp(m.y, -1.0, 1.0)) / PI);
}

/// World direction of azimuth phi and height y on the map's sphere.
fn from_map(phi: f32, y: f32) -> vec3<f32> {
    let r = sqrt(max(0.0, 1.0 - y * y));
    return r * sin(phi) * environment_info.to_map_x + y * environment_info.to_map_y - r * cos(phi) * environment_info.to_map_z;
}

fn environment_texel(x: i32, y: i32) -> vec3<f32> {
    let w = i32(environment_info.width);
    let column = ((x % w) + w) % w;
    let row = clamp(y, 0, i32(environment_info.height) - 1);
    return floats(environment_texels, u32(row * w + column)).rgb;
}

fn environment_radiance(direction: vec3<f32>) -> vec3<f32> {
    let p = to_map(direction) * vec2<f32>(f32(environment_info.width), f32(environment_info.height)) - 0.5;
    let base = floor(p);
    let f = p - base;
    let x = i32(base.x);
    let y = i32(base.y);
    let top = mix(environment_texel(x, y), environment_texel(x + 1, y), f.x);
    let bottom = mix(environment_texel(x, y + 1), environment_texel(x + 1, y + 1), f.x);
    return mix(top, bottom, f.y);
}

/// First entry of `count` from `first` that is above u.
fn search(first: u32, count: u32, u: f32) -> u32 {
    var low = 0u;
    var high = count - 1u;
    while (low < high) {
        let middle = (low + high) / 2u;
        if (cdf(first + middle) > u) { high = middle; } else { low = middle + 1u; }
    }
    return low;
}

/// Lower and upper cumulative value of entry `at`.
fn bounds(first: u32, at: u32) -> vec2<f32> {
    return vec2<f32>(select(cdf(first + max(at, 1u) - 1u), 0.0, at == 0u), cdf(first + at));
}

/// Unit world direction for uv ∈ [0, 1)².
fn environment_direction(u: vec2<f32>) -> vec3<f32> {
    let width = environment_info.width;
    let height = environment_info.height;
    let row = search(0u, height, u.y);
    let row_bounds = bounds(0u, row);
    let row_start = height + row * width;
    let column = search(row_start, width, u.x);
    let column_bounds = bounds(row_start, column);
    let across = (u.x - column_bounds.x) / (column_bounds.y - column_bounds.x);
    let down = (u.y - row_bounds.x) / (row_bounds.y - row_bounds.x);
    let top = cos(PI * f32(row) / f32(height));
    let y = top + down * (cos(PI * f32(row + 1u) / f32(height)) - top);
    let phi = ((f32(column) + across) / f32(width) - 0.5) * 2.0 * PI;
    return from_map(phi, y);
}

/// The uv that `environment_direction` has `direction` at.
fn environment_uv(direction: vec3<f32>) -> vec2<f32> {
    let width = environment_info.width;
    let height = environment_info.height;
    let place = to_map(direction) * vec2<f32>(f32(width), f32(height));
    let column = min(u32(max(place.x, 0.0)), width - 1u);
    let row = min(u32(max(place.y, 0.0)), height - 1u);
    let top = cos(PI * f32(row) / f32(height));
    let down = (top - dot(environment_info.to_map_y, direction)) / (top - cos(PI * f32(row + 1u) / f32(height)));
    let within = clamp(vec2<f32>(place.x - f32(column), down), vec2<f32>(0.0), vec2<f32>(1.0));
    let row_bounds = bounds(0u, row);
    let column_bounds = bounds(height + row * width, column);
    return vec2<f32>(mix(column_bounds.x, column_bounds.y, within.x), mix(row_bounds.x, row_bounds.y, within.y));
}

/// dω/duv: the texel's solid angle over its probability. 0 where the density is 0.
fn environment_jacobian(direction: vec3<f32>) -> f32 {
    let width = environment_info.width;
    let height = environment_info.height;
    let uv = to_map(direction);
    let column = min(u32(max(uv.x, 0.0) * f32(width)), width - 1u);
    let row = min(u32(max(uv.y, 0.0) * f32(height)), height - 1u);
    let row_bounds = bounds(0u, row);
    let column_bounds = bounds(height + row * width, column);
    let probability = (row_bounds.y - row_bounds.x) * (column_bounds.y - column_bounds.x);
    if (probability <= 0.0) { return 0.0; }
    let solid_angle = 2.0 * PI / f32(width) * (cos(PI * f32(row) / f32(height)) - cos(PI * f32(row + 1u) / f32(height)));
    return solid_angle / probability;
}
