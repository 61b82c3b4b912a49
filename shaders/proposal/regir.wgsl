//! Fills slot `proposal`: a light sample from the receiver's cell of a grid that `pass/regir` filled.
//!
//! The density of such a sample is not known; MIS weights take the power-proportional one, which is positive wherever this one is. Receivers outside
//! the grid get power-proportional samples.

import package::base::rng::{below};
import package::light_grid::{Presampled, SLOTS, cell_of, is_in_grid, light_grid};
import package::proposal::power::{propose as propose_by_power, weighting_pdf as pdf_by_power};

/// A light, a place in its uv, and its contribution weight.
struct Candidate { light: u32, uv: vec2<f32>, weight: f32 }

/// Presampled lights; wire it to `regir.grid`.
/// @extent fixed 65536
@group(1) @binding(30) var<storage, read> grid: array<Presampled>;

fn propose(receiver: vec3<f32>, bits: vec4<u32>) -> Candidate {
    let g = light_grid();
    if (!is_in_grid(g, receiver)) {
        let c = propose_by_power(receiver, bits);
        return Candidate(c.light, c.uv, c.weight);
    }
    // Ten bits an axis: from −1/2 to 1/2 of a cell.
    let moved = (vec3<f32>((vec3<u32>(bits.x) >> vec3<u32>(0u, 10u, 20u)) & vec3<u32>(1023u)) + 0.5) / 1024.0 - 0.5;
    let kept = grid[cell_of(g, receiver + g.cell * moved) * SLOTS + below(bits.y, SLOTS)];
    return Candidate(kept.light, vec2<f32>(kept.u, kept.v), kept.weight);
}

/// Density by uv that MIS weights take this proposal for.
fn weighting_pdf(light: u32, receiver: vec3<f32>) -> f32 {
    return pdf_by_power(light, receiver);
}
