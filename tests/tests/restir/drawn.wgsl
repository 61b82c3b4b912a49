//! Of samples that rays of a pixel's surface have met: how many does the domain's own test of visibility find from there?

import package::frame::frame::{NOW, index_of, inside};
import package::frame::random::{rng_for};
import package::slot::domain::{draw, visible};
import package::surface::{SurfaceRecord, is_surface, unpack_surface};

const SAMPLES = 16u;

@group(1) @binding(0) var<storage, read> surface: array<SurfaceRecord>;
/// Drawn, and found.
@group(1) @binding(1) var<storage, read_write> counts: array<vec2<f32>>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    var found = vec2<f32>(0.0);
    if (is_surface(surface[at])) {
        let s = unpack_surface(surface[at], NOW);
        var rng = rng_for(id.xy);
        for (var i = 0u; i < SAMPLES; i++) {
            let drawn = draw(s, i, SAMPLES, &rng);
            if (drawn.weight > 0.0) { found += vec2<f32>(1.0, select(0.0, 1.0, visible(drawn.sample, s))); }
        }
    }
    counts[at] = found;
}
