//! Spheres of roughness 0.1 to 0.8, metals behind and dielectrics before, under one panel of light: where samples of the light and samples
//! of the BSDF each fail alone. Nothing is smoother than 0.1, so that no path is as good as a mirror's.

use crate::build::{Shape, Stage, glow, metal, plastic};
use aquifer_scene::Scene;
use glam::Vec3;

const ROUGHNESS: [f32; 5] = [0.1, 0.2, 0.35, 0.55, 0.8];
const METALS: [[f32; 3]; 5] = [[0.96, 0.96, 0.97], [1.00, 0.78, 0.34], [0.95, 0.64, 0.54], [0.56, 0.57, 0.58], [0.91, 0.92, 0.92]];
const PAINTS: [[f32; 3]; 5] = [[0.05, 0.20, 0.50], [0.55, 0.06, 0.05], [0.60, 0.38, 0.05], [0.06, 0.35, 0.16], [0.50, 0.48, 0.46]];

pub(super) fn glossy() -> Scene {
    let mut stage = Stage::new("glossy");
    add_walls(&mut stage);
    for (i, roughness) in ROUGHNESS.into_iter().enumerate() {
        let x = 1.1 * (i as f32 - 2.0);
        let metal = stage.material(metal(&format!("metal {roughness}"), METALS[i], roughness));
        let paint = stage.material(plastic(&format!("paint {roughness}"), PAINTS[i], roughness));
        let mut pair = Shape::new(&format!("roughness {roughness}"));
        pair.ball(metal, Vec3::new(x, 0.5, -0.55), 0.5, 5);
        pair.ball(paint, Vec3::new(x * 0.86 + 0.1, 0.28, 0.75), 0.28, 5);
        stage.add(pair);
    }
    stage.camera("main", [0.0, 1.75, 5.6], [0.0, 0.52, -0.1], 30.0);
    stage.camera("low", [2.9, 0.45, 3.1], [-0.6, 0.45, -0.3], 30.0);
    stage.into_scene()
}

fn add_walls(stage: &mut Stage) {
    let floor = stage.material(plastic("floor", [0.32, 0.30, 0.28], 0.5));
    let wall = stage.material(plastic("wall", [0.42, 0.46, 0.52], 0.9));
    let panel = stage.material(glow("panel", [11.0, 10.3, 9.3]));
    let strip = stage.material(glow("strip", [2.0, 4.0, 8.0]));

    let mut walls = Shape::new("walls");
    walls.quad(floor, Vec3::new(-6.0, 0.0, 5.0), Vec3::X * 12.0, Vec3::NEG_Z * 7.0);
    walls.quad(wall, Vec3::new(-6.0, 0.0, -2.0), Vec3::X * 12.0, Vec3::Y * 5.0);
    stage.add(walls);

    let mut lights = Shape::new("lights");
    lights.quad(panel, Vec3::new(-1.8, 3.2, -0.4), Vec3::X * 3.6, Vec3::Z * 1.2);
    lights.cuboid(strip, [-4.2, 0.02, -1.2], [-4.1, 2.4, -1.1]);
    stage.add(lights);
}
