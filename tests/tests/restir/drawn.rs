//! What a domain's ray met, its test of visibility finds: also far from where numbers are small. Where it does not, every target that holds visibility
//! takes the sample for one that the pixel could not have drawn, and it is reused by none.

use aquifer_scene::{Lens, Material, Mesh, Node, Scene};
use aquifer_tests::{Parts, context};
use glam::{EulerRot, Quat, Vec3, Vec4};
use std::sync::Arc;

/// A small board over a ground whose corners are a kilometre away and lie along no axis of their mesh: places on it are rounded by what the ground's
/// corners are, off its plane too, and seen from a board whose own corners are small.
fn board_over_wide_ground() -> Arc<Scene> {
    let matte = Material { base_color: Vec4::new(0.5, 0.5, 0.5, 1.0), metallic: 0.0, specular: 0.0, ..Material::default() };
    let lamp = Material { emission: Vec3::splat(4.0), ..matte.clone() };
    let square = |material: u32, corners: Quat, side: f32| {
        let corner = |x: f32, z: f32| corners * Vec3::new(0.5 * side * x, 0.0, 0.5 * side * z);
        let positions = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
        Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], materials: vec![material; 2], ..Mesh::default() }
    };
    let tilt = Quat::from_euler(EulerRot::YXZ, 0.7, 0.3, -0.2);
    let place = |mesh: u32, translation: Vec3, rotation: Quat| Node {
        mesh: Some(mesh),
        translation,
        rotation,
        scale: Vec3::ONE,
        ..Node::default()
    };
    let upright = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let eye = Node { camera: Some(0), translation: Vec3::Z * 1.5, scale: Vec3::ONE, ..Node::default() };
    let scene = Scene {
        meshes: vec![square(0, tilt, 2000.0), square(0, Quat::IDENTITY, 1.2), square(1, Quat::IDENTITY, 6.0)],
        materials: vec![matte, lamp],
        nodes: vec![
            place(0, tilt * (Vec3::NEG_Y * 1.1), Quat::IDENTITY),
            place(1, Vec3::ZERO, upright),
            place(2, Vec3::Y * 30.0, Quat::from_rotation_x(std::f32::consts::PI)),
            eye,
        ],
        cameras: vec![Lens { name: "main".into(), vertical_fov: 0.6, aspect: None, near: 1e-3 }],
        ..Scene::default()
    };
    Arc::new(scene.finish().expect("a scene written by hand is valid"))
}

#[test]
fn what_is_drawn_is_seen() {
    let Some(context) = context() else { return };
    let wide = board_over_wide_ground();
    for scene in [&wide, &aquifer_tests::scene("cornell")] {
        for domain in ["gi", "gi_path"] {
            let graph = format!(
                "transport = 'indirect:2'\noutput = 'drawn.counts'\nslots = {{ domain = '{domain}' }}
                [pass.gbuffer_traced]\n[pass.drawn]\nin.surface = 'gbuffer_traced.surface'"
            );
            let parts = Parts { shaders: &[("pass/drawn", include_str!("drawn.wgsl"))], ..Parts::new(scene, &graph) };
            let mut renderer = parts.renderer(&context);
            renderer.frame().unwrap();
            let counts = renderer.read_f32("drawn.counts").unwrap();
            let sum = |which: usize| counts.iter().skip(which).step_by(2).map(|count| f64::from(*count)).sum::<f64>();
            let [drawn, seen] = [0, 1].map(sum);
            eprintln!("{domain}: {seen} of {drawn}");
            assert!(drawn > 5_000.0, "{domain}: only {drawn} were drawn");
            assert!(seen >= 0.999 * drawn, "{domain}: of {drawn} samples that were drawn {seen} are seen");
        }
    }
}
