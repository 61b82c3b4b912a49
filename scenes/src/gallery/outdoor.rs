//! A valley, 400 m across: a lake, a cabin, 1,600 instanced trees and 260 rocks under a painted sky whose sun is a bright, narrow lobe of
//! the environment map. There is no other light: the map has to be importance sampled.

use crate::build::{Noise, Place, Random, Shape, Sky, Stage, height_field, plastic, sky};
use aquifer_scene::Scene;
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::TAU;

const SIDE: f32 = 400.0;
const TREES: usize = 1_600;
const ROCKS: usize = 260;
/// Height of the lake's surface, metres.
const WATER: f32 = 0.0;
const LAKE: Vec2 = Vec2::new(3.0, 3.0);
const CABIN: Vec2 = Vec2::new(-13.0, -18.0);

pub(super) fn outdoor() -> Scene {
    let mut stage = Stage::new("outdoor");
    let land = Land { noise: Noise::new(5) };
    add_land(&mut stage, &land);
    add_trees(&mut stage, &land);
    add_rocks(&mut stage, &land);
    add_cabin(&mut stage, &land);
    let look = Sky {
        zenith: Vec3::new(0.10, 0.22, 0.52),
        horizon: Vec3::new(0.62, 0.70, 0.78),
        ground: Vec3::new(0.08, 0.09, 0.06),
        to_sun: Vec3::new(-0.55, 0.52, 0.45).normalize(),
        sun: Vec3::new(1_500.0, 1_280.0, 960.0),
        sun_width: 1.1,
    };
    stage.environment(sky("noon", 1_024, &look));
    stage.camera("main", [8.0, 3.9, 27.0], [-5.0, 2.6, -16.0], 46.0);
    stage.camera("shore", [-20.0, 2.2, 6.0], [8.0, 3.0, -30.0], 55.0);
    stage.into_scene()
}

struct Land {
    noise: Noise,
}

impl Land {
    /// A basin for the lake, a level spot for the cabin, hills that rise towards the edge.
    fn height(&self, at: Vec2) -> f32 {
        let hills = 26.0 * (self.noise.plane(at * 0.012, 4) - 0.38);
        let rim = (at.length() / 120.0).powi(2) * 9.0;
        let from_lake = ((at - LAKE) / Vec2::new(30.0, 17.0)).length();
        let basin = -6.0 * (-from_lake * from_lake).exp();
        let wild = 1.9 + hills.max(-1.5) * (at.length() / 60.0).clamp(0.15, 1.0) + rim + basin;
        let level = (-((at - CABIN) / 8.0).length_squared()).exp();
        wild + (2.0 - wild) * level
    }

    fn foot(&self, at: Vec2) -> Vec3 {
        Vec3::new(at.x, self.height(at), at.y)
    }
}

fn add_land(stage: &mut Stage, land: &Land) {
    stage.material(plastic("ground", [1.0; 3], 0.95));
    let water = stage.material(plastic("water", [0.010, 0.030, 0.035], 0.1));
    let color = |position: Vec3, normal: Vec3| {
        let patch = land.noise.plane(Vec2::new(position.x, position.z) * 0.12, 4) - 0.5;
        let grass = Vec3::new(0.11, 0.17, 0.04) * (1.0 + 0.9 * patch);
        let soil = Vec3::new(0.22, 0.16, 0.10);
        let sand = Vec3::new(0.42, 0.36, 0.26);
        let steep = ((0.9 - normal.y) * 5.0).clamp(0.0, 1.0);
        let shore = (1.0 - (position.y - WATER - 0.25 - patch) * 1.6).clamp(0.0, 1.0);
        grass.lerp(soil, steep).lerp(sand, shore)
    };
    let mesh = stage.raw_mesh(height_field("land", SIDE, 200, |at| land.height(at), Some(&color)));
    stage.place(mesh, Place::ORIGIN);
    let mut lake = Shape::new("lake");
    lake.quad(water, Vec3::new(-40.0, WATER, 40.0), Vec3::X * 100.0, Vec3::NEG_Z * 80.0);
    stage.add(lake);
}

fn add_trees(stage: &mut Stage, land: &Land) {
    let bark = stage.material(plastic("bark", [0.13, 0.08, 0.05], 1.0));
    let mut random = Random::new(2);
    let greens = [[0.035, 0.09, 0.035], [0.05, 0.11, 0.03], [0.09, 0.14, 0.03], [0.20, 0.15, 0.03]];
    let needles = greens.map(|green| stage.material(plastic("foliage", green, 0.9)));
    let mut kinds = Vec::new();
    for (i, green) in needles.into_iter().enumerate() {
        let shape = if i < 2 { conifer(bark, green, &mut random) } else { broadleaf(bark, green, i as u32) };
        kinds.push(stage.mesh(shape));
    }
    for _ in 0..TREES {
        let at = loop {
            let at = random.in_disk() * 0.48 * SIDE;
            let grove = land.noise.plane(at * 0.035 + 50.0, 2);
            let free = land.height(at) > 0.9 && (at - CABIN).length() > 7.0 && !before_camera(at);
            if free && grove > random.range(0.25, 0.65) {
                break at;
            }
        };
        let kind = kinds[(random.index(3) + random.index(2)).min(3)];
        let foot = land.foot(at) - Vec3::Y * 0.15;
        let place = Place::at(foot.x, foot.y, foot.z).turned(random.range(0.0, 360.0)).sized(random.range(0.7, 1.35));
        stage.place(kind, place);
    }
}

/// The wedge that the main camera needs free to see the lake.
fn before_camera(at: Vec2) -> bool {
    let from = at - Vec2::new(8.0, 30.0);
    from.y < 2.0 && from.y > -34.0 && (from.x + 0.2 * -from.y).abs() < 3.0 - 0.42 * from.y
}

/// Six skirts of ragged needles round a trunk, 6 m high.
fn conifer(bark: u32, needles: u32, random: &mut Random) -> Shape {
    let mut tree = Shape::new("conifer");
    tree.tube(bark, Vec3::ZERO, Vec3::Y * 1.6, [0.17, 0.13], 8);
    for layer in 0..6 {
        let low = 0.9 + 0.85 * layer as f32;
        let radius = 1.55 - 0.23 * layer as f32;
        let tip = Vec3::Y * (low + 1.35);
        let spikes = 22;
        let turn = random.unit();
        let rim: Vec<Vec3> = (0..spikes)
            .map(|i| {
                let reach = radius * if i % 2 == 0 { random.range(0.9, 1.1) } else { random.range(0.62, 0.75) };
                let out = Vec2::from_angle(TAU * (i as f32 + turn) / spikes as f32) * reach;
                Vec3::new(out.x, low - 0.18 * reach, -out.y)
            })
            .collect();
        let inner = Vec3::Y * (low + 0.25);
        for i in 0..spikes {
            let next = (i + 1) % spikes;
            tree.facet(needles, [rim[i], rim[next], tip]);
            tree.facet(needles, [rim[next], rim[i], inner]);
        }
    }
    tree
}

/// A lumpy crown on a trunk, 6 m high.
fn broadleaf(bark: u32, leaves: u32, seed: u32) -> Shape {
    let noise = Noise::new(seed);
    let mut crown = Shape::new("crown");
    for (center, radius) in [((0.0, 3.9, 0.0), 1.7), ((0.9, 3.2, 0.4), 1.0), ((-0.8, 3.3, -0.5), 1.1), ((0.1, 5.0, -0.2), 1.1)] {
        crown.ball(leaves, center.into(), radius, 3);
    }
    crown.displace(|position, normal| normal * (noise.fractal(position * 2.6, 3) - 0.5) * 1.1);
    let mut tree = Shape::new("broadleaf");
    tree.tube(bark, Vec3::ZERO, Vec3::Y * 3.2, [0.24, 0.13], 10);
    tree.append(&crown, Place::ORIGIN.affine());
    tree
}

fn add_rocks(stage: &mut Stage, land: &Land) {
    let stone = stage.material(plastic("rock", [0.30, 0.28, 0.26], 0.85));
    let mut random = Random::new(9);
    let kinds: Vec<u32> = (0..4)
        .map(|seed| {
            let noise = Noise::new(500 + seed);
            let mut rock = Shape::new("rock");
            rock.ball(stone, Vec3::ZERO, 1.0, 4);
            rock.displace(|position, normal| normal * (0.9 * noise.fractal(position * 1.3, 4) - 0.5) - Vec3::Y * 0.3 * position.y);
            stage.mesh(rock)
        })
        .collect();
    for i in 0..ROCKS {
        let at = if i % 2 == 0 { random.in_disk() * 0.4 * SIDE } else { LAKE + random.in_disk() * Vec2::new(34.0, 20.0) };
        let foot = land.foot(at);
        let turn = Quat::from_rotation_y(random.range(0.0, TAU)) * Quat::from_rotation_x(random.range(-0.3, 0.3));
        let place = Place::at(foot.x, foot.y, foot.z).rotated(turn).sized(random.decades(0.15, 1.1));
        stage.place(kinds[random.index(kinds.len())], place);
    }
}

fn add_cabin(stage: &mut Stage, land: &Land) {
    let logs = stage.material(plastic("logs", [0.30, 0.16, 0.08], 0.8));
    let shingles = stage.material(plastic("shingles", [0.26, 0.09, 0.07], 0.8));
    let paint = stage.material(plastic("white paint", [0.75, 0.74, 0.70], 0.6));
    let glass = stage.material(plastic("panes", [0.03, 0.04, 0.05], 0.1));
    let mut cabin = Shape::new("cabin");
    cabin.cuboid(logs, [-2.6, -0.6, -1.8], [2.6, 2.3, 1.8]);
    for i in 0..9 {
        let y = 0.12 + 0.26 * i as f32;
        cabin.tube(logs, Vec3::new(-2.75, y, 1.8), Vec3::new(2.75, y, 1.8), [0.14; 2], 10);
    }
    let (eave, ridge) = (Vec3::new(0.0, 2.15, 2.4), Vec3::new(0.0, 4.0, 0.0));
    for side in [-1.0, 1.0] {
        let low = Vec3::new(-3.1 * side, eave.y, eave.z * side);
        let slope = Vec3::new(0.0, ridge.y - eave.y, -eave.z * side);
        let along = Vec3::X * 6.2 * side;
        cabin.quad(shingles, low, along, slope);
        cabin.quad(shingles, low + along - Vec3::Y * 0.12, -along, slope);
        let gable = Vec3::X * 2.6 * side;
        cabin.facet(logs, [gable + Vec3::new(0.0, 2.3, 1.8 * side), gable + Vec3::new(0.0, 2.3, -1.8 * side), gable + Vec3::Y * 3.69]);
    }
    cabin.cuboid(paint, [-0.5, 0.0, 1.9], [0.5, 2.0, 1.97]);
    cabin.cuboid(logs, [-0.4, 0.05, 1.96], [0.4, 1.9, 2.0]);
    for x in [-1.6, 1.6] {
        cabin.cuboid(paint, [x - 0.5, 0.85, 1.9], [x + 0.5, 1.75, 1.97]);
        cabin.cuboid(glass, [x - 0.42, 0.93, 1.96], [x + 0.42, 1.67, 1.985]);
    }
    let cabin = stage.mesh(cabin);
    let foot = land.foot(CABIN);
    stage.place(cabin, Place::at(foot.x, foot.y, foot.z).turned(28.0));
}
