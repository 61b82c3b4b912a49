//! What scenes are made with: shapes, materials, painted images, skies, and a stage to place them on.

mod grid;
mod material;
mod noise;
mod normals;
mod opening;
mod paint;
mod place;
mod random;
mod round;
mod shape;
mod sky;
mod stage;

pub use grid::height_field;
pub use material::{glow, matte, metal, plastic};
pub use noise::Noise;
pub use opening::Wall;
pub use paint::{heights_to_normals, paint, paint_data, tiled, transformed};
pub use place::{Place, facing};
pub use random::Random;
pub use shape::Shape;
pub use sky::{Sky, sky};
pub use stage::Stage;
