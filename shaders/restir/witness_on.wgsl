//! `restir/witness` for one who listens: writes down what every pixel looked at, carried and was offered, in the order in which it did.

import package::frame::frame::{frame, index_of, pixel_of};

const MOST = 31u;
const LOOKED = 1u;
const CARRIED = 2u;
const OFFERED = 3u;

/// 20 bytes. `place` is x and y in 16 bits each.
struct Event { kind: u32, place: u32, detail: u32, first: f32, second: f32 }

struct Testimony { count: u32, events: array<Event, 31> }

/// What was told.
@group(1) @binding(42) var<storage, read_write> testimony: array<Testimony>;

var<private> witness_at: u32;
var<private> told: u32;

fn tell(event: Event) {
    if (told < MOST) { testimony[witness_at].events[told] = event; }
    told += 1u;
    testimony[witness_at].count = min(told, MOST);
}

fn packed(pixel: vec2<i32>) -> u32 {
    return (u32(pixel.x) & 0xffffu) | (u32(pixel.y) << 16u);
}

fn tell_looked(pixel: vec2<i32>, when: u32, verdict: u32) {
    tell(Event(LOOKED | (when << 8u), packed(pixel), verdict, 0.0, 0.0));
}

fn tell_carried(pixel: u32, when: u32, weight: f32, jacobian: f32) {
    tell(Event(CARRIED | (when << 8u), packed(vec2<i32>(pixel_of(pixel))), 0u, weight, jacobian));
}

fn tell_offered(p_hat: f32, w: f32, adopted: bool) {
    tell(Event(OFFERED, 0u, u32(adopted), p_hat, w));
}

fn tell_of(pixel: vec2<u32>) {
    witness_at = index_of(pixel);
    told = 0u;
    testimony[witness_at].count = 0u;
}
