//! Built-in scenes, set in motion.

use aquifer_scene::{Channel, Interpolation, Scene, Track};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Metres a second, of all that moves.
const PACE: f32 = 0.5;

/// A built-in scene whose cameras glide, unless `motion` is "still"; with "all moves" lamps and every other mesh too, and the sun turns.
///
/// # Panics
/// When there is no such scene.
pub fn gliding(name: &str, motion: &str) -> Arc<Scene> {
    let mut scene = (aquifer_scenes::by_name(name).expect("a built-in scene").make)();
    for node in 0..scene.nodes.len() {
        let it = &scene.nodes[node];
        let emits =
            it.mesh.is_some_and(|mesh| scene.meshes[mesh as usize].materials.iter().any(|&id| scene.materials[id as usize].emits()));
        let thing = it.light.is_some() || emits || (it.mesh.is_some() && node % 2 == 1);
        if motion == "still" || !(it.camera.is_some() || (motion == "all moves" && thing)) {
            continue;
        }
        let way = Quat::from_rotation_y(node as f32) * Vec3::X * PACE;
        let (place, turn) = (it.translation, it.rotation);
        let tracks = [
            Some(Track::Translation(vec![place, place + way])),
            it.light.map(|_| Track::Rotation(vec![turn, Quat::from_rotation_y(0.2) * turn])),
        ];
        let channel = |track| Channel { node: node as u32, track, times: vec![0.0, 1.0], interpolation: Interpolation::Linear };
        scene.animation.extend(tracks.into_iter().flatten().map(channel));
    }
    Arc::new(scene.finish().unwrap_or_else(|error| panic!("{name}: {error}")))
}
