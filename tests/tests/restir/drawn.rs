//! What a domain's ray met, its test of visibility finds: also far from where numbers are small. Where it does not, every target that holds visibility
//! takes the sample for one that the pixel could not have drawn, and it is reused by none.

use aquifer_scenes::{
    Scene,
    build::{Shape, Stage, glow, matte},
};
use aquifer_tests::{Parts, context, scene};
use glam::{EulerRot, Quat, Vec3};
use std::sync::Arc;

/// A small board over a ground whose corners are a kilometre away and lie along no axis of their mesh: places on it are rounded by what the ground's
/// corners are, off its plane too, and seen from a board whose own corners are small.
fn board_over_wide_ground() -> Arc<Scene> {
    let mut stage = Stage::new("board_over_wide_ground");
    let grey = stage.material(matte("grey", [0.5; 3]));
    let lamp = stage.material(glow("lamp", [4.0; 3]));
    let tilt = Quat::from_euler(EulerRot::YXZ, 0.7, 0.3, -0.2);
    let mut ground = Shape::new("ground");
    ground.quad(grey, tilt * Vec3::new(-1000.0, -1.1, 1000.0), tilt * (Vec3::X * 2000.0), tilt * (Vec3::NEG_Z * 2000.0));
    stage.add(ground);
    let mut board = Shape::new("board");
    board.quad(grey, Vec3::new(-0.6, -0.6, 0.0), Vec3::X * 1.2, Vec3::Y * 1.2);
    stage.add(board);
    let mut above = Shape::new("lamp");
    above.quad(lamp, Vec3::new(-3.0, 30.0, -3.0), Vec3::X * 6.0, Vec3::Z * 6.0);
    stage.add(above);
    stage.camera("main", [0.0, 0.0, 1.5], [0.0; 3], 35.0);
    Arc::new(stage.into_scene().finish().expect("a scene made by hand is valid"))
}

#[test]
fn what_is_drawn_is_seen() {
    let Some(context) = context() else { return };
    let wide = board_over_wide_ground();
    for scene in [&wide, &scene("cornell")] {
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
