//! Histories stay with what they are of: at the same pixel where nothing moves, and at the motion's mean where something does.

use aquifer_lab::stats::Moments;
use aquifer_render::{Context, Renderer, View};
use aquifer_tests::{Parts, context, scene};

const GRAPH: &str = "extends = 'gbuffer_view.toml'
[pass.which_before]
in.surface = 'gbuffer_traced.surface'
in.previous_surface = 'gbuffer_traced.surface@prev'
in.motion = 'gbuffer_traced.motion'";

fn renderer(context: &Context, name: &str, step: f32) -> Renderer {
    let scene = scene(name);
    let shaders = &[("pass/which_before", include_str!("which_before.wgsl"))];
    let keep = &["which_before.found", "gbuffer_traced.motion"];
    let view = View { time: 0.3, step, ..View::default() };
    let mut renderer = Parts { view, shaders, keep, ..Parts::new(&scene, GRAPH) }.renderer(context);
    // The first frame has no history.
    renderer.frame().unwrap();
    renderer
}

fn pairs(renderer: &mut Renderer, name: &str) -> Vec<[f32; 2]> {
    renderer.read_f32(name).unwrap().chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// Frames over which the film sample moves all over the pixel.
const FRAMES: u32 = 64;

#[test]
fn what_stands_still_keeps_its_pixel() {
    let Some(context) = context() else { return };
    let mut renderer = renderer(&context, "cornell", 0.0);
    for frame in 1..=FRAMES {
        renderer.frame().unwrap();
        let found = pairs(&mut renderer, "which_before.found");
        let wrong = found.iter().filter(|found| **found != [0.0; 2] && found[0] < 1e3).count();
        assert_eq!(wrong, 0, "frame {frame}: pixels that take another's history");
        let none = found.iter().filter(|found| found[0] > 1e3).count();
        assert!(none <= found.len() / 10, "frame {frame}: {none} pixels of {} find nothing", found.len());
    }
}

#[test]
fn what_moves_is_followed_in_the_mean() {
    let Some(context) = context() else { return };
    let mut renderer = renderer(&context, "animated", 0.05);
    let mut off = [Moments::default(), Moments::default()];
    let mut moving = 0;
    for frame in 1..=FRAMES {
        renderer.frame().unwrap();
        let both = pairs(&mut renderer, "which_before.found").into_iter().zip(pairs(&mut renderer, "gbuffer_traced.motion"));
        let seen: Vec<_> = both.filter(|(found, _)| found[0] < 1e3).collect();
        assert!(seen.len() > 1000, "frame {frame}");
        moving += seen.iter().filter(|(_, motion)| motion[0].abs().max(motion[1].abs()) > 0.1).count();
        for axis in 0..2 {
            let errors: Vec<f64> = seen.iter().map(|(found, motion)| f64::from(found[axis] - motion[axis])).collect();
            let worst = errors.iter().fold(0.0, |worst: f64, error| worst.max(error.abs()));
            assert!(worst <= 1.0, "frame {frame}, axis {axis}: {worst} pixels from where the motion leads");
            // All pixels of a frame are rounded by the same number: a frame counts as one.
            off[axis] = off[axis].merged([errors.iter().sum::<f64>() / errors.len() as f64].into_iter().collect());
        }
    }
    assert!(moving > 10_000, "{moving}: little moves");
    for (axis, moments) in off.iter().enumerate() {
        eprintln!("axis {axis}: {:+.3} ± {:.3} pixels a frame", moments.mean(), moments.standard_error());
        assert!(moments.standard_error() < 0.08 && moments.mean().abs() < 4.0 * moments.standard_error(), "axis {axis}: {moments:?}");
    }
}
