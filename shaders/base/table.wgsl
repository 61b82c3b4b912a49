//! Arrays of the scene, as textures of four words a texel in rows of `ROW`.
//!
//! Why textures: Mesa's lavapipe (22.3) fetches from a storage buffer word by word and lane by lane, from a texture eight lanes at
//! once; docs/tracing.md has the measurement. Words, not floats: a driver may flush denormal floats, and integers look like them.

const ROW: u32 = 8192u;

fn words(table: texture_2d<u32>, at: u32) -> vec4<u32> {
    return textureLoad(table, vec2<u32>(at % ROW, at / ROW), 0);
}

/// One word, of arrays with four elements a texel.
fn word(table: texture_2d<u32>, at: u32) -> u32 {
    let four = words(table, at / 4u);
    let two = select(four.xy, four.zw, (at & 2u) != 0u);
    return select(two.x, two.y, (at & 1u) != 0u);
}

fn floats(table: texture_2d<u32>, at: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(words(table, at));
}
