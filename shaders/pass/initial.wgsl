//! The first reservoir of each pixel: candidates of slot `domain`, one kept by resampled importance sampling; and, now and then, validation.
//!
//! Bitterli et al. 2020, alg. 3. Whether a ray then tests the sample that was kept is slot `visibility`'s to say. In a frame of validation a pixel
//! that has a history does not draw: it finds what its history's sample stands for anew, from the same random numbers, and where that has
//! changed, or the sample is hidden, says so on `stale`. The pass that made the history, and those after it, then let it go
//! (Ouyang et al. 2021, § 5), and in that frame the pixel has its neighbours' samples alone, unless `redraw` has it draw after all. The history that
//! is looked at is the one that a pass with the same `normal` and `depth` and without `permute` takes. Where neither lights nor objects move, nothing
//! is validated.
//! @needs emissive_meshes punctual_lights environment

import package::frame::frame::{NOW, index_of, inside};
@if(moving_lights || moving_objects) import package::frame::frame::{frame};
import package::frame::random::{rng_for};
import package::restir::inputs::{history, surface};
import package::restir::neighbour::{NOWHERE, similarity};
import package::restir::reproject::{exactly, pixel_before};
import package::restir::reservoir::{Reservoir};
import package::restir::ris::{resample};
import package::restir::witness::{tell_of};
import package::slot::domain::{changed, visible};
import package::surface::{is_surface, unpack_surface};

struct Params {
    /// Change of radiance, as a share, that validation lets pass.
    /// @default 0.1
    /// @range 0 10
    tolerance: f32,
    /// Largest angle between normals of a surface and its history, degrees.
    /// @default 25
    /// @range 0 180
    normal: f32,
    /// Largest difference of camera distances, as a share.
    /// @default 0.05
    /// @range 0 1
    depth: f32,
}

/// Candidates a pixel.
/// @range 1 1024
override candidates: u32 = 32u;
/// Samples a pixel that are drawn so, each of candidates of its own, and tested where slot `visibility` tests them; one is kept. No more than 16:
/// Mesa's lavapipe ends an invocation's loops after 65,535 rounds, those of candidates and of rays together.
/// @range 1 16
override winners: u32 = 1u;
/// Frames from one validation to the next; 0: none.
/// @range 0 1024
/// @unbiased 0
/// @why which histories are let go depends on their samples
override validate_every: u32 = 0u;
/// A pixel whose history's sample no longer holds draws in the same frame: these pixels' rays come on top of those of validation. Pixels whose history
/// goes for a neighbour's (`spread`) do not draw.
override redraw: bool = false;

@group(1) @binding(0) var<uniform> params: Params;
/// From this frame's film position to last frame's, pixels; for validation.
/// @optional
@if(moving_lights || moving_objects) @group(1) @binding(1) var<storage, read> motion: array<vec2<f32>>;
/// What was kept; of confidence 1, or 0 where nothing was drawn.
@group(1) @binding(2) var<storage, read_write> reservoir: array<Reservoir>;
/// 1 where the pixel's history holds no longer.
@if(moving_lights || moving_objects) @group(1) @binding(3) var<storage, read_write> stale: array<u32>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    tell_of(id.xy);
    let record = surface[at];
    var kept: Reservoir;
    var lost = false;
    if (is_surface(record)) {
        var rng = rng_for(id.xy);
        let s = unpack_surface(record, NOW);
        var draws = true;
        @if(moving_lights || moving_objects) {
            var before = NOWHERE;
            if (validate_every > 0u && frame.moving != 0u && frame.index % max(validate_every, 1u) == 0u) {
                before = pixel_before(id.xy, motion[at], record, exactly(), similarity(params.normal, params.depth), &rng);
            }
            if (before != NOWHERE && history[before].weight.value > 0.0) {
                let sample = history[before].sample;
                lost = changed(sample, params.tolerance) || !visible(sample, s);
                draws = lost && redraw;
            }
        }
        if (draws) { kept = resample(s, candidates, winners, &rng); }
    }
    reservoir[at] = kept;
    @if(moving_lights || moving_objects) { stale[at] = u32(lost); }
}
