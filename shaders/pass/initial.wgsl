//! The first reservoir of each pixel: candidates of slot `domain`, one kept by resampled importance sampling.
//!
//! Bitterli et al. 2020, alg. 3. Whether a ray then tests the sample that was kept is slot `visibility`'s to say.

import package::frame::frame::{NOW, index_of, inside};
import package::frame::random::{rng_for};
import package::restir::reservoir::{Reservoir};
import package::restir::ris::{resample};
import package::surface::{SurfaceRecord, is_surface, unpack_surface};

/// Candidates a pixel.
/// @range 1 1024
override candidates: u32 = 32u;

/// Where samples are for.
@group(1) @binding(0) var<storage, read> surface: array<SurfaceRecord>;
/// What was kept; of confidence 1.
@group(1) @binding(1) var<storage, read_write> reservoir: array<Reservoir>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    let record = surface[at];
    var kept: Reservoir;
    if (is_surface(record)) {
        var rng = rng_for(id.xy);
        kept = resample(unpack_surface(record, NOW), candidates, &rng);
    }
    reservoir[at] = kept;
}
