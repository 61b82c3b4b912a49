//! A vaulted hall hung with 256 lanterns of 20 emissive triangles each, 5,120 in all, whose power spans nearly four decades: most
//! lanterns matter to hardly any pixel, and which ones matter changes across the picture. What light sampling is measured on.

use crate::build::{Place, Random, Shape, Stage, glow, metal, plastic};
use aquifer_scene::Scene;
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::PI;

const LANTERNS: usize = 256;
const TINTS: [[f32; 3]; 8] = [
    [1.0, 0.62, 0.28],
    [1.0, 0.78, 0.50],
    [1.0, 0.45, 0.16],
    [0.55, 0.75, 1.0],
    [1.0, 0.35, 0.30],
    [0.40, 1.0, 0.62],
    [0.75, 0.50, 1.0],
    [1.0, 0.90, 0.75],
];
/// Each step is half a decade of radiance.
const STEPS: i32 = 6;
const HALF_WIDTH: f32 = 5.0;
const LENGTH: f32 = 26.0;
const SPRING: f32 = 4.6;

pub(super) fn many_lights() -> Scene {
    let mut stage = Stage::new("many_lights");
    add_hall(&mut stage);
    add_columns(&mut stage);
    add_lanterns(&mut stage);
    stage.camera("main", [-1.5, 1.9, 1.4], [0.9, 2.35, -14.0], 52.0);
    stage.camera("above", [0.0, 6.2, -1.0], [0.0, 0.5, -14.0], 60.0);
    stage.into_scene()
}

fn add_hall(stage: &mut Stage) {
    let floor = stage.material(plastic("floor", [0.20, 0.13, 0.10], 0.25));
    let inlay = stage.material(plastic("inlay", [0.46, 0.42, 0.36], 0.25));
    let wall = stage.material(plastic("plaster", [0.52, 0.44, 0.36], 0.9));
    let mut hall = Shape::new("hall");
    let tile = Vec2::new(1.25, 1.3);
    for row in 0..(LENGTH / tile.y) as i32 + 2 {
        for column in 0..8 {
            let material = if (row + column) % 2 == 0 { floor } else { inlay };
            let corner = Vec3::new(tile.x * (column as f32 - 4.0), 0.0, 2.6 - tile.y * row as f32);
            hall.quad(material, corner, Vec3::X * tile.x, Vec3::NEG_Z * tile.y);
        }
    }
    let sides = [Some(wall), Some(wall), None, None, Some(wall), Some(wall)];
    hall.room(sides, [-HALF_WIDTH, 0.0, 2.6 - LENGTH], [HALF_WIDTH, SPRING + HALF_WIDTH, 2.6]);
    add_vault(&mut hall, wall);
    stage.add(hall);
}

/// A barrel vault over the whole length, seen from below.
fn add_vault(hall: &mut Shape, material: u32) {
    let segments = 20;
    let at = |i: i32| {
        let (sin, cos) = (PI * i as f32 / segments as f32).sin_cos();
        Vec3::new(HALF_WIDTH * cos, SPRING + HALF_WIDTH * sin, 2.6)
    };
    for i in 0..segments {
        hall.quad(material, at(i), Vec3::NEG_Z * LENGTH, at(i + 1) - at(i));
    }
}

fn add_columns(stage: &mut Stage) {
    let stone = stage.material(plastic("stone", [0.58, 0.54, 0.48], 0.55));
    let mut column = Shape::new("column");
    column.cuboid(stone, [-0.45, 0.0, -0.45], [0.45, 0.25, 0.45]);
    let profile = [(0.42, 0.25), (0.44, 0.33), (0.36, 0.42), (0.32, 0.55), (0.29, 2.2), (0.26, 3.9), (0.30, 4.05), (0.44, 4.25)];
    column.lathe(stone, Vec3::ZERO, &profile.map(Vec2::from), 28);
    column.cuboid(stone, [-0.5, 4.25, -0.5], [0.5, SPRING, 0.5]);
    let column = stage.mesh(column);

    let mut beam = Shape::new("beam");
    beam.cuboid(stone, [-0.45, SPRING, 2.6 - LENGTH], [0.45, SPRING + 0.35, 2.6]);
    let beam = stage.mesh(beam);
    for x in [-3.4, 3.4] {
        stage.place(beam, Place::at(x, 0.0, 0.0));
        for i in 0..7 {
            stage.place(column, Place::at(x, 0.0, -0.6 - 3.4 * i as f32));
        }
    }
}

fn add_lanterns(stage: &mut Stage) {
    let mut random = Random::new(41);
    let wire = stage.material(metal("wire", [0.30, 0.26, 0.22], 0.5));
    let mut cord = Shape::new("cord");
    cord.tube(wire, Vec3::ZERO, Vec3::Y, [0.006; 2], 5);
    let cord = stage.mesh(cord);
    let lanterns = lantern_meshes(stage);
    for i in 0..LANTERNS {
        let along = (i as f32 + random.unit()) / LANTERNS as f32;
        let x = random.range(-2.7, 2.7);
        let wave = 0.6 * (along * 17.0).sin();
        let place = Vec3::new(x, 3.4 + wave + random.range(-1.2, 1.4), 0.2 - 22.5 * along);
        let size = random.decades(0.035, 0.17);
        let turn = Quat::from_rotation_y(random.range(0.0, PI));
        let lantern = lanterns[random.index(lanterns.len())];
        stage.place(lantern, Place::at(place.x, place.y, place.z).rotated(turn).sized(size));
        let ceiling = SPRING + (HALF_WIDTH * HALF_WIDTH - x * x).sqrt();
        let stretch = Vec3::new(1.0, ceiling - place.y - size, 1.0);
        stage.place(cord, Place::at(place.x, place.y + size, place.z).stretched(stretch));
    }
}

/// One unit lantern for each tint and strength.
fn lantern_meshes(stage: &mut Stage) -> Vec<u32> {
    let mut meshes = Vec::new();
    for (number, tint) in TINTS.into_iter().enumerate() {
        for step in 0..STEPS {
            let name = format!("lantern {number}.{step}");
            let radiance = 0.22 * 10.0_f32.powf(0.5 * step as f32);
            let light = stage.material(glow(&name, tint.map(|channel| channel * radiance)));
            let mut lantern = Shape::new(&name);
            lantern.ball(light, Vec3::ZERO, 1.0, 0);
            meshes.push(stage.mesh(lantern));
        }
    }
    meshes
}
