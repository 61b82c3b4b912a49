//! Temporal reuse: joins each pixel's reservoir with the one that last frame left where its surface was.
//!
//! Bitterli et al. 2020, § 3.2 and § 5. The pixel of last frame is found by the motion of the surface; where it is not like this one, pixels around it are
//! tried. Last frame's targets are evaluated in last frame's world: its camera, g-buffer, transforms, lights and hierarchy. Which history is taken
//! depends on the g-buffer alone, and capping its confidence changes no weight: with an unbiased rule in slot `mis` the pass is unbiased.
//! @needs emissive_meshes punctual_lights environment

import package::base::math::{HUGE};
import package::frame::frame::{BEFORE, NOW, index_of, inside};
import package::frame::random::{rng_for};
import package::restir::inputs::{Input, MAX_INPUTS, current, input_of, surface};
import package::restir::neighbour::{NOWHERE, similarity};
import package::restir::reproject::{Search, pixel_before};
import package::restir::reservoir::{Reservoir};
import package::restir::stale::{is_stale};
import package::restir::witness::{tell_of};
import package::slot::mis::{combine};
import package::slot::shading::{keep_light};
import package::surface::{is_surface, unpack_surface};

struct Params {
    /// Most that a history counts, in confidences of a fresh reservoir.
    /// @default 20
    /// @range 1 500
    cap: f32,
    /// Largest angle between normals of a surface and its history, degrees.
    /// @default 25
    /// @range 0 180
    normal: f32,
    /// Largest difference of camera distances, as a share.
    /// @default 0.1
    /// @range 0 1
    depth: f32,
    /// Radius around the pixel of last frame in which further pixels are tried, pixels.
    /// @default 4
    /// @range 0 64
    search: f32,
}

/// Further pixels that are tried where the first is not alike.
/// @range 0 16
override tries: u32 = 2u;

/// Takes the history of another pixel nearby, another one every frame: what pixels share by reuse does not stay together.
override permute: bool = false;

@group(1) @binding(0) var<uniform> params: Params;
/// From this frame's film position to last frame's, pixels.
@if(moving_camera || moving_objects) @group(1) @binding(1) var<storage, read> motion: array<vec2<f32>>;
/// Both joined.
@group(1) @binding(3) var<storage, read_write> reservoir: array<Reservoir>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    tell_of(id.xy);
    let record = surface[at];
    if (!is_surface(record)) {
        reservoir[at] = current[at];
        keep_light(at);
        return;
    }
    var rng = rng_for(id.xy);
    let limits = similarity(params.normal, params.depth);
    var moved = vec2<f32>(0.0);
    @if(moving_camera || moving_objects) { moved = motion[at]; }
    let before = pixel_before(id.xy, moved, record, Search(tries, params.search, permute), limits, &rng);
    if (before == NOWHERE || is_stale(at)) {
        reservoir[at] = current[at];
        keep_light(at);
        return;
    }
    let s = unpack_surface(record, NOW);
    var inputs: array<Input, MAX_INPUTS>;
    inputs[0] = input_of(at, NOW, HUGE);
    inputs[1] = input_of(before, BEFORE, params.cap);
    reservoir[at] = combine(s, &inputs, 2u, &rng);
    keep_light(at);
}
