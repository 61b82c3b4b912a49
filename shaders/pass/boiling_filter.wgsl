//! Boiling filter: empties reservoirs that weigh far more than those around them.
//!
//! A light that was found by luck weighs much, spreads by reuse and shows as a flash. As in NVIDIA's RTXDI, a reservoir whose p̂ W is above so
//! many times the mean of the non-empty reservoirs of its 8×8 tile is dropped with its confidence. Wire it between temporal and spatial reuse.
//! bias: it empties a reservoir because of the sample in it, so that what is hard to find darkens

import package::base::math::{is_finite};
import package::frame::frame::{NOW, index_of, inside};
import package::restir::reservoir::{Reservoir};
import package::slot::domain::{p_hat};
import package::slot::visibility::{Weight};
import package::surface::{SurfaceRecord, is_surface, unpack_surface};

struct Params {
    /// Most that a reservoir may weigh, in means of its tile.
    /// @default 40
    /// @range 1 10000
    limit: f32,
}

@group(1) @binding(0) var<uniform> params: Params;
/// What reservoirs were made for.
@group(1) @binding(1) var<storage, read> surface: array<SurfaceRecord>;
/// To be filtered.
@group(1) @binding(2) var<storage, read> current: array<Reservoir>;
/// Filtered.
@group(1) @binding(3) var<storage, read_write> reservoir: array<Reservoir>;

var<workgroup> weights: array<f32, 64>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    var own = 0.0;
    if (inside(id.xy)) { own = weight_of(index_of(id.xy)); }
    weights[local] = own;
    workgroupBarrier();
    var sum = 0.0;
    var filled = 0.0;
    for (var i = 0u; i < 64u; i++) {
        sum += weights[i];
        filled += select(0.0, 1.0, weights[i] > 0.0);
    }
    if (!inside(id.xy)) { return; }
    let at = index_of(id.xy);
    reservoir[at] = current[at];
    if (own * filled > params.limit * sum) {
        reservoir[at].weight = Weight(0.0);
        reservoir[at].confidence = 0.0;
    }
}

/// p̂ W.
fn weight_of(at: u32) -> f32 {
    let r = current[at];
    if (r.weight.value <= 0.0 || !is_surface(surface[at])) { return 0.0; }
    let weight = p_hat(r.sample, unpack_surface(surface[at], NOW)) * r.weight.value;
    return select(0.0, weight, is_finite(weight));
}
