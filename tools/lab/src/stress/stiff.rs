//! Scenes that change at once: what history remembers is worth little, or nothing. A second passes from frame to frame.

use super::{Case, Known, Looks};
use aquifer_scene::{Interpolation, Scene, Track};
use aquifer_scenes::build::{Place, Shape, Stage, facing, glow, matte};
use glam::Vec3;

/// The frame of the change.
const CHANGE: u32 = 8;
/// The change, and what comes after it.
const AFTER: Looks = Looks::After(&[CHANGE, CHANGE + 1, CHANGE + 2, CHANGE + 4, CHANGE + 8, CHANGE + 16]);

const COUNTED_FOR_NOTHING: &str =
    "weights 1/M count a history whose lamp has gone out, though its sample is worth nothing: nine tenths of the light are lost";

/// Every case that moves.
pub(super) const CASES: &[Case] = &[
    Case {
        looks: Looks::After(&[7, 8, 9]),
        known: &[Known { graph: "restir_di", why: COUNTED_FOR_NOTHING }, Known { graph: "restir_di_regir", why: COUNTED_FOR_NOTHING }],
        ..Case::still("blinking_lamps", "one lamp is on in even frames, the other in odd ones", blinking_lamps)
    },
    Case { looks: AFTER, ..Case::still("jumping_lamp", "the lamp crosses the room from one frame to the next", jumping_lamp) },
    Case { looks: Looks::After(&[8, 31, 63]), ..Case::still("sweeping_lamp", "the lamp sweeps through the room, slowly", sweeping_lamp) },
    Case { looks: AFTER, ..Case::still("camera_cut", "the camera is somewhere else from one frame to the next", camera_cut) },
    Case { looks: AFTER, ..Case::still("flashing_block", "a block stands there for one frame", flashing_block) },
];

/// A room of side 2, open to the camera, with a block.
fn room(name: &str) -> Stage {
    let mut stage = Stage::new(name);
    let white = stage.material(matte("white", [0.6; 3]));
    let red = stage.material(matte("red", [0.6, 0.2, 0.2]));
    let mut room = Shape::new("room");
    room.room([Some(red), Some(white), Some(white), Some(white), Some(white), None], [-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]);
    room.block(white, [0.5, 0.7, 0.5], Place::at(0.3, 0.0, -0.2).turned(20.0).affine());
    stage.add(room);
    stage
}

fn camera(stage: &mut Stage) -> u32 {
    stage.camera("main", [0.0, 1.0, 4.0], [0.0, 1.0, 0.0], 35.0)
}

/// A square lamp of side 0.4 that faces down, at a place of its own.
fn lamp(stage: &mut Stage, place: Vec3) -> u32 {
    let material = stage.material(glow("lamp", [12.0; 3]));
    let mut shape = Shape::new("lamp");
    shape.quad(material, Vec3::new(-0.2, 0.0, -0.2), Vec3::X * 0.4, Vec3::Z * 0.4);
    let mesh = stage.mesh(shape);
    stage.place(mesh, Place::at(place.x, place.y, place.z))
}

fn blinking_lamps() -> Scene {
    let mut stage = room("blinking_lamps");
    let lamps = [-0.6, 0.6].map(|x| lamp(&mut stage, Vec3::new(x, 1.9, 0.0)));
    camera(&mut stage);
    let times: Vec<f32> = (0..32).map(|second| second as f32).collect();
    for (lamp, on) in lamps.into_iter().zip(0..) {
        let scales = (0..32).map(|second| if second % 2 == on { Vec3::ONE } else { Vec3::ZERO }).collect();
        stage.animate(lamp, Interpolation::Step, &times, Track::Scale(scales));
    }
    stage.into_scene()
}

fn jumping_lamp() -> Scene {
    let (left, right) = (Vec3::new(-0.7, 1.9, 0.3), Vec3::new(0.7, 1.2, -0.5));
    let mut stage = room("jumping_lamp");
    let lamp = lamp(&mut stage, left);
    camera(&mut stage);
    stage.animate(lamp, Interpolation::Step, &[0.0, CHANGE as f32], Track::Translation(vec![left, right]));
    stage.into_scene()
}

fn sweeping_lamp() -> Scene {
    let (left, right) = (Vec3::new(-0.7, 1.9, 0.3), Vec3::new(0.7, 1.6, -0.5));
    let mut stage = room("sweeping_lamp");
    let lamp = lamp(&mut stage, left);
    camera(&mut stage);
    stage.animate(lamp, Interpolation::Linear, &[0.0, 600.0], Track::Translation(vec![left, right]));
    stage.into_scene()
}

fn camera_cut() -> Scene {
    let mut stage = room("camera_cut");
    lamp(&mut stage, Vec3::new(-0.4, 1.9, 0.0));
    let camera = camera(&mut stage);
    let (eyes, target) = ([Vec3::new(0.0, 1.0, 4.0), Vec3::new(0.8, 1.7, 0.9)], Vec3::new(-0.2, 0.6, -0.4));
    let times = [0.0, CHANGE as f32];
    let looks = vec![facing(Vec3::NEG_Z), facing(target - eyes[1])];
    stage.animate(camera, Interpolation::Step, &times, Track::Translation(eyes.to_vec()));
    stage.animate(camera, Interpolation::Step, &times, Track::Rotation(looks));
    stage.into_scene()
}

fn flashing_block() -> Scene {
    let mut stage = room("flashing_block");
    lamp(&mut stage, Vec3::new(-0.4, 1.9, 0.0));
    let white = stage.material(matte("flash", [0.3, 0.5, 0.7]));
    let mut block = Shape::new("flash");
    block.block(white, [0.6, 1.0, 0.3], Place::ORIGIN.affine());
    let mesh = stage.mesh(block);
    let block = stage.place(mesh, Place::at(-0.4, 0.0, 0.5));
    camera(&mut stage);
    let times = [0.0, CHANGE as f32, CHANGE as f32 + 1.0];
    stage.animate(block, Interpolation::Step, &times, Track::Scale(vec![Vec3::ZERO, Vec3::ONE, Vec3::ZERO]));
    stage.into_scene()
}
