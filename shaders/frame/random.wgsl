//! The random numbers of a pass.

import package::base::rng::{Rng, rng_begin};
import package::frame::frame::{frame};

/// Tells passes apart: the host gives every node of a graph its own number, made from the node's name.
override random_stage: u32 = 0u;

fn rng_for(pixel: vec2<u32>) -> Rng {
    return rng_begin(frame.seed, pixel, frame.index, random_stage);
}

/// The numbers that all pixels and passes of a frame share: those of a pixel that no image has.
fn rng_of_frame() -> Rng {
    return rng_begin(frame.seed, vec2<u32>(0xffffffffu), frame.index, 0u);
}
