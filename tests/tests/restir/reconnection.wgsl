//! Samples of the hemisphere at q, carried to r by the domain's shift, beside samples of r's own hemisphere: both estimate the light that r reflects.
//!
//! All light comes from a disk whose radiance varies over it; q and r see all of it.

import package::base::math::{PI};
import package::base::rng::{rng_begin, rng_next4};
import package::base::sampling::{sample_hemisphere};
import package::cached::{PathEnd, keep};
import package::frame::frame::{NOW};
import package::slot::domain::{Sample, shift, value};
import package::surface::{Surface};

/// One case: heights of q and r below the disk, how far aside they are, and the disk's slope.
struct Case { q: f32, r: f32, aside: f32, slope: f32 }

const CASES = array<Case, 6>(Case(1.0, 0.4, 0.0, 0.0), Case(0.4, 1.0, 0.0, 0.0), Case(1.0, 3.0, 0.5, 0.0), Case(1.2, 0.6, 0.2, 0.6), Case(0.6, 1.2, 0.3, 0.6),
    Case(1.5, 3.0, 1.0, -0.9));
const RADIUS = 0.3;
/// Of each pair.
const SAMPLES = 16u;

/// Pairs: from q by reconnection, from r itself.
/// @extent fixed 786432
@group(1) @binding(0) var<storage, read_write> estimates: array<vec2<f32>>;

fn receiver(position: vec3<f32>) -> Surface {
    var s: Surface;
    s.position = position;
    s.when = NOW;
    s.view = vec3<f32>(0.0, 0.6, 0.8);
    s.normal = vec3<f32>(0.0, 0.0, 1.0);
    s.geometric = s.normal;
    s.size = 1.0;
    s.bsdf.base = vec3<f32>(0.8);
    s.bsdf.alpha = 1.0;
    return s;
}

/// What a ray from `s` meets; of no radiance beside the disk.
fn found(s: Surface, direction: vec3<f32>, normal: vec3<f32>) -> PathEnd {
    let facing = dot(normal, direction);
    let t = select(-1.0, dot(normal, -s.position) / facing, facing < 0.0);
    let p = s.position + t * direction;
    let on = t > 0.0 && length(p) < RADIUS;
    return PathEnd(p, 1.0, normal, select(vec3<f32>(0.0), vec3<f32>(1.0, 2.0, 0.5) * (1.0 + 2.0 * p.x + p.y), on), vec2<u32>(0u), -direction, t);
}

@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&estimates)) { return; }
    let c = CASES[id.x % 6u];
    let normal = -normalize(vec3<f32>(c.slope, 0.0, 1.0));
    let q = receiver(vec3<f32>(0.1, -0.05, -c.q));
    let r = receiver(vec3<f32>(c.aside, 0.1, -c.r));
    var rng = rng_begin(vec2<u32>(5u, 8u), id.xy, 0u, 0u);
    var sums = vec2<f32>(0.0);
    for (var i = 0u; i < SAMPLES; i++) {
        let from_q = Sample(keep(found(q, sample_hemisphere(rng_next4(&rng).xy), normal)));
        let from_r = Sample(keep(found(r, sample_hemisphere(rng_next4(&rng).xy), normal)));
        let t = shift(from_q, q, r);
        if (t.jacobian > 0.0) { sums.x += t.value.y * t.jacobian; }
        sums.y += value(from_r, r).y;
    }
    estimates[id.x] = sums * (2.0 * PI / f32(SAMPLES));
}
