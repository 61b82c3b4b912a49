//! A turntable at dusk: camera, objects and lights move, and after four seconds everything is where it began. Each of glTF's interpolations
//! is used, and motion is inherited through the hierarchy. For motion vectors, history and reprojection.

use crate::build::{Place, Shape, Stage, facing, glow, matte, metal, plastic};
use aquifer_scene::{Interpolation, Scene, Track};
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::TAU;

/// Length of the loop, seconds.
const LOOP: f32 = 4.0;

pub(super) fn animated() -> Scene {
    let mut stage = Stage::new("animated");
    add_room(&mut stage);
    add_turntable(&mut stage);
    add_ball(&mut stage);
    add_flag(&mut stage);
    add_lantern(&mut stage);
    add_cameras(&mut stage);
    stage.into_scene()
}

fn add_room(stage: &mut Stage) {
    let floor = stage.material(plastic("floor", [0.34, 0.33, 0.36], 0.35));
    let wall = stage.material(plastic("wall", [0.30, 0.38, 0.48], 0.9));
    let stripe = stage.material(matte("stripe", [0.62, 0.56, 0.44]));
    let lamp = stage.material(glow("lamp", [6.5, 6.2, 5.6]));
    let mut room = Shape::new("room");
    room.quad(floor, Vec3::new(-6.0, 0.0, 5.0), Vec3::X * 12.0, Vec3::NEG_Z * 8.5);
    room.quad(wall, Vec3::new(-6.0, 0.0, -3.5), Vec3::X * 12.0, Vec3::Y * 5.0);
    for i in 0..8 {
        let x = -5.6 + 1.6 * i as f32;
        room.cuboid(stripe, [x, 0.0, -3.5], [x + 0.25, 3.4, -3.42]);
    }
    room.quad(lamp, Vec3::new(-1.6, 4.2, -0.9), Vec3::X * 3.2, Vec3::Z * 1.6);
    stage.add(room);
}

/// Turns once a loop; its blocks and spheres hang from it.
fn add_turntable(stage: &mut Stage) {
    let top = stage.material(plastic("turntable", [0.58, 0.55, 0.50], 0.5));
    let red = stage.material(plastic("red", [0.60, 0.08, 0.06], 0.4));
    let gold = stage.material(metal("gold", [1.0, 0.78, 0.34], 0.25));
    let pivot = stage.pivot("turntable pivot", Place::at(0.0, 0.1, 0.0));
    let mut disk = Shape::new("turntable");
    disk.rod(top, Vec3::Y * -0.08, Vec3::ZERO, 1.7, 64);
    let disk = stage.add(disk);
    stage.hang(disk, pivot);
    for i in 0..6 {
        let out = Vec2::from_angle(TAU * i as f32 / 6.0) * 1.25;
        let mut piece = Shape::new(&format!("piece {i}"));
        if i % 2 == 0 {
            piece.block(red, [0.34, 0.5 + 0.22 * i as f32, 0.34], Place::ORIGIN.affine());
        } else {
            piece.ball(gold, Vec3::Y * 0.26, 0.26, 4);
        }
        let piece = stage.mesh(piece);
        let piece = stage.place(piece, Place::at(out.x, 0.0, out.y).turned(20.0 * i as f32));
        stage.hang(piece, pivot);
    }
    let (times, turns) = turns(8);
    stage.animate(pivot, Interpolation::Linear, &times, Track::Rotation(turns));
}

/// Key times and rotations of one full turn about +Y, in `steps` equal steps.
fn turns(steps: u32) -> (Vec<f32>, Vec<Quat>) {
    let part = |i: u32| i as f32 / steps as f32;
    ((0..=steps).map(|i| LOOP * part(i)).collect(), (0..=steps).map(|i| Quat::from_rotation_y(TAU * part(i))).collect())
}

/// Bounces twice a loop on parabolas, which cubic splines hold exactly, and flattens as it lands.
fn add_ball(stage: &mut Stage) {
    let rubber = stage.material(plastic("rubber", [0.08, 0.30, 0.46], 0.45));
    let mut ball = Shape::new("ball");
    ball.ball(rubber, Vec3::Y * 0.38, 0.38, 4);
    let ball = stage.mesh(ball);
    let low = Vec3::new(0.0, 0.1, 0.0);
    let ball = stage.place(ball, Place::at(low.x, low.y, low.z));
    let bounce = LOOP / 2.0;
    let speed = Vec3::Y * 4.0 * 1.15 / bounce;
    let mut keys = Vec::new();
    for height in [0.0, 1.15, 0.0, 1.15, 0.0] {
        let tangents = if height > 0.0 { [Vec3::ZERO; 2] } else { [-speed, speed] };
        keys.extend([tangents[0], low + Vec3::Y * height, tangents[1]]);
    }
    let times = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| part * LOOP);
    stage.animate(ball, Interpolation::CubicSpline, &times, Track::Translation(keys));
    let flat = Vec3::new(1.18, 0.72, 1.18);
    let times = [0.0, 0.04, 0.46, 0.5, 0.54, 0.96, 1.0].map(|part| part * LOOP);
    let sizes = vec![flat, Vec3::ONE, Vec3::ONE, flat, Vec3::ONE, Vec3::ONE, flat];
    stage.animate(ball, Interpolation::Linear, &times, Track::Scale(sizes));
}

/// A signal that jumps from place to place: what was hidden appears at once.
fn add_flag(stage: &mut Stage) {
    let enamel = stage.material(plastic("enamel", [0.72, 0.70, 0.10], 0.3));
    let mut flag = Shape::new("flag");
    flag.rod(enamel, Vec3::ZERO, Vec3::Y * 1.5, 0.03, 16);
    flag.cuboid(enamel, [0.03, 1.05, -0.01], [0.58, 1.48, 0.01]);
    let flag = stage.mesh(flag);
    let places = [(-2.9, -1.6), (-2.3, -0.6), (2.2, -1.9), (2.7, -0.7), (-2.9, -1.6)].map(|(x, z)| Vec3::new(x, 0.0, z));
    let flag = stage.place(flag, Place::at(places[0].x, 0.0, places[0].z));
    let times = [0.0, 1.0, 2.0, 3.0, 4.0].map(|second| second * LOOP / 4.0);
    stage.animate(flag, Interpolation::Step, &times, Track::Translation(places.to_vec()));
}

/// An emissive sphere and a point light on two arms that turn the other way.
fn add_lantern(stage: &mut Stage) {
    let warm = stage.material(glow("lantern", [34.0, 18.0, 7.0]));
    let axle = stage.pivot("axle", Place::at(0.0, 1.7, 0.0));
    let mut lantern = Shape::new("lantern");
    lantern.ball(warm, Vec3::new(2.3, 0.0, 0.0), 0.15, 3);
    let lantern = stage.add(lantern);
    stage.hang(lantern, axle);
    let point = stage.point("spark", [-2.3, 0.3, 0.0], [0.6, 1.4, 2.8]);
    stage.hang(point, axle);
    let (times, mut back) = turns(6);
    back.reverse();
    stage.animate(axle, Interpolation::Linear, &times, Track::Rotation(back));
}

fn add_cameras(stage: &mut Stage) {
    let target = Vec3::new(0.0, 0.75, -0.2);
    let eye = |part: f32| {
        let (sin, cos) = (TAU * part).sin_cos();
        Vec3::new(0.9 * sin, 1.95 + 0.25 * cos, 5.6)
    };
    let main = stage.camera("main", eye(0.0).to_array(), target.to_array(), 36.0);
    let steps = 16;
    let part = |i: u32| i as f32 / steps as f32;
    let times: Vec<f32> = (0..=steps).map(|i| LOOP * part(i)).collect();
    let eyes = (0..=steps).map(|i| eye(part(i))).collect();
    let looks = (0..=steps).map(|i| facing(target - eye(part(i)))).collect();
    stage.animate(main, Interpolation::Linear, &times, Track::Translation(eyes));
    stage.animate(main, Interpolation::Linear, &times, Track::Rotation(looks));
    stage.camera("still", [2.9, 2.6, 4.3], [0.0, 0.6, -0.2], 38.0);
}
