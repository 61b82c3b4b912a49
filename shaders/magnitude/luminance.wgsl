//! Fills slot `magnitude`: the one number that a target function has for a colour is its luminance (Bitterli et al. 2020, § 5).
//!
//! What is kept in proportion to luminance has no noise of luminance left, and the more of hue: blue of luminance 0.07 is kept seldom, and shines.
//! @default

import package::base::math::{luminance};

fn magnitude(color: vec3<f32>) -> f32 {
    return luminance(color);
}
