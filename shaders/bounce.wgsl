//! The first bounce: which way it goes, and the random numbers of all that comes after it.
//!
//! Longer paths can be left to a share of the tiles of the image, so that whole groups of a GPU take the same way: L̂ = L₁ + (passes ? L₂₊ / p : 0)
//! has the mean of L₁ + L₂₊ for any p > 0 (Ouyang et al. 2021, § 5, with tiles of 64×32 and p = 0.25). A picture of one tile or two tosses one
//! coin a frame: it would pass in one frame of four, and neither the time nor the rays of a frame would tell what frames take. So tiles scale.

import package::base::math::{frame_of};
import package::base::rng::{Rng, pcg4d, rng_bits, rng_next4, rng_vertex};
import package::base::sampling::{pdf_cosine, pdf_hemisphere, sample_cosine, sample_hemisphere};
import package::frame::frame::{camera_at, frame, project};
import package::frame::random::{rng_for};
import package::surface::{Surface, scatter_sample};

/// Where initial directions are drawn from. Uniform ones had the lower variance at grazing light in Ouyang et al. 2021, fig. 14,
/// and have the higher one in docs/restir_gi.md.
/// @choices hemisphere cosine bsdf
override source: u32 = 0u;
/// Share of the tiles whose paths go on after the first bounce; 1: all.
/// @range 0.01 1
override onward_share: f32 = 1.0;
/// Pixels across a tile.
/// @range 1 1024
override tile_width: u32 = 64u;
/// Pixels down a tile.
/// @range 1 1024
override tile_height: u32 = 32u;
/// Rows of the image that tiles are meant for: they scale with the image, in steps of 8×4 pixels. 0: they do not.
/// @range 0 16384
override tile_rows: u32 = 1080u;

/// Beyond the vertices of any path: the numbers of tiles are not those of pixels.
const TILE: u32 = 0xffffffu;
/// Pixels that the threads of a group are given together.
const GROUP: vec2<u32> = vec2<u32>(8u, 4u);

/// Unit direction with its density by solid angle; 0 where nothing was drawn.
struct Direction { direction: vec3<f32>, pdf: f32 }

fn first_bounce(at: Surface, rng: ptr<function, Rng>) -> Direction {
    let u = rng_next4(rng);
    if (source == 2u) {
        let drawn = scatter_sample(at, u.xyz);
        return Direction(drawn.direction, select(0.0, drawn.pdf, dot(drawn.direction, at.normal) > 0.0));
    }
    if (source == 1u) {
        let l = sample_cosine(u.xy);
        return Direction(frame_of(at.normal) * l, pdf_cosine(l.z));
    }
    return Direction(frame_of(at.normal) * sample_hemisphere(u.xy), pdf_hemisphere());
}

/// 64 bits that give the random numbers of what follows the first bounce again, in any frame. The lowest says whether the tile passes.
fn suffix_seed(at: Surface, rng: ptr<function, Rng>) -> vec2<u32> {
    let bits = rng_bits(rng);
    return vec2<u32>((bits.x & ~1u) | u32(tile_passes(at)), bits.y);
}

fn suffix_rng(seed: vec2<u32>) -> Rng {
    return Rng(pcg4d(pcg4d(vec4<u32>(seed, frame.seed)) ^ vec4<u32>(seed.yx, seed)), 0u);
}

/// What light of longer paths is weighted by: 1 / p, or 0 in tiles that do not pass.
fn onward(seed: vec2<u32>) -> f32 {
    return select(0.0, 1.0 / onward_share, (seed.x & 1u) == 1u);
}

/// One coin for the tile that `at` is seen in, tossed anew in every frame.
fn tile_passes(at: Surface) -> bool {
    if (onward_share >= 1.0) { return true; }
    let pixel = vec2<u32>(max(project(camera_at(at.when), at.position).xy, vec2<f32>(0.0)));
    var coin = rng_for(pixel / tile());
    rng_vertex(&coin, TILE);
    return rng_next4(&coin).x < onward_share;
}

fn tile() -> vec2<u32> {
    let asked = vec2<u32>(tile_width, tile_height);
    if (tile_rows == 0u) { return asked; }
    return max(asked * frame.extent.y / max(tile_rows, 1u) / GROUP, vec2<u32>(1u)) * GROUP;
}
