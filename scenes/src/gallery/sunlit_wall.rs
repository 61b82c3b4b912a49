//! A yard whose floor lies in shadow: the sun reaches a coloured wall through a slot in the roof, and the wall lights everything else. All
//! light on the floor is one bounce old and comes from a small bright patch, as in figure 7 of the ReSTIR GI paper (Ouyang et al. 2021).

use crate::build::{Place, Shape, Stage, metal, plastic};
use aquifer_scene::Scene;
use glam::{Vec2, Vec3};

const HALF_WIDTH: f32 = 3.0;
const HEIGHT: f32 = 3.4;
const HALF_DEPTH: f32 = 2.5;
/// The slot runs along the wall at −x.
const SLOT: f32 = 0.55;

pub(super) fn sunlit_wall() -> Scene {
    let mut stage = Stage::new("sunlit_wall");
    add_yard(&mut stage);
    add_things(&mut stage);
    stage.sun("sun", [-0.20, -0.95, -0.24], [27.0, 25.0, 21.0]);
    stage.camera("main", [2.0, 1.4, 2.2], [-0.75, 0.66, -1.0], 48.0);
    stage.camera("floor", [0.6, 1.1, 1.6], [-1.6, 0.1, -0.5], 45.0);
    stage.into_scene()
}

fn add_yard(stage: &mut Stage) {
    let ochre = stage.material(plastic("ochre wall", [0.78, 0.42, 0.12], 0.9));
    let plaster = stage.material(plastic("plaster", [0.72, 0.70, 0.66], 0.9));
    let slabs = stage.material(plastic("slabs", [0.50, 0.49, 0.47], 0.7));
    let joint = stage.material(plastic("joint", [0.24, 0.23, 0.22], 1.0));
    let mut yard = Shape::new("yard");
    let sides = [Some(ochre), Some(plaster), Some(joint), None, Some(plaster), Some(plaster)];
    yard.room(sides, [-HALF_WIDTH, 0.0, -HALF_DEPTH], [HALF_WIDTH, HEIGHT, HALF_DEPTH]);
    yard.cuboid(plaster, [SLOT - HALF_WIDTH, HEIGHT - 0.001, -HALF_DEPTH - 0.3], [HALF_WIDTH + 0.3, HEIGHT + 0.25, HALF_DEPTH + 0.3]);
    for i in 0..6 {
        for k in 0..5 {
            let (x, z) = (i as f32 - HALF_WIDTH, k as f32 - HALF_DEPTH);
            yard.cuboid(slabs, [x + 0.012, -0.05, z + 0.012], [x + 0.988, 0.015, z + 0.988]);
        }
    }
    stage.add(yard);
}

fn add_things(stage: &mut Stage) {
    let clay = stage.material(plastic("clay", [0.48, 0.20, 0.11], 0.8));
    let white = stage.material(plastic("chalk", [0.80, 0.79, 0.77], 0.9));
    let steel = stage.material(metal("steel", [0.76, 0.75, 0.74], 0.3));
    let green = stage.material(plastic("glazed", [0.08, 0.30, 0.24], 0.25));
    let ground = 0.015;
    let mut things = Shape::new("things");
    let pot = [(0.0, 0.0), (0.22, 0.0), (0.34, 0.22), (0.40, 0.50), (0.36, 0.78), (0.24, 0.94), (0.28, 1.02), (0.22, 1.0), (0.0, 0.7)];
    things.lathe(clay, Vec3::new(-1.75, ground, -1.55), &pot.map(Vec2::from), 48);
    things.ball(steel, Vec3::new(-0.55, ground + 0.42, -1.05), 0.42, 5);
    things.ball(green, Vec3::new(0.25, ground + 0.24, -0.15), 0.24, 5);
    things.block(white, [0.7, 1.3, 0.7], Place::at(0.75, ground, -1.6).turned(24.0).affine());
    things.block(white, [0.9, 0.35, 0.55], Place::at(-1.35, ground, 0.35).turned(-15.0).affine());
    stage.add(things);
}
