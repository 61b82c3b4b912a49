//! Things that move: a frame of an animation is the moment it shows, and motion vectors lead to where things were.

use aquifer_render::View;
use aquifer_scene::{Camera, Moment, Scene};
use aquifer_tests::{Parts, context, image, scene};
use glam::{DVec2, DVec3};

const STEP: f32 = 0.05;
const SIZE: [u32; 2] = [64, 36];

#[test]
fn a_frame_of_an_animation_is_its_moment() {
    let Some(context) = context() else { return };
    let scene = scene("animated");
    let graph = "extends = 'path_tracer.toml'\ntransport = 'full:2'\noutput = 'path_tracer.color'\n[pass.accumulate]\nremove = true\n[pass.tonemap]\nremove = true";
    let view = View { time: 0.3, step: STEP, ..View::default() };
    let played = image(&mut Parts { view: view.clone(), ..Parts::new(&scene, graph) }.renderer(&context), 9);
    let still = View { time: view.time_at(8), step: 0.0, ..View::default() };
    // The same frame number draws the same random numbers: not a bit may differ.
    let moment = image(&mut Parts { view: still, first_frame: 8, ..Parts::new(&scene, graph) }.renderer(&context), 1);
    assert_eq!(played, moment);
    let start = View { time: 0.3, ..View::default() };
    assert_ne!(
        moment,
        image(&mut Parts { view: start, first_frame: 8, ..Parts::new(&scene, graph) }.renderer(&context), 1),
        "nothing moves"
    );
}

/// Film point of a world position, in pixels from the top left, in f64.
fn film_point(camera: &Camera, position: DVec3) -> DVec2 {
    let m = camera.to_world.matrix3;
    let d = position - camera.to_world.translation.as_dvec3();
    let (right, up, back) = (m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3());
    let (w, h) = (f64::from(SIZE[0]), f64::from(SIZE[1]));
    let scale = h / (2.0 * (f64::from(camera.vertical_fov) * 0.5).tan() * -d.dot(back));
    DVec2::new(w * 0.5 + d.dot(right) * scale, h * 0.5 - d.dot(up) * scale)
}

/// World position of a point of a triangle of an instance.
fn place(scene: &Scene, moment: &Moment, instance: usize, triangle: usize, barycentrics: [f32; 2]) -> DVec3 {
    let instance = &moment.instances[instance];
    let [a, b, c] = scene.meshes[instance.mesh as usize].corners(triangle).map(|corner| corner.as_dvec3());
    let local = a + f64::from(barycentrics[0]) * (b - a) + f64::from(barycentrics[1]) * (c - a);
    let m = &instance.transform.matrix3;
    m.x_axis.as_dvec3() * local.x
        + m.y_axis.as_dvec3() * local.y
        + m.z_axis.as_dvec3() * local.z
        + instance.transform.translation.as_dvec3()
}

#[test]
fn motion_leads_to_where_things_were() {
    let Some(context) = context() else { return };
    let scene = scene("animated");
    let graph = "extends = 'gbuffer_view.toml'";
    let view = View { time: 0.3, step: STEP, ..View::default() };
    let parts = Parts { view: view.clone(), keep: &["gbuffer_traced.surface", "gbuffer_traced.motion"], ..Parts::new(&scene, graph) };
    let mut renderer = parts.renderer(&context);
    for _ in 0..4 {
        renderer.frame().unwrap();
    }
    let surface = renderer.read_f32("gbuffer_traced.surface").unwrap();
    let motion = renderer.read_f32("gbuffer_traced.motion").unwrap();
    let [before, now] = [2, 3].map(|frame| scene.at(view.time_at(frame), None).unwrap());
    let firsts: Vec<usize> =
        scene.meshes.iter().scan(0, |next, mesh| Some(std::mem::replace(next, *next + mesh.triangles.len()))).collect();
    let (mut surfaces, mut moved) = (0, 0);
    for (record, motion) in surface.chunks_exact(16).zip(motion.chunks_exact(2)) {
        let (instance, triangle) = (record[3].to_bits(), record[4].to_bits() as usize);
        if instance == u32::MAX {
            continue;
        }
        let triangle = triangle - firsts[now.instances[instance as usize].mesh as usize];
        let at = |moment: &Moment| film_point(&moment.camera, place(&scene, moment, instance as usize, triangle, [record[6], record[7]]));
        let expected = at(&before) - at(&now);
        let found = DVec2::new(motion[0].into(), motion[1].into());
        assert!((found - expected).length() < 0.01, "{found} px, not {expected}, on instance {instance}");
        surfaces += 1;
        moved += usize::from(expected.length() > 0.1);
    }
    assert!(surfaces > 2000 && moved > 500, "{surfaces} surfaces, {moved} of them move: too few to tell anything");
}

#[test]
fn what_has_stopped_stands_still() {
    let Some(context) = context() else { return };
    let view = View { time: 0.3, step: STEP, centred: true, ..View::default() };
    let scene = scene("animated");
    let graph = "extends = 'gbuffer_view.toml'";
    let parts = Parts { view: view.clone(), keep: &["gbuffer_traced.motion"], ..Parts::new(&scene, graph) };
    let mut renderer = parts.renderer(&context);
    let furthest = |renderer: &mut aquifer_render::Renderer| {
        renderer.frame().unwrap();
        renderer.read_f32("gbuffer_traced.motion").unwrap().into_iter().fold(0.0, |most: f32, it| most.max(it.abs()))
    };
    furthest(&mut renderer);
    assert!(furthest(&mut renderer) > 1.0, "nothing moves");
    // Playing stops at the moment that was shown last.
    renderer.set_time(view.time_at(1), 0.0);
    for frame in 0..3 {
        let moved = furthest(&mut renderer);
        assert!(moved < 0.01, "{moved} px in frame {frame} of a moment that stays");
    }
}
