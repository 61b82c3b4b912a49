//! What ReSTIR costs: time, rays and bytes of every pass. Run it with the machine to itself.
//!
//! ```text
//! cargo run -p aquifer-tests --example restir_cost -- di|gi FILE COMMIT DATE
//! ```
//!
//! `di`: from ten lights to a hundred thousand. One mesh of 100,352 triangles hangs over a floor with blocks; so many of its triangles shine, with the
//! same power together. `gi`: one bounce, and two.

use aquifer_render::Context;
use aquifer_scene::{Lens, Material, Mesh, Node, Scene};
use aquifer_tests::{Parts, context, cost::costs, evidence::Evidence, scene};
use glam::{Quat, Vec3, Vec4};
use serde_json::json;
use std::{f32::consts::PI, sync::Arc};

/// Squares along a side of the mesh.
const SIDE: u32 = 224;
const LIGHTS: [usize; 5] = [10, 100, 1000, 10_000, 100_000];
const DIRECT: [&str; 3] = ["light_sampling", "restir_di", "restir_di_unbiased"];
const INDIRECT: [&str; 6] =
    ["path_tracer_indirect", "restir_gi", "restir_gi_validated", "restir_gi_tuned", "restir_gi_unbiased", "restir_full"];
const SCENES: [&str; 2] = ["cornell", "door_ajar"];
const SIZE: [u32; 2] = [256, 144];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [subject, file, commit, date] = &arguments[..] else {
        eprintln!("restir_cost di|gi FILE COMMIT DATE");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let evidence = Evidence::open(file, commit, date, &context);
    match subject.as_str() {
        "di" => direct(&context, evidence),
        "gi" => indirect(&context, evidence),
        other => panic!("`{other}` is neither di nor gi"),
    }
}

fn direct(context: &Context, mut evidence: Evidence) {
    for lights in LIGHTS {
        let scene = under_lights(lights);
        for graph in DIRECT {
            let text = format!("extends = '{graph}.toml'");
            let found = costs(context, &Parts { size: SIZE, ..Parts::new(&scene, &text) });
            eprintln!("{graph}, {lights} lights: {found}");
            evidence.put(json!({ "graph": graph, "lights": lights }), found);
        }
    }
}

fn indirect(context: &Context, mut evidence: Evidence) {
    for name in SCENES {
        let scene = scene(name);
        for graph in INDIRECT {
            for bounces in [1, 2] {
                let transport = if graph == "restir_full" { format!("full:{bounces}") } else { format!("indirect:{bounces}") };
                let text = format!("extends = '{graph}.toml'\ntransport = '{transport}'");
                let found = costs(context, &Parts { size: SIZE, ..Parts::new(&scene, &text) });
                eprintln!("{name}, {graph}, {transport}: {found}");
                evidence.put(json!({ "scene": name, "graph": graph, "transport": transport }), found);
            }
        }
    }
}

/// The mesh, a floor with blocks under it, and a camera that sees the floor.
fn under_lights(lights: usize) -> Arc<Scene> {
    let matte = Material { base_color: Vec4::new(0.5, 0.5, 0.5, 1.0), metallic: 0.0, specular: 0.0, ..Material::default() };
    let glow = Material { emission: Vec3::splat(20_000.0 / lights as f32), ..matte.clone() };
    let mut ceiling = grid(SIDE, 0);
    let count = ceiling.triangles.len();
    for light in 0..lights {
        // Triangles far from each other, by a step that shares no factor with their number.
        ceiling.materials[light * 61_803 % count] = 1;
    }
    let at = |mesh, translation, scale, turn: f32| Node {
        mesh: Some(mesh),
        translation,
        scale,
        rotation: Quat::from_rotation_x(turn),
        ..Node::default()
    };
    let mut nodes = vec![at(0, Vec3::Y * 3.0, Vec3::splat(6.0), PI), at(1, Vec3::ZERO, Vec3::splat(6.0), 0.0)];
    for i in 0..6 {
        let place = Vec3::new((i % 3) as f32 * 1.6 - 1.6, 0.6, (i / 3) as f32 * 1.8 - 1.2);
        nodes.push(at(1, place, Vec3::splat(0.7), 0.0));
    }
    nodes.push(Node {
        camera: Some(0),
        translation: Vec3::new(0.0, 2.2, 4.2),
        rotation: Quat::from_rotation_x(-0.5),
        scale: Vec3::ONE,
        ..Node::default()
    });
    let cameras = vec![Lens { name: "main".into(), vertical_fov: 0.9, aspect: None, near: 1e-3 }];
    let scene = Scene { meshes: vec![ceiling, grid(1, 0)], materials: vec![matte, glow], nodes, cameras, ..Scene::default() };
    Arc::new(scene.finish().expect("a scene written by hand is valid"))
}

/// A unit square around the origin, facing +Y, cut into `side`² squares.
fn grid(side: u32, material: u32) -> Mesh {
    let corner = |i: u32| Vec3::new((i % (side + 1)) as f32, 0.0, (i / (side + 1)) as f32) / side as f32 - Vec3::new(0.5, 0.0, 0.5);
    let positions = (0..(side + 1) * (side + 1)).map(corner).collect();
    let square = |i: u32| {
        let a = i % side + i / side * (side + 1);
        let (b, c, d) = (a + 1, a + side + 1, a + side + 2);
        [[a, c, d], [a, d, b]]
    };
    let triangles: Vec<[u32; 3]> = (0..side * side).flat_map(square).collect();
    Mesh { positions, materials: vec![material; triangles.len()], triangles, ..Mesh::default() }
}
