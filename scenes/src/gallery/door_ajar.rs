//! A room without a lamp: all its light comes through a door that stands ajar, from a lit room next door (after Veach 1997, fig. 9.5).
//! Nearly every path that carries light is indirect and squeezes through the gap.

use crate::build::{Place, Shape, Stage, Wall, glow, metal, plastic};
use aquifer_scene::Scene;
use glam::{Vec2, Vec3};

const HALF_WIDTH: f32 = 2.6;
const HEIGHT: f32 = 2.6;
const HALF_DEPTH: f32 = 2.2;
const WALL: f32 = 0.15;
const DOOR_LEFT: f32 = 0.75;
const DOOR_WIDTH: f32 = 0.95;
const DOOR_HEIGHT: f32 = 2.05;

pub(super) fn door_ajar() -> Scene {
    let mut stage = Stage::new("door_ajar");
    add_rooms(&mut stage);
    add_door(&mut stage);
    add_table(&mut stage);
    stage.camera("main", [-0.5, 1.45, 2.05], [0.12, 0.98, -1.4], 50.0);
    stage.camera("table", [0.75, 1.25, 1.1], [-0.85, 0.72, -0.55], 40.0);
    stage.into_scene()
}

fn add_rooms(stage: &mut Stage) {
    let plaster = stage.material(plastic("plaster", [0.70, 0.67, 0.62], 0.9));
    let red = stage.material(plastic("red wall", [0.55, 0.20, 0.14], 0.9));
    let boards = stage.material(plastic("boards", [0.36, 0.22, 0.12], 0.45));
    let lamp = stage.material(glow("lamp", [64.0, 56.0, 44.0]));

    let mut rooms = Shape::new("rooms");
    let near = [Some(red), Some(plaster), Some(boards), Some(plaster), None, Some(plaster)];
    rooms.room(near, [-HALF_WIDTH, 0.0, -HALF_DEPTH], [HALF_WIDTH, HEIGHT, HALF_DEPTH]);
    let size = Vec2::new(2.0 * HALF_WIDTH, HEIGHT);
    let low = Vec2::new(HALF_WIDTH + DOOR_LEFT, 0.0);
    let high = low + Vec2::new(DOOR_WIDTH, DOOR_HEIGHT);
    let front = Wall { corner: Vec3::new(-HALF_WIDTH, 0.0, -HALF_DEPTH), right: Vec3::X, up: Vec3::Y, size };
    rooms.pierced_wall(plaster, front, low, high, WALL);

    let far_front = -HALF_DEPTH - WALL;
    let far = [Some(plaster), Some(plaster), Some(boards), Some(plaster), Some(plaster), None];
    rooms.room(far, [-HALF_WIDTH, 0.0, far_front - 2.4], [HALF_WIDTH, HEIGHT, far_front]);
    let back = Wall { corner: Vec3::new(HALF_WIDTH, 0.0, far_front), right: Vec3::NEG_X, up: Vec3::Y, size };
    let (back_low, back_high) = (Vec2::new(size.x - high.x, 0.0), Vec2::new(size.x - low.x, high.y));
    rooms.pierced_wall(plaster, back, back_low, back_high, 0.0);
    stage.add(rooms);

    let mut light = Shape::new("light");
    light.quad(lamp, Vec3::new(HALF_WIDTH - 0.02, 0.8, far_front - 1.7), Vec3::Z * 1.3, Vec3::Y * 1.4);
    stage.add(light);
}

fn add_door(stage: &mut Stage) {
    let paint = stage.material(plastic("door", [0.62, 0.64, 0.60], 0.35));
    let brass = stage.material(metal("brass", [0.91, 0.78, 0.42], 0.25));
    let (width, height, thickness) = (DOOR_WIDTH - 0.01, DOOR_HEIGHT - 0.015, 0.04);
    // Hinged at its own x = 0; reaches towards −x.
    let mut door = Shape::new("door");
    door.cuboid(paint, [-width, 0.005, -thickness], [0.0, height, 0.0]);
    for (low, high) in [(0.18, 0.92), (1.10, 1.88)] {
        door.cuboid(paint, [0.14 - width, low, 0.0], [-0.14, high, 0.012]);
    }
    let knob = Vec3::new(0.07 - width, 1.0, 0.0);
    door.rod(brass, knob, knob + Vec3::Z * 0.05, 0.012, 12);
    door.ball(brass, knob + Vec3::Z * 0.075, 0.032, 3);
    let door = stage.mesh(door);
    stage.place(door, Place::at(DOOR_LEFT + DOOR_WIDTH - 0.005, 0.0, -HALF_DEPTH).turned(36.0));
}

fn add_table(stage: &mut Stage) {
    let wood = stage.material(plastic("table", [0.30, 0.17, 0.09], 0.3));
    let china = stage.material(plastic("china", [0.72, 0.74, 0.76], 0.15));
    let copper = stage.material(metal("copper", [0.93, 0.58, 0.44], 0.25));
    let jade = stage.material(plastic("jade", [0.10, 0.36, 0.22], 0.2));
    let mut table = Shape::new("table");
    table.cuboid(wood, [-1.75, 0.66, -1.0], [-0.15, 0.71, -0.15]);
    for (x, z) in [(-1.70, -0.95), (-0.26, -0.95), (-1.70, -0.26), (-0.26, -0.26)] {
        table.cuboid(wood, [x, 0.0, z], [x + 0.06, 0.66, z + 0.06]);
    }
    stage.add(table);

    let mut crockery = Shape::new("crockery");
    let vase = [(0.0, 0.0), (0.07, 0.0), (0.10, 0.06), (0.12, 0.14), (0.09, 0.24), (0.045, 0.31), (0.05, 0.36), (0.065, 0.39), (0.0, 0.37)];
    crockery.lathe(china, Vec3::new(-1.40, 0.71, -0.62), &vase.map(Vec2::from), 40);
    let bowl = [(0.0, 0.0), (0.06, 0.0), (0.13, 0.05), (0.17, 0.12), (0.16, 0.12), (0.12, 0.06), (0.0, 0.03)];
    crockery.lathe(copper, Vec3::new(-0.85, 0.71, -0.50), &bowl.map(Vec2::from), 40);
    crockery.ball(jade, Vec3::new(-0.46, 0.80, -0.68), 0.09, 4);
    stage.add(crockery);
}
