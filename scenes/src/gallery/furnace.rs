//! The white furnace: a sphere of a given material inside an enclosure that emits the same radiance everywhere. A surface that reflects all
//! light vanishes against it; one that makes energy shines; the radiance missing is what the surface absorbs. For tests.

use crate::build::{Shape, Stage, glow};
use aquifer_scene::{Material, Scene};
use glam::Vec3;

/// Radiance of the enclosure, the same in all channels, W·m⁻²·sr⁻¹.
pub const RADIANCE: f32 = 0.5;

/// A unit sphere of `material` in the middle of an emitting box of half side 4 m, seen from 3 m away. The enclosure reflects nothing.
pub fn furnace_of(material: Material) -> Scene {
    let mut stage = Stage::new("furnace");
    let subject = stage.material(material);
    let walls = stage.material(glow("enclosure", [RADIANCE; 3]));
    let mut sphere = Shape::new("sphere");
    sphere.ball(subject, Vec3::ZERO, 1.0, 5);
    stage.add(sphere);
    let mut enclosure = Shape::new("enclosure");
    enclosure.room([Some(walls); 6], [-4.0; 3], [4.0; 3]);
    stage.add(enclosure);
    stage.camera("main", [0.0, 0.0, 3.0], [0.0; 3], 44.0);
    stage.into_scene()
}

pub(super) fn furnace() -> Scene {
    furnace_of(crate::build::matte("white", [1.0; 3]))
}
