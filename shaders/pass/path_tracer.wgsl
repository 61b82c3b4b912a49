//! The baseline: unidirectional path tracing with next-event estimation and multiple importance sampling at every vertex.
//!
//! Unbiased. Lights are drawn by slot `proposal`, power-proportional by default; BSDF sampling and light sampling are joined by the power
//! heuristic (Veach 1997, ch. 9). The g-buffer's surface is the first vertex, so that the pass measures the same pixels as every
//! resampling pass. Which lengths of paths count is the graph's `transport`.
//! @paths 0..

import package::frame::frame::{NOW, frame, index_of, inside};
import package::frame::random::{rng_for};
import package::path::{rays_traced, transport_max, transport_min, walk};
@if(environment) import package::scene::environment::{environment_radiance};
import package::surface::{SurfaceRecord, is_surface, shown, unpack_surface};

/// Paths a pixel and frame; all begin at the same surface. For more, render more frames: Mesa's lavapipe (22.3) ends the loops of an
/// invocation, all together, after 65,535 rounds, without a word.
/// @range 1 16
override samples: u32 = 1u;

/// First vertices.
@group(1) @binding(0) var<storage, read> surface: array<SurfaceRecord>;
/// Radiance; alpha is 1 where the pixel sees a surface.
@group(1) @binding(1) var<storage, read_write> color: array<vec4<f32>>;
/// Rays that were traced for the pixel.
@group(1) @binding(2) var<storage, read_write> rays: array<u32>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    let record = surface[at];
    var radiance = vec3<f32>(0.0);
    if (!is_surface(record)) {
        @if(environment) {
            if (transport_min == 0u) { radiance = environment_radiance(record.position); }
        }
        color[at] = vec4<f32>(radiance, 0.0);
        rays[at] = 0u;
        return;
    }
    let s = unpack_surface(record, NOW);
    for (var i = 0u; i < samples; i++) {
        var rng = rng_for(id.xy);
        rng.key.w += i;
        radiance += walk(s, 1u, 1.0, &rng);
    }
    radiance /= f32(samples);
    if (transport_min == 0u) { radiance += shown(record, s.view, NOW); }
    color[at] = vec4<f32>(radiance, 1.0);
    rays[at] = rays_traced;
}
