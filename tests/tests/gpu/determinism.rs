//! The same seed gives the same bits; other seeds and frames give others.

use aquifer_tests::{Parts, context, image, scene};

const GRAPH: &str = "extends = 'path_tracer.toml'\ntransport = 'full:3'\noutput = 'accumulate.image'\n[pass.tonemap]\nremove = true";

#[test]
fn bits_depend_on_seed_and_frame_alone() {
    let Some(context) = context() else { return };
    let scene = scene("cornell");
    let render = |seed, first_frame| image(&mut Parts { seed, first_frame, ..Parts::new(&scene, GRAPH) }.renderer(&context), 3);
    let first = render(1, 0);
    assert_eq!(first, render(1, 0), "twice the same");
    assert_ne!(first, render(2, 0), "another seed");
    assert_ne!(first, render(1 << 32, 0), "a seed beyond 32 bits");
    assert_ne!(first, render(1, 3), "other frames");
}

#[test]
fn a_restart_repeats() {
    let Some(context) = context() else { return };
    let scene = scene("cornell");
    let mut renderer = Parts::new(&scene, GRAPH).renderer(&context);
    let first = image(&mut renderer, 2);
    renderer.restart().unwrap();
    assert_eq!(first, image(&mut renderer, 2));
}

#[test]
fn a_pass_more_does_not_change_the_numbers_of_the_others() {
    let Some(context) = context() else { return };
    let scene = scene("cornell");
    let plain = image(&mut Parts::new(&scene, GRAPH).renderer(&context), 2);
    let longer = format!("{GRAPH}\n[pass.debug_view]\nin.surface = 'gbuffer_traced.surface'\n");
    let kept = Parts { keep: &["debug_view.color"], ..Parts::new(&scene, &longer) };
    assert_eq!(plain, image(&mut kept.renderer(&context), 2));
}

#[test]
fn halves_make_the_whole() {
    let Some(context) = context() else { return };
    let scene = scene("cornell");
    let render =
        |first_frame, frames| image(&mut Parts { first_frame, size: [32, 18], ..Parts::new(&scene, GRAPH) }.renderer(&context), frames);
    let (whole, first, second) = (render(0, 64), render(0, 32), render(32, 32));
    for ((whole, first), second) in whole.iter().zip(&first).zip(&second) {
        for channel in 0..3 {
            let mean = (first[channel] + second[channel]) / 2.0;
            assert!((mean - whole[channel]).abs() <= 1e-6 * whole[channel].max(1e-6), "{mean} and {}", whole[channel]);
        }
    }
}
