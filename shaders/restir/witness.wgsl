//! Where resampling says what it does; here nobody listens. `restir/witness_on` takes this module's place where somebody does, as the viewer's
//! inspector: what is told decides nothing.

/// A pixel was looked at: one of this frame or of the one before, and what spoke against it (`restir/neighbour`).
fn tell_looked(pixel: vec2<i32>, when: u32, verdict: u32) {}

/// A reservoir's sample came to the receiver, with the contribution weight that it had and the Jacobian of its way; 0: it has none.
fn tell_carried(pixel: u32, when: u32, weight: f32, jacobian: f32) {}

/// The sample was offered, with its target here and its resampling weight.
fn tell_offered(p_hat: f32, w: f32, adopted: bool) {}

/// What follows is told of this pixel.
fn tell_of(pixel: vec2<u32>) {}
