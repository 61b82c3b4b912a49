//! What ReSTIR DI costs: time and rays of every pass, from ten lights to a hundred thousand. Run it with the machine to itself.
//!
//! ```text
//! cargo run -p aquifer-tests --example restir_di_cost -- FILE COMMIT DATE
//! ```
//!
//! One mesh of 100,352 triangles hangs over a floor with blocks; so many of its triangles shine, with the same power together. Times are medians of the
//! frames after the second; rays are counted in a run of its own, since counting takes time.

use aquifer_render::{Context, Renderer};
use aquifer_scene::{Lens, Material, Mesh, Node, Scene};
use aquifer_tests::{Parts, context};
use glam::{Quat, Vec3, Vec4};
use serde_json::{Value, json};
use std::{f32::consts::PI, sync::Arc};

/// Squares along a side of the mesh.
const SIDE: u32 = 224;
const LIGHTS: [usize; 5] = [10, 100, 1000, 10_000, 100_000];
const GRAPHS: [&str; 3] = ["light_sampling", "restir_di", "restir_di_unbiased"];
const PASSES: [&str; 4] = ["initial", "temporal", "spatial", "shade"];
const SIZE: [u32; 2] = [256, 144];
const FRAMES: u32 = 10;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, commit, date] = &arguments[..] else {
        eprintln!("restir_di_cost FILE COMMIT DATE");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut rows = Vec::new();
    for lights in LIGHTS {
        let scene = under_lights(lights);
        for graph in GRAPHS {
            let row = measure(&context, &scene, graph, lights);
            eprintln!("{row}");
            rows.push(row);
        }
    }
    let all = json!({ "commit": commit, "date": date, "adapter": context.adapter().name, "size": SIZE, "rows": rows });
    let text = serde_json::to_string_pretty(&all).expect("plain data");
    std::fs::write(file, text + "\n").unwrap_or_else(|error| panic!("{file}: {error}"));
}

fn measure(context: &Context, scene: &Arc<Scene>, graph: &str, lights: usize) -> Value {
    let text = format!("extends = '{graph}.toml'");
    let parts = Parts { size: SIZE, ..Parts::new(scene, &text) };
    let mut renderer = parts.renderer(context);
    run(&mut renderer);
    let timings = renderer.timings();
    let plan = renderer.plan();
    let bytes = plan.resources.iter().find(|resource| resource.name == "initial.reservoir").map(|resource| resource.ty.stride);
    // Rounds of a repeated pass are steps of their own.
    let nodes = |pass: &str| -> Vec<String> { plan.steps.iter().filter(|step| step.pass == pass).map(|step| step.node.clone()).collect() };
    let passes: Vec<(&str, Vec<String>)> =
        PASSES.into_iter().map(|pass| (pass, nodes(pass))).filter(|(_, nodes)| !nodes.is_empty()).collect();
    let ms = |node: &String| timings.passes.iter().find(|time| time.pass == *node).and_then(|time| time.median_ms).unwrap_or_default();
    let rays = rays(context, &parts, passes.iter().flat_map(|(_, nodes)| nodes));
    let of_pass = |(pass, nodes): &(&str, Vec<String>)| {
        let rays: f64 = nodes.iter().map(|node| rays.iter().find(|(name, _)| name == node).map_or(0.0, |(_, rays)| *rays)).sum();
        json!({ "pass": pass, "ms": rounded(nodes.iter().map(ms).sum(), 100.0), "rays a pixel": rounded(rays, 1000.0) })
    };
    let passes: Vec<Value> = passes.iter().map(of_pass).collect();
    json!({ "graph": graph, "lights": lights, "reservoir bytes": bytes, "passes": passes })
}

fn rounded(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps
}

fn run(renderer: &mut Renderer) {
    (0..FRAMES).for_each(|_| renderer.frame().unwrap_or_else(|error| panic!("{error}")));
    renderer.finish().unwrap_or_else(|error| panic!("{error}"));
}

/// Rays a pixel of every node in the last frame.
fn rays<'a>(context: &Context, parts: &Parts<'_>, nodes: impl Iterator<Item = &'a String>) -> Vec<(String, f64)> {
    let nodes: Vec<String> = nodes.cloned().collect();
    let keep: Vec<String> = nodes.iter().map(|node| format!("{node}.traced")).collect();
    let keep: Vec<&str> = keep.iter().map(String::as_str).collect();
    let mut renderer = Parts { settings: &["slots.trace=counted"], keep: &keep, ..parts.clone() }.renderer(context);
    run(&mut renderer);
    let mut count = |name: &str| {
        let words = renderer.read_f32(name).unwrap_or_else(|error| panic!("{error}"));
        f64::from(words[0].to_bits()) / f64::from(SIZE[0] * SIZE[1])
    };
    nodes.into_iter().zip(keep).map(|(node, port)| (node, count(port))).collect()
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
