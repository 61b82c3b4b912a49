//! Fills slot `shading`: what was kept is shaded, and nothing else.
//! @default

import package::restir::inputs::{Candidate};
import package::surface::{Surface};

/// Tells of an input with its share, m_i W_i |∂T_i/∂x_i|.
fn shade_input(at: Surface, y: Candidate, share: f32) {}

/// Ends a pixel.
fn keep_light(pixel: u32) {}
