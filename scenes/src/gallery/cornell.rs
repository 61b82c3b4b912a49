//! The Cornell box (Goral et al. 1984), widened to fill a 16:9 picture: the first scene to try anything on. All surfaces are purely
//! diffuse; reflectances are those measured at Cornell, reduced to three channels. The light hangs just below the ceiling, so that nothing
//! coincides.

use crate::build::{Place, Shape, Stage, glow, matte};
use aquifer_scene::Scene;
use glam::Vec3;

const HALF_WIDTH: f32 = 1.75;
const HEIGHT: f32 = 2.0;
const HALF_DEPTH: f32 = 1.0;

pub(super) fn cornell() -> Scene {
    let mut stage = Stage::new("cornell");
    let white = stage.material(matte("white", [0.73, 0.72, 0.70]));
    let red = stage.material(matte("red", [0.61, 0.06, 0.06]));
    let green = stage.material(matte("green", [0.12, 0.45, 0.10]));
    let lamp = stage.material(glow("lamp", [20.0, 16.4, 11.6]));

    let mut room = Shape::new("room");
    let sides = [Some(red), Some(green), Some(white), Some(white), Some(white), None];
    room.room(sides, [-HALF_WIDTH, 0.0, -HALF_DEPTH], [HALF_WIDTH, HEIGHT, HALF_DEPTH]);
    stage.add(room);

    let mut blocks = Shape::new("blocks");
    blocks.block(white, [0.62, 1.24, 0.62], Place::at(-0.62, 0.0, -0.36).turned(17.0).affine());
    blocks.block(white, [0.60, 0.60, 0.60], Place::at(0.58, 0.0, 0.28).turned(-18.0).affine());
    stage.add(blocks);

    let mut light = Shape::new("light");
    light.quad(lamp, Vec3::new(-0.45, HEIGHT - 0.01, -0.28), Vec3::X * 0.9, Vec3::Z * 0.56);
    stage.add(light);

    stage.camera("main", [0.0, 1.0, 4.05], [0.0, 1.0, 0.0], 35.0);
    stage.camera("corner", [1.55, 1.75, 0.9], [-0.45, 0.55, -0.35], 52.0);
    stage.into_scene()
}
