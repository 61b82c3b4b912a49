//! Reservoirs that show Σm of a rule without noise.
//!
//! Every input that could have made y holds T_i⁻¹ y with the contribution weight that makes W_i |∂T_i/∂x| = 1. Whichever is chosen is y, and what
//! comes out weighs Σ m_i(y). Each nine pixels have a y of their own; every third pixel is taken for one of last frame.

import package::frame::frame::{BEFORE, NOW, frame, index_of, inside};
import package::restir::reservoir::{Reservoir};
import package::slot::domain::{Sample, p_hat, pixel, shift, surface_of, visible};
import package::slot::visibility::{IN_TARGET, Weight};
import package::surface::{Surface, pack_surface, unpack_surface};

@group(1) @binding(0) var<storage, read_write> reservoir: array<Reservoir>;
/// 1 for an input that could have made y.
@group(1) @binding(1) var<storage, read_write> able: array<f32>;

@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (!inside(id.xy)) { return; }
    let index = index_of(id.xy);
    let i = index % 9u;
    let u = (f32(index / 9u) + 0.5) / f32(arrayLength(&able) / 9u);
    let at = seen(0u, NOW);
    let s = seen(i, select(NOW, BEFORE, i % 3u == 2u));
    let y = Sample(u + pixel(0u).k * u * u);
    var t = shift(y, at, s);
    if (i == 0u) {
        t.sample = y;
        t.p_hat = p_hat(y, at);
        t.jacobian = 1.0;
    }
    let can = t.jacobian > 0.0 && t.p_hat > 0.0 && (!IN_TARGET || visible(t.sample, s));
    reservoir[index] = Reservoir(t.sample, Weight(select(0.0, t.jacobian, can)), 1.0);
    able[index] = select(0.0, 1.0, can);
}

/// The surface of a pixel as a pass unpacks it, with its view.
fn seen(i: u32, when: u32) -> Surface {
    return unpack_surface(pack_surface(surface_of(pixel(i), when), 1.0), when);
}
