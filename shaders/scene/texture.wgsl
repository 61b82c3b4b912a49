//! Textures: texels in one table, filtered here, so that no binding arrays are needed and every adapter filters alike.

import package::base::color::{srgb_to_linear};
import package::base::table::{floats, word, words};

/// One use of an image.
struct Texture {
    /// Rows of KHR_texture_transform: dot(row.xyz, vec3(u, v, 1)).
    u_row: vec4<f32>,
    v_row: vec4<f32>,
    /// Index of the first texel.
    first: u32,
    width: u32,
    height: u32,
    /// Bits 0–1 and 2–3: wrap in u and v (0 repeat, 1 clamp, 2 mirror); 4: bilinear; 5: sRGB; 6: second set of coordinates.
    flags: u32,
}

/// Of `Texture`, 3 texels each.
@group(0) @binding(0) var textures: texture_2d<u32>;
/// RGBA, 8 bits each, red lowest; four colours a texel.
@group(0) @binding(1) var texels: texture_2d<u32>;

fn texture_use(id: u32) -> Texture {
    let last = words(textures, 3u * id + 2u);
    return Texture(floats(textures, 3u * id), floats(textures, 3u * id + 1u), last.x, last.y, last.z, last.w);
}

fn wrap(i: i32, size: i32, mode: u32) -> i32 {
    if (mode == 1u) { return clamp(i, 0, size - 1); }
    let period = select(size, 2 * size, mode == 2u);
    let m = ((i % period) + period) % period;
    return select(m, period - 1 - m, m >= size);
}

/// Decoded to linear before filtering, as glTF asks.
fn texel(t: Texture, x: i32, y: i32) -> vec4<f32> {
    let column = wrap(x, i32(t.width), t.flags & 3u);
    let row = wrap(y, i32(t.height), (t.flags >> 2u) & 3u);
    let c = unpack4x8unorm(word(texels, t.first + u32(row) * t.width + u32(column)));
    if ((t.flags & 32u) == 0u) { return c; }
    return vec4<f32>(srgb_to_linear(c.rgb), c.a);
}

/// The value of texture `id` at the vertex coordinates `uv` of the set that the texture asks for.
fn sample_texture(id: u32, uv0: vec2<f32>, uv1: vec2<f32>) -> vec4<f32> {
    let t = texture_use(id);
    let uv = vec3<f32>(select(uv0, uv1, (t.flags & 64u) != 0u), 1.0);
    let p = vec2<f32>(dot(t.u_row.xyz, uv), dot(t.v_row.xyz, uv)) * vec2<f32>(f32(t.width), f32(t.height));
    if ((t.flags & 16u) == 0u) {
        return texel(t, i32(floor(p.x)), i32(floor(p.y)));
    }
    let q = p - 0.5;
    let base = floor(q);
    let f = q - base;
    let x = i32(base.x);
    let y = i32(base.y);
    let top = mix(texel(t, x, y), texel(t, x + 1, y), f.x);
    let bottom = mix(texel(t, x, y + 1), texel(t, x + 1, y + 1), f.x);
    return mix(top, bottom, f.y);
}
