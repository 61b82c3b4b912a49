//! Presampled lights for slot `proposal` = `regir`: in each cell of a grid in the world, samples that suit what is there.
//!
//! Boksansky, Jukarainen and Wyman 2021, "Rendering Many Lights with Grid-Based Reservoirs" (Ray Tracing Gems II, ch. 23). Each slot keeps one of several
//! power-proportional candidates, by resampling with the light that reaches the cell, without cosines, as its target. The target is positive at every
//! point of a light that reaches any receiver of the cell, so that the contribution weights are unbiased for all of them.
//! @needs emissive_meshes punctual_lights environment

import package::base::math::{luminance};
import package::base::rng::{rng_bits, rng_next4};
import package::frame::frame::{NOW};
import package::frame::random::{rng_for};
import package::light_grid::{Presampled, SLOTS, cells, centre_of, light_grid, reach_of};
import package::proposal::power::{propose};
import package::slot::lights::{LightPoint, light_count, light_point};

/// Candidates a slot.
/// @range 1 64
override candidates: u32 = 8u;

/// 128 slots of each of 512 cells.
/// @extent fixed 65536
@group(1) @binding(0) var<storage, read_write> grid: array<Presampled>;

@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&grid)) { return; }
    let g = light_grid();
    let cell = id.x / SLOTS;
    if (light_count() == 0u || cell >= cells(g)) {
        grid[id.x] = Presampled(0u, 0.0, 0.0, 0.0);
        return;
    }
    let centre = centre_of(g, cell);
    let reach = reach_of(g);
    var rng = rng_for(id.xy);
    var kept: Presampled;
    var kept_target = 0.0;
    var sum = 0.0;
    for (var i = 0u; i < candidates; i++) {
        let c = propose(centre, rng_bits(&rng));
        let target_here = reaching(light_point(c.light, c.uv, NOW), centre, reach);
        let w = target_here * c.weight / f32(candidates);
        sum += w;
        if (w > 0.0 && rng_next4(&rng).x * sum < w) {
            kept = Presampled(c.light, c.uv.x, c.uv.y, 0.0);
            kept_target = target_here;
        }
    }
    if (kept_target > 0.0) { kept.weight = sum / kept_target; }
    grid[id.x] = kept;
}

/// The target: light that the point sends by uv over that distance, 0 where no receiver within `reach` of `centre` sees its front. No cosine: it would
/// make the weights of what is seen at grazing angles large.
fn reaching(p: LightPoint, centre: vec3<f32>, reach: f32) -> f32 {
    let strength = luminance(p.emission) * select(p.area, 1.0, p.delta);
    if (p.infinite) { return strength; }
    let d = centre - p.position;
    if (!p.delta && !p.double_sided && dot(d, p.normal) + reach <= 0.0) { return 0.0; }
    let distance = max(length(d), reach);
    return strength / (distance * distance);
}
