//! Lights that go out and come up between two frames: what history remembers of them is worth nothing, but was still tried.

use crate::{
    direct::{Changes, FRAME, coarse, compare},
    toy::{module, replaced},
};
use aquifer_lab::stats::Verdict;
use aquifer_render::View;
use aquifer_scene::{Channel, Interpolation, Lens, Material, Mesh, Node, Scene, Track};
use aquifer_tests::{Parts, context};
use glam::{Quat, Vec3, Vec4};
use std::{f32::consts::FRAC_PI_2, sync::Arc};

/// 32 bits of a reservoir: light, u, v, weight, confidence.
const RESERVOIR: usize = 5;

/// A square of side 1 around the origin, facing +Y.
fn square(material: u32) -> Mesh {
    let corner = |x: f32, z: f32| Vec3::new(x - 0.5, 0.0, z - 0.5);
    let positions = vec![corner(0.0, 0.0), corner(0.0, 1.0), corner(1.0, 1.0), corner(1.0, 0.0)];
    Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], materials: vec![material; 2], ..Mesh::default() }
}

/// A floor under three lamps: one burns always, one goes out and one comes up at the frame that is compared. A second is a frame.
fn lamps() -> Arc<Scene> {
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
        times: vec![0.0, FRAME as f32],
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

fn by_the_frame() -> View {
    View { step: 1.0, ..View::default() }
}

#[test]
fn lights_that_go_out_and_come_up_are_counted_right() {
    let Some(context) = context() else { return };
    let found = compare(&context, &lamps(), &Changes { view: by_the_frame(), rule: "pairwise", shaders: &[] }, &coarse(), 192);
    assert_eq!(found.verdict, Verdict::Passed, "{found}");
}

#[test]
fn remembering_a_light_that_went_out_is_found() {
    let Some(context) = context() else { return };
    let text = replaced(module("lights/scene"), "select(0.0, 0.5 * length(n), is_solid(instance))", "0.5 * length(n)");
    let shaders = [("lights/scene", text.as_str())];
    let found = compare(&context, &lamps(), &Changes { view: by_the_frame(), rule: "pairwise", shaders: &shaders }, &coarse(), 64);
    assert_eq!(found.verdict, Verdict::Failed, "{found}");
}

#[test]
fn confidence_counts_what_went_out_and_stops_at_the_cap() {
    let Some(context) = context() else { return };
    let scene = lamps();
    let settings = ["temporal.cap=6.0", "spatial.taps=3", "spatial.radius=4.0", "spatial.rows=0.0"];
    let keep = ["temporal.reservoir", "spatial.reservoir"];
    let graph = "extends = 'restir_di_unbiased.toml'";
    let mut renderer = Parts { settings: &settings, keep: &keep, view: by_the_frame(), ..Parts::new(&scene, graph) }.renderer(&context);
    (0..=FRAME).for_each(|_| renderer.frame().unwrap());
    let mut confidences = |port: &str| -> Vec<f32> {
        renderer.read_f32(port).unwrap().chunks_exact(RESERVOIR).map(|reservoir| reservoir[RESERVOIR - 1]).collect()
    };
    // Eight frames of up to four pixels each are far beyond the cap: one for the new reservoir, six for the old, whatever it held. Where the lamp that
    // went out stood, and along edges, there is less history.
    let temporal = confidences("temporal.reservoir");
    let full = temporal.iter().filter(|confidence| **confidence == 7.0).count();
    assert!(temporal.iter().all(|confidence| (1.0..=7.0).contains(confidence)) && 10 * full > 8 * temporal.len(), "{full} are full");
    let joined = confidences("spatial.reservoir");
    assert!(joined.iter().all(|confidence| (1.0..=28.0).contains(confidence)) && joined.contains(&28.0));
}
