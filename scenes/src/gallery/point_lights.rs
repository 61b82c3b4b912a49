//! An amphitheatre at night with 2,000 point lights on its steps, their intensity spread over three decades: no light has a surface, so
//! light must be found by sampling the lights. Each hangs well above its step, which bounds how bright a single sample can be.

use crate::build::{Place, Random, Shape, Stage, plastic};
use aquifer_scene::Scene;
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

const LIGHTS: usize = 2_000;
const STEPS: usize = 12;
const STAGE_RADIUS: f32 = 5.0;
const TREAD: f32 = 1.1;
const RISER: f32 = 0.45;

pub(super) fn point_lights() -> Scene {
    let mut stage = Stage::new("point_lights");
    add_theatre(&mut stage);
    add_columns(&mut stage);
    add_lights(&mut stage);
    stage.camera("main", [0.0, 7.4, 17.0], [0.0, 0.6, -3.0], 42.0);
    stage.camera("stage", [-2.5, 1.6, 3.5], [1.0, 1.9, -9.0], 50.0);
    stage.into_scene()
}

fn inner_radius(step: usize) -> f32 {
    STAGE_RADIUS + TREAD * step as f32
}

fn height(step: usize) -> f32 {
    RISER * step as f32
}

fn add_theatre(stage: &mut Stage) {
    let marble = stage.material(plastic("marble", [0.62, 0.58, 0.52], 0.35));
    let stone = stage.material(plastic("stone", [0.42, 0.40, 0.38], 0.8));
    let ground = stage.material(plastic("ground", [0.10, 0.12, 0.08], 1.0));
    let mut theatre = Shape::new("theatre");
    theatre.disk(marble, Vec3::ZERO, Vec3::Y, STAGE_RADIUS, 96);
    for step in 0..STEPS {
        let (inner, low, high) = (inner_radius(step), height(step), height(step + 1));
        theatre.lathe(stone, Vec3::ZERO, &[Vec2::new(inner, high), Vec2::new(inner, low)], 96);
        theatre.lathe(stone, Vec3::ZERO, &[Vec2::new(inner + TREAD, high), Vec2::new(inner, high)], 96);
    }
    let rim = inner_radius(STEPS);
    theatre.lathe(ground, Vec3::ZERO, &[Vec2::new(rim + 20.0, height(STEPS)), Vec2::new(rim, height(STEPS))], 96);
    stage.add(theatre);
}

fn add_columns(stage: &mut Stage) {
    let white = stage.material(plastic("column", [0.66, 0.64, 0.60], 0.5));
    let mut column = Shape::new("column");
    let profile = [(0.34, 0.0), (0.34, 0.15), (0.25, 0.22), (0.22, 1.6), (0.20, 3.0), (0.30, 3.15), (0.32, 3.3), (0.0, 3.3)];
    column.lathe(white, Vec3::ZERO, &profile.map(Vec2::from), 24);
    let column = stage.mesh(column);
    for i in 0..12 {
        let out = Vec2::from_angle(TAU * (i as f32 + 0.5) / 12.0) * (STAGE_RADIUS - 0.8);
        stage.place(column, Place::at(out.x, 0.0, out.y));
    }
}

fn add_lights(stage: &mut Stage) {
    let mut random = Random::new(7);
    let warm = Vec3::new(1.0, 0.52, 0.20);
    let cool = Vec3::new(0.25, 0.50, 1.0);
    for i in 0..LIGHTS {
        let step = random.index(STEPS);
        let radius = inner_radius(step) + random.range(0.35, 0.75) * TREAD;
        let angle = random.range(0.0, TAU);
        let place = Vec2::from_angle(angle) * radius;
        let above = height(step + 1) + random.range(0.18, 0.32);
        let blend = (0.5 + 0.5 * (2.0 * angle).sin()) * (step as f32 / STEPS as f32);
        let color = warm.lerp(cool, blend);
        let intensity = color * random.decades(0.002_5, 2.5);
        stage.point(&format!("light {i}"), [place.x, above, place.y], intensity.to_array());
    }
}
