//! The random numbers of a pass.

import package::base::rng::{Rng, rng_begin};
import package::frame::frame::{frame};

/// Tells passes apart: the host gives every node of a graph its own number, made from the node's name.
override random_stage: u32 = 0u;

fn rng_for(pixel: vec2<u32>) -> Rng {
    return rng_begin(frame.seed, pixel, frame.index, random_stage);
}
