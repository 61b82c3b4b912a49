//! Fills slot `shading`: every input that is joined is shaded, each with its share; for `shade` to show in place of what was kept.
//!
//! Of the inputs' samples y_i one is kept with probability w_i / Σw, w_i = m_i(y_i) p̂(y_i) W_i |∂T_i/∂x_i|, and f(Y) Σw / p̂(Y) is shaded. Given the
//! inputs, its expectation over that choice is
//!
//!   Σ_i (w_i / Σw) f(y_i) Σw / p̂(y_i) = Σ_i m_i(y_i) f(y_i) W_i |∂T_i/∂x_i|,
//!
//! which is what is written here: the same mean, biased or not, and never more variance (Rao and Blackwell). Where p̂ is the luminance of f,
//! visibility in both, the luminance of both is the same, and it is the hue of the one sample that is no longer noise. What is kept for reuse stays
//! one sample. Where slot `visibility` leaves visibility to shading, each input costs a ray. `contribution` knows m_i at no input but the one that
//! was kept: with it, what was kept is shaded.

import package::base::math::{is_finite};
import package::restir::inputs::{Candidate};
import package::slot::domain::{value, visible};
import package::slot::visibility::{TEST_SHADED};
import package::surface::{Surface};

var<private> light_sum: vec3<f32>;
var<private> light_told: f32;

/// Radiance of all inputs; alpha is 1 where the rule told of them, else 0.
@group(1) @binding(20) var<storage, read_write> light: array<vec4<f32>>;

/// Tells of an input with its share, m_i W_i |∂T_i/∂x_i|.
fn shade_input(at: Surface, y: Candidate, share: f32) {
    light_told = 1.0;
    // As in `offer`: what is no number is dropped.
    if (!is_finite(share * y.p_hat) || share * y.p_hat <= 0.0) { return; }
    if (TEST_SHADED && !visible(y.sample, at)) { return; }
    light_sum += value(y.sample, at) * share;
}

/// Ends a pixel.
fn keep_light(pixel: u32) {
    light[pixel] = vec4<f32>(light_sum, light_told);
}
