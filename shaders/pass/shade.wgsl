//! Radiance of what a reservoir kept: f(Y) W, times visibility where slot `visibility` leaves it to shading.

import package::frame::frame::{NOW, index_of, inside};
import package::restir::reservoir::{Reservoir};
@if(environment) import package::scene::environment::{environment_radiance};
import package::slot::domain::{value, visible};
import package::slot::visibility::{TEST_SHADED};
import package::surface::{SurfaceRecord, is_surface, shown, unpack_surface};

/// Fewest scatterings of the paths that count: 0 adds what surfaces emit themselves.
override transport_min: u32 = 1u;
/// Adds what surfaces and the sky emit themselves, where the transport holds it. Of several passes of one graph, one does.
override emission: bool = true;

/// What is shaded.
@group(1) @binding(0) var<storage, read> surface: array<SurfaceRecord>;
/// Made for these surfaces.
@group(1) @binding(1) var<storage, read> reservoir: array<Reservoir>;
/// Radiance of other paths, to add to.
/// @optional
@group(1) @binding(2) var<storage, read> onto: array<vec4<f32>>;
/// What `temporal` or `spatial` made of all their inputs, with `shading = "all"`; where it says something, it is shown in place of what was kept.
/// @optional
@group(1) @binding(4) var<storage, read> light: array<vec4<f32>>;
/// Radiance; alpha is 1 where the pixel sees a surface.
@group(1) @binding(3) var<storage, read_write> color: array<vec4<f32>>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    let record = surface[at];
    var radiance = onto[at].rgb;
    if (!is_surface(record)) {
        @if(environment) {
            if (emission && transport_min == 0u) { radiance += environment_radiance(record.position); }
        }
        color[at] = vec4<f32>(radiance, 0.0);
        return;
    }
    let s = unpack_surface(record, NOW);
    let r = reservoir[at];
    let all = light[at];
    if (all.w > 0.0) {
        radiance += all.rgb;
    } else if (r.weight.value > 0.0 && (!TEST_SHADED || visible(r.sample, s))) {
        radiance += value(r.sample, s) * r.weight.value;
    }
    if (emission && transport_min == 0u) { radiance += shown(record, s.view, NOW); }
    color[at] = vec4<f32>(radiance, 1.0);
}
