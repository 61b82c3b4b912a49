//! A scene whose lamps go out and come up.

use aquifer_scene::{Channel, Interpolation, Lens, Material, Mesh, Node, Scene, Track};
use glam::{Quat, Vec3, Vec4};
use std::{f32::consts::FRAC_PI_2, sync::Arc};

/// A square of side 1 around the origin, facing +Y.
fn square(material: u32) -> Mesh {
    let corner = |x: f32, z: f32| Vec3::new(x - 0.5, 0.0, z - 0.5);
    let positions = vec![corner(0.0, 0.0), corner(0.0, 1.0), corner(1.0, 1.0), corner(1.0, 0.0)];
    Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], materials: vec![material; 2], ..Mesh::default() }
}

/// A floor under three lamps: one burns always, one goes out and one comes up after so many seconds.
///
/// # Panics
/// Never: it is written by hand.
pub fn lamps(when: f32) -> Arc<Scene> {
    let matte = Material { base_color: Vec4::new(0.5, 0.5, 0.5, 1.0), metallic: 0.0, specular: 0.0, ..Material::default() };
    let lamp = |strength: f32| Material { emission: Vec3::splat(strength), ..matte.clone() };
    let hung = |x: f32, mesh: u32| Node {
        mesh: Some(mesh),
        translation: Vec3::new(x, 1.0, 0.0),
        rotation: Quat::from_rotation_x(2.0 * FRAC_PI_2),
        scale: Vec3::splat(0.4),
        ..Node::default()
    };
    let floor = Node { mesh: Some(0), scale: Vec3::splat(6.0), ..Node::default() };
    let eye = Node {
        camera: Some(0),
        translation: Vec3::Y * 2.5,
        rotation: Quat::from_rotation_x(-FRAC_PI_2),
        scale: Vec3::ONE,
        ..Node::default()
    };
    let switched = |node: u32, before: f32, after: f32| Channel {
        node,
        // Flat, as a lamp that lies on its plane would be: it keeps its area and loses its inverse.
        track: Track::Scale(vec![Vec3::new(0.4, before, 0.4), Vec3::new(0.4, after, 0.4)]),
        times: vec![0.0, when],
        interpolation: Interpolation::Step,
    };
    let scene = Scene {
        meshes: vec![square(0), square(1), square(2)],
        materials: vec![matte.clone(), lamp(4.0), lamp(12.0)],
        nodes: vec![floor, hung(0.0, 1), hung(-0.9, 2), hung(0.9, 2), eye],
        cameras: vec![Lens { name: "main".into(), vertical_fov: 1.0, aspect: None, near: 1e-3 }],
        animation: vec![switched(2, 0.4, 0.0), switched(3, 0.0, 0.4)],
        ..Scene::default()
    };
    Arc::new(scene.finish().expect("a scene written by hand is valid"))
}
