//! A living room by day, with one window: the sun (directional) falls through it, a point light shines in a floor lamp, a spot light on a
//! picture. The three kinds of punctual light at once, with their units and falloff in plain sight. A pale panel outside stands for the
//! sky.

use crate::build::{Place, Shape, Stage, Wall, glow, matte, metal, plastic};
use aquifer_scene::Scene;
use glam::{Vec2, Vec3};

const LOW: [f32; 3] = [-2.8, 0.0, -2.2];
const HIGH: [f32; 3] = [2.8, 2.7, 2.4];

pub(super) fn sun_room() -> Scene {
    let mut stage = Stage::new("sun_room");
    add_room(&mut stage);
    add_outside(&mut stage);
    add_furniture(&mut stage);
    add_floor_lamp(&mut stage);
    add_picture(&mut stage);
    stage.camera("main", [0.9, 1.45, 2.25], [-0.55, 0.95, -1.2], 56.0);
    stage.camera("window", [-2.2, 1.5, 1.6], [2.4, 1.2, -0.6], 50.0);
    stage.into_scene()
}

fn add_room(stage: &mut Stage) {
    let plaster = stage.material(plastic("plaster", [0.74, 0.71, 0.66], 0.9));
    let oak = stage.material(plastic("oak", [0.42, 0.27, 0.15], 0.4));
    let frame = stage.material(plastic("frame", [0.78, 0.78, 0.76], 0.4));
    let mut room = Shape::new("room");
    let sides = [Some(plaster), None, Some(oak), Some(plaster), Some(plaster), Some(plaster)];
    room.room(sides, LOW, HIGH);
    let wall = Wall { corner: Vec3::new(HIGH[0], 0.0, LOW[2]), right: Vec3::Z, up: Vec3::Y, size: Vec2::new(HIGH[2] - LOW[2], HIGH[1]) };
    let (low, high) = (Vec2::new(0.8, 0.7), Vec2::new(2.9, 2.3));
    room.pierced_wall(plaster, wall, low, high, 0.22);
    stage.add(room);

    let mut bars = Shape::new("window bars");
    let (z0, z1, x) = (LOW[2] + low.x, LOW[2] + high.x, HIGH[0] + 0.12);
    for i in 0..=3 {
        let z = z0 + (z1 - z0) * i as f32 / 3.0;
        bars.cuboid(frame, [x, low.y, z - 0.025], [x + 0.05, high.y, z + 0.025]);
    }
    for i in 0..=2 {
        let y = low.y + (high.y - low.y) * i as f32 / 2.0;
        bars.cuboid(frame, [x + 0.005, y - 0.025, z0], [x + 0.045, y + 0.025, z1]);
    }
    stage.add(bars);
}

fn add_outside(stage: &mut Stage) {
    let sky = stage.material(glow("sky", [2.6, 3.8, 5.6]));
    let mut panel = Shape::new("sky");
    // Low enough that the sun passes over it.
    panel.quad(sky, Vec3::new(9.0, -1.0, -7.0), Vec3::Z * 14.0, Vec3::Y * 4.2);
    stage.add(panel);
    stage.sun("sun", [-0.80, -0.62, -0.22], [40.0, 35.0, 27.5]);
}

fn add_furniture(stage: &mut Stage) {
    let cloth = stage.material(plastic("cloth", [0.16, 0.28, 0.36], 1.0));
    let cushion = stage.material(plastic("cushion", [0.72, 0.42, 0.10], 1.0));
    let rug = stage.material(matte("rug", [0.50, 0.14, 0.12]));
    let glaze = stage.material(plastic("glaze", [0.75, 0.76, 0.78], 0.12));
    let wood = stage.material(plastic("walnut", [0.22, 0.12, 0.07], 0.3));

    let mut sofa = Shape::new("sofa");
    sofa.cuboid(cloth, [-1.7, 0.08, -1.95], [0.3, 0.42, -1.05]);
    sofa.cuboid(cloth, [-1.7, 0.42, -1.95], [0.3, 0.92, -1.70]);
    sofa.cuboid(cloth, [-1.92, 0.08, -1.95], [-1.7, 0.64, -1.05]);
    sofa.cuboid(cloth, [0.3, 0.08, -1.95], [0.52, 0.64, -1.05]);
    sofa.block(cushion, [0.42, 0.40, 0.12], Place::at(-1.35, 0.43, -1.55).turned(20.0).affine());
    stage.add(sofa);

    let mut table = Shape::new("table");
    table.cuboid(rug, [-1.9, 0.0, -0.85], [0.9, 0.012, 0.9]);
    table.rod(wood, Vec3::new(-0.6, 0.36, 0.0), Vec3::new(-0.6, 0.40, 0.0), 0.48, 48);
    table.tube(wood, Vec3::new(-0.6, 0.01, 0.0), Vec3::new(-0.6, 0.36, 0.0), [0.22, 0.05], 32);
    let jug = [(0.0, 0.0), (0.07, 0.0), (0.11, 0.08), (0.10, 0.18), (0.06, 0.25), (0.075, 0.30), (0.0, 0.28)];
    table.lathe(glaze, Vec3::new(-0.68, 0.40, -0.06), &jug.map(Vec2::from), 40);
    table.ball(cushion, Vec3::new(-0.42, 0.46, 0.12), 0.06, 4);
    stage.add(table);
}

fn add_floor_lamp(stage: &mut Stage) {
    let steel = stage.material(metal("steel", [0.62, 0.61, 0.60], 0.3));
    let mut paper = plastic("paper", [0.80, 0.74, 0.62], 1.0);
    paper.double_sided = true;
    let paper = stage.material(paper);
    let foot = Vec3::new(-2.35, 0.0, -1.55);
    let mut lamp = Shape::new("floor lamp");
    lamp.rod(steel, foot, foot + Vec3::Y * 0.03, 0.16, 32);
    lamp.rod(steel, foot + Vec3::Y * 0.03, foot + Vec3::Y * 1.5, 0.014, 12);
    lamp.tube(paper, foot + Vec3::Y * 1.42, foot + Vec3::Y * 1.72, [0.22, 0.15], 40);
    stage.add(lamp);
    stage.point("bulb", [foot.x, 1.60, foot.z], [2.6, 1.9, 1.05]);
}

fn add_picture(stage: &mut Stage) {
    let gilt = stage.material(metal("gilt", [0.95, 0.76, 0.36], 0.35));
    let canvas = stage.material(plastic("canvas", [0.58, 0.60, 0.52], 0.8));
    let ink = stage.material(plastic("ink", [0.10, 0.16, 0.32], 0.8));
    let steel = stage.material(plastic("fitting", [0.12, 0.12, 0.13], 0.5));
    let back = LOW[2];
    let mut picture = Shape::new("picture");
    picture.cuboid(gilt, [-1.35, 1.25, back + 0.001], [-0.15, 2.05, back + 0.03]);
    picture.cuboid(canvas, [-1.28, 1.32, back + 0.02], [-0.22, 1.98, back + 0.035]);
    for (x, y, radius) in [(-0.95, 1.58, 0.17), (-0.62, 1.72, 0.13), (-0.50, 1.50, 0.08)] {
        picture.disk(ink, Vec3::new(x, y, back + 0.037), Vec3::Z, radius, 40);
    }
    picture.rod(steel, Vec3::new(-0.75, 2.68, -1.25), Vec3::new(-0.75, 2.60, -1.30), 0.05, 24);
    stage.add(picture);
    stage.spot("picture light", [-0.75, 2.56, -1.33], [-0.75, 1.62, back], [9.0, 7.6, 5.6], [14.0, 32.0]);
}
