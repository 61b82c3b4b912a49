//! Four plates of growing roughness under four spheres of light of growing size and equal power (after Veach & Guibas 1995, fig. 2):
//! sampling lights fails at one corner, sampling the BSDF at the opposite one. Roughness stays above 0.1.

use crate::build::{Place, Shape, Stage, glow, metal, plastic};
use aquifer_scene::Scene;
use glam::{Quat, Vec3};

/// Roughness, height, depth and tilt (degrees, towards the camera) of each plate, farthest first.
const PLATES: [(f32, f32, f32, f32); 4] =
    [(0.12, 1.72, -2.6, 38.0), (0.20, 1.10, -1.75, 28.0), (0.32, 0.62, -0.8, 19.0), (0.50, 0.28, 0.25, 11.0)];
/// Radius (metres) and hue of each light, left to right.
const LIGHTS: [(f32, [f32; 3]); 4] =
    [(0.035, [1.0, 0.86, 0.66]), (0.10, [1.0, 0.62, 0.42]), (0.26, [0.60, 1.0, 0.72]), (0.55, [0.56, 0.72, 1.0])];
/// Radiance × radius², the same for all lights.
const POWER: f32 = 1.4;

pub(super) fn veach_mis() -> Scene {
    let mut stage = Stage::new("veach_mis");
    let wall = stage.material(plastic("wall", [0.34, 0.34, 0.36], 1.0));
    let mut room = Shape::new("room");
    room.quad(wall, Vec3::new(-9.0, 0.0, 6.0), Vec3::X * 18.0, Vec3::NEG_Z * 10.0);
    room.quad(wall, Vec3::new(-9.0, 0.0, -4.0), Vec3::X * 18.0, Vec3::Y * 9.0);
    stage.add(room);

    for (roughness, y, z, tilt) in PLATES {
        let steel = stage.material(metal(&format!("plate {roughness}"), [0.42, 0.42, 0.44], roughness));
        let mut plate = Shape::new(&format!("plate {roughness}"));
        plate.block(steel, [5.2, 0.05, 1.05], glam::Affine3A::IDENTITY);
        let plate = stage.mesh(plate);
        stage.place(plate, Place::at(0.0, y, z).rotated(Quat::from_rotation_x(tilt.to_radians())));
    }
    for (i, (radius, hue)) in LIGHTS.into_iter().enumerate() {
        let radiance = POWER / (radius * radius);
        let light = stage.material(glow(&format!("light {i}"), hue.map(|channel| channel * radiance)));
        let mut sphere = Shape::new(&format!("light {i}"));
        sphere.ball(light, Vec3::new(1.35 * (i as f32 - 1.5), 3.6, -2.9), radius, 3);
        stage.add(sphere);
    }
    stage.camera("main", [0.0, 2.3, 6.4], [0.0, 1.85, -1.2], 33.0);
    stage.into_scene()
}
