//! Fills slot `magnitude`: the one number that a target function has for a colour f is its norm, √(f_r² + f_g² + f_b²) / √3; of gray, the gray.
//!
//! A sample of density p brings f / p. Summed over channels the variance of that is ∫ |f|² / p − |∫ f|², and least where p is in proportion to |f|
//! (Cauchy and Schwarz: ∫ |f|² / p ≥ (∫ |f|)² for every p of integral 1). So this is the target of least mean square error over the channels, and
//! luminance that of least noise of luminance. f is scaled by its largest channel: squares of 10⁻³⁰ and 10²⁰ are nothing and infinite.

import package::base::math::{max3};

fn magnitude(color: vec3<f32>) -> f32 {
    let most = max3(color);
    if (most <= 0.0) { return 0.0; }
    return most * length(color / most) * inverseSqrt(3.0);
}
