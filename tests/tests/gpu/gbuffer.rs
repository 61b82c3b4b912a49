//! The rasterised g-buffer beside the traced one.
//!
//! Both look along the same rays. They may differ only where the rasteriser's rounding of corners to 1/256 pixel decides, so: the same triangle
//! on at least 99.5 % of pixels, and there the same place, normal and motion.

use aquifer_render::View;
use aquifer_scene::Scene;
use aquifer_tests::{Kept, Parts, context, scene};
use glam::{Vec2, Vec3};
use std::sync::Arc;

const GRAPH: &str = "title = 'both'\ntransport = 'emission'\noutput = 'debug_view.color'\n[pass.gbuffer]\n[pass.gbuffer_traced]\n\
                     [pass.debug_view]\nin.surface = 'gbuffer.surface'\n";
const KEEP: [&str; 4] = ["gbuffer.surface", "gbuffer.motion", "gbuffer_traced.surface", "gbuffer_traced.motion"];

/// What one pass stored for one pixel.
#[derive(Clone, Copy, Debug)]
struct Seen {
    position: Vec3,
    /// Instance and triangle.
    primitive: [u32; 2],
    /// Shading and geometric, packed.
    normals: [u32; 2],
    distance: f32,
    motion: Vec2,
}

fn seen(surface: &[f32], motion: &[f32]) -> Vec<Seen> {
    let pixel = |(record, motion): (&[f32], &[f32])| Seen {
        position: Vec3::from_slice(record),
        primitive: [record[3].to_bits(), record[4].to_bits()],
        normals: [record[5].to_bits(), record[8].to_bits()],
        distance: record[15],
        motion: Vec2::from_slice(motion),
    };
    surface.chunks_exact(16).zip(motion.chunks_exact(2)).map(pixel).collect()
}

/// As `base/pack::unpack_unit`.
fn unit(bits: u32) -> Vec3 {
    let [x, y] = [bits as u16 as i16, (bits >> 16) as u16 as i16].map(|s| f32::from(s) / 32767.0);
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    Vec3::new(x - fold.copysign(x), y - fold.copysign(y), z).normalize()
}

/// What both passes stored, over a few frames that each have a film sample of their own.
fn both(scene: &Arc<Scene>, view: View, size: [u32; 2], frames: u32) -> Vec<[Seen; 2]> {
    let context = context().expect("the caller asked");
    let mut renderer = Parts { keep: &KEEP, view, size, kept: Kept::All, ..Parts::new(scene, GRAPH) }.renderer(&context);
    let mut pairs = Vec::new();
    for _ in 0..frames {
        renderer.frame().unwrap();
        let [drawn, drawn_motion, traced, traced_motion] = KEEP.map(|name| renderer.read_f32(name).unwrap());
        let (drawn, traced) = (seen(&drawn, &drawn_motion), seen(&traced, &traced_motion));
        pairs.extend(drawn.into_iter().zip(traced).map(|(drawn, traced)| [drawn, traced]));
    }
    pairs
}

/// The share of pixels on which both saw the same triangle, after asserting that they agree about it.
fn same(pairs: &[[Seen; 2]]) -> f64 {
    let mut same = 0;
    for [drawn, traced] in pairs.iter().filter(|[drawn, traced]| drawn.primitive == traced.primitive) {
        same += 1;
        if traced.primitive[0] == u32::MAX {
            assert_eq!(drawn.position, traced.position, "the direction of a ray that meets nothing");
            continue;
        }
        let away = (drawn.position - traced.position).length() / traced.distance;
        assert!(away <= 1e-4, "{away} of the distance apart: {drawn:?} {traced:?}");
        for (a, b) in drawn.normals.into_iter().zip(traced.normals) {
            let degrees = unit(a).angle_between(unit(b)).to_degrees();
            assert!(degrees <= 0.1, "{degrees}° between normals: {drawn:?} {traced:?}");
        }
        assert!((drawn.motion - traced.motion).length() <= 0.05, "{drawn:?} {traced:?}");
    }
    f64::from(same) / pairs.len() as f64
}

/// Asserts agreement on a scene whose time goes by `step` seconds a frame.
fn assert_same(name: &str, step: f32) {
    let scene = scene(name);
    let pairs = both(&scene, View { time: 0.3, step, ..View::default() }, [128, 72], 3);
    let share = same(&pairs);
    println!("{name}: the same triangle on {:.3} % of pixels", 100.0 * share);
    assert!(share >= 0.995, "{name}: the same triangle on {:.2} % of pixels", 100.0 * share);
    let moving = pairs.iter().filter(|[_, traced]| traced.motion.length() > 0.1).count();
    assert!(step == 0.0 || moving > pairs.len() / 10, "{name}: {moving} of {} pixels move", pairs.len());
}

#[test]
fn drawing_sees_what_tracing_sees() {
    if context().is_none() {
        return;
    }
    // Walls behind the camera; leaves with mask and blend; things, lights and camera that move; many small triangles.
    for (name, step) in [("cornell", 0.0), ("textured", 0.0), ("animated", 0.05), ("many_lights", 0.0)] {
        assert_same(name, step);
    }
}

#[test]
#[ignore = "a minute: the others, among them scenes of millions of triangles"]
fn drawing_sees_what_tracing_sees_everywhere() {
    if context().is_none() {
        return;
    }
    for generator in aquifer_scenes::all().iter().filter(|generator| generator.name != "million") {
        assert_same(generator.name, 0.0);
    }
}
