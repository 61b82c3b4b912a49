//! Options of reuse that bias are labelled, and do what they say.

use aquifer_render::View;
use aquifer_tests::{Parts, context, scene};

const UNBIASED: &str = "extends = 'restir_di_unbiased.toml'";
const FILTERED: &str = "extends = 'restir_di_unbiased.toml'
[pass.boiling_filter]
in.surface = 'gbuffer_traced.surface'
in.current = 'temporal.reservoir'
[pass.spatial]
in.current = 'boiling_filter.reservoir'";
/// 32 bits of a reservoir: light, u, v, weight, confidence.
const RESERVOIR: usize = 5;

#[test]
fn the_boiling_filter_empties_what_stands_out() {
    let Some(context) = context() else { return };
    let scene = scene("many_lights");
    let keep = ["temporal.reservoir", "boiling_filter.reservoir"];
    for (limit, least, most) in [("boiling_filter.limit=10000", 0, 0), ("boiling_filter.limit=2", 20, 600)] {
        let mut renderer = Parts { settings: &[limit], keep: &keep, ..Parts::new(&scene, FILTERED) }.renderer(&context);
        renderer.frame().unwrap();
        let [before, after] = keep.map(|name| renderer.read_f32(name).unwrap());
        let pairs = before.chunks_exact(RESERVOIR).zip(after.chunks_exact(RESERVOIR));
        let emptied = pairs.filter(|(before, after)| before != after).inspect(|(_, after)| assert_eq!(after[3..], [0.0, 0.0])).count();
        eprintln!("{limit}: {emptied} of {} reservoirs", before.len() / RESERVOIR);
        assert!((least..=most).contains(&emptied), "{limit}: {emptied}");
    }
}

/// Where things move, today's world is another.
#[test]
fn todays_world_for_last_frames_targets() {
    let Some(context) = context() else { return };
    let scene = scene("animated");
    let [own, todays] = ["temporal.history_world=before", "temporal.history_world=now"].map(|setting| {
        let view = View { time: 0.3, step: 0.05, ..View::default() };
        let parts = Parts { settings: &[setting], keep: &["temporal.reservoir"], view, size: [32, 18], ..Parts::new(&scene, UNBIASED) };
        let mut renderer = parts.renderer(&context);
        (0..2).for_each(|_| renderer.frame().unwrap());
        renderer.read_f32("temporal.reservoir").unwrap()
    });
    assert_ne!(own, todays);
}
