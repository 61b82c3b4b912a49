//! History, zeros, sharing: what lies in memory when.

mod common;

use aquifer_graph::Value;
use aquifer_render::{Error, Renderer, RendererOptions};
use common::{pixels, plan, registry, render, renderer, small};

const COUNT: &str = "[pass.count]\nin.before = \"count.after@prev\"\n";

#[test]
fn history_swaps_every_frame_and_a_restart_clears_it() {
    let registry = registry(&[]);
    let mut renderer = renderer(&registry, plan(&registry, "count.after", COUNT, &[]), small());
    for frames in 1..=5 {
        render(&mut renderer, 1);
        assert!(pixels(&mut renderer, "count.after").iter().all(|pixel| *pixel == [frames as f32; 4]), "after {frames} frames");
    }
    renderer.restart().unwrap();
    render(&mut renderer, 2);
    assert_eq!(pixels(&mut renderer, "count.after"), [[2.0; 4]; 13 * 9]);
}

#[test]
fn prev_reads_exactly_one_frame_back() {
    let registry = registry(&[]);
    let passes = "[pass.source]\n[pass.copy]\nin.value = \"source.value@prev\"\n";
    let options = RendererOptions { first_frame: 100, ..small() };
    let mut renderer = renderer(&registry, plan(&registry, "copy.image", passes, &["source.value"]), options);
    render(&mut renderer, 1);
    assert_eq!(pixels(&mut renderer, "copy.image")[7], [0.0; 4], "history begins as zeros");
    render(&mut renderer, 6);
    assert_eq!(pixels(&mut renderer, "copy.image")[7], [105.0; 4]);
    assert_eq!(pixels(&mut renderer, "source.value")[7], [106.0; 4]);
}

#[test]
fn an_unwired_port_reads_zeros_of_its_full_extent() {
    let registry = registry(&[]);
    let mut renderer = renderer(&registry, plan(&registry, "lengths.image", "[pass.lengths]\n", &[]), small());
    render(&mut renderer, 2);
    assert_eq!(pixels(&mut renderer, "lengths.image"), [[117.0, 0.0, 0.0, 117.0]; 117]);
}

/// Six transients in a row, of which two blocks are enough.
fn chain() -> String {
    let mut passes = "[pass.a0]\nkind = \"count\"\n".to_owned();
    for step in 1..7 {
        passes += &format!("[pass.a{step}]\nkind = \"count\"\nin.before = \"a{}.after\"\n", step - 1);
    }
    passes
}

#[test]
fn shared_memory_is_never_read_after_it_changed_hands() {
    let registry = registry(&[]);
    let plan = plan(&registry, "a6.after", &chain(), &[]);
    for poison in [false, true] {
        let mut renderer = renderer(&registry, plan.clone(), RendererOptions { poison, ..small() });
        render(&mut renderer, 3);
        assert_eq!(pixels(&mut renderer, "a6.after"), [[7.0; 4]; 117], "poison: {poison}");
        let memory = renderer.memory();
        assert_eq!(memory.saved, 4 * 117 * 16, "six transients in two blocks");
        assert!(memory.resources.iter().all(|resource| resource.bytes == 117 * 16));
    }
}

#[test]
fn poison_shows_what_a_pass_leaves_unwritten() {
    let registry = registry(&[]);
    let plan = plan(&registry, "gaps.value", "[pass.gaps]\n", &[]);
    let mut clean = renderer(&registry, plan.clone(), small());
    render(&mut clean, 1);
    assert_eq!(pixels(&mut clean, "gaps.value")[0..2], [[7.0; 4], [0.0; 4]]);
    let mut poisoned = renderer(&registry, plan, RendererOptions { poison: true, ..small() });
    render(&mut poisoned, 1);
    let found = pixels(&mut poisoned, "gaps.value");
    assert_eq!(found[0], [7.0; 4]);
    assert!(found[1].iter().all(|value| value.is_nan()));
}

#[test]
fn an_unwired_port_that_is_written_too_begins_every_frame_as_zeros() {
    let registry = registry(&[]);
    for poison in [false, true] {
        let options = RendererOptions { poison, ..small() };
        let mut renderer = renderer(&registry, plan(&registry, "two_steps.image", "[pass.two_steps]\n", &[]), options);
        render(&mut renderer, 3);
        assert_eq!(pixels(&mut renderer, "two_steps.image"), [[10.0; 4]; 117], "poison: {poison}");
    }
}

#[test]
fn tiles_and_lists_have_their_own_extents() {
    let registry = registry(&[]);
    let passes = "[pass.tiles]\n[pass.tiles_seen]\nin.tile = \"tiles.tile\"\n";
    let mut renderer = renderer(&registry, plan(&registry, "tiles_seen.list", passes, &[]), RendererOptions { size: [10, 5], ..small() });
    render(&mut renderer, 1);
    let expected: Vec<f32> = (0..3).flat_map(|y| (0..3).flat_map(move |x| [x as f32, y as f32])).collect();
    assert_eq!(renderer.read_f32("tiles_seen.list").unwrap(), expected);
}

#[test]
fn a_large_image_comes_back_whole() {
    let registry = registry(&[]);
    let options = RendererOptions { size: [1031, 1027], ..small() };
    let mut renderer = renderer(&registry, plan(&registry, "position.image", "[pass.position]\n", &[]), options);
    render(&mut renderer, 1);
    let found = pixels(&mut renderer, "position.image");
    assert_eq!(found.len(), 1031 * 1027);
    let wrong =
        found.iter().enumerate().find(|&(i, pixel)| *pixel != [(i % 1031) as f32, (i / 1031) as f32, i as f32, (1031 * 1027) as f32]);
    assert_eq!(wrong, None);
}

#[test]
fn only_what_is_kept_can_be_read() {
    let registry = registry(&[]);
    let mut renderer = renderer(&registry, plan(&registry, "a6.after", &chain(), &["a2.after"]), small());
    render(&mut renderer, 2);
    assert_eq!(pixels(&mut renderer, "a2.after")[116], [3.0; 4]);
    assert!(matches!(renderer.read("a3.after"), Err(Error::NotKept { name }) if name == "a3.after"));
    let Err(Error::NoResource { name, known }) = renderer.read("a9.after") else { panic!("there is no a9") };
    assert_eq!(name, "a9.after");
    assert!(known.contains(&"a6.after".to_owned()));
}

#[test]
fn another_size_keeps_live_parameters() {
    let registry = registry(&[]);
    let scale = "[pass.source]\n[pass.scale]\nin.value = \"source.value\"\n";
    let mut renderer = renderer(&registry, plan(&registry, "scale.image", scale, &[]), small());
    renderer.set_param("scale", "offset", Value::U32(7)).unwrap();
    let shown = |renderer: &mut Renderer| {
        renderer.restart().unwrap();
        render(renderer, 1);
        pixels(renderer, "scale.image")[0]
    };
    let before = shown(&mut renderer);
    renderer.resize(&registry, [5, 4]).unwrap();
    assert_eq!(shown(&mut renderer), before);
    renderer.set_param("scale", "offset", Value::U32(1)).unwrap();
    assert_ne!(shown(&mut renderer), before, "the parameter does nothing here");
}

#[test]
fn another_size_begins_anew() {
    let registry = registry(&[]);
    let mut renderer = renderer(&registry, plan(&registry, "count.after", COUNT, &[]), small());
    render(&mut renderer, 3);
    renderer.resize(&registry, [5, 4]).unwrap();
    render(&mut renderer, 1);
    assert_eq!(pixels(&mut renderer, "count.after"), [[1.0; 4]; 20]);
    assert!(matches!(renderer.resize(&registry, [0, 4]), Err(Error::EmptyImage { width: 0, height: 4 })));
    render(&mut renderer, 1);
    assert_eq!(pixels(&mut renderer, "count.after"), [[2.0; 4]; 20], "the old size stays");
}

#[test]
fn floats_that_are_none_are_counted_where_they_were_written() {
    let registry = registry(&[]);
    let plan = plan(
        &registry,
        "copy.image",
        "[pass.source]\n[pass.sick]\n[pass.copy]\nin.value = \"sick.value\"\n",
        &["source.value", "sick.mixed"],
    );
    let mut blind = renderer(&registry, plan.clone(), small());
    render(&mut blind, 2);
    assert_eq!(blind.counts().unwrap(), []);
    let mut counting = renderer(&registry, plan, RendererOptions { counters: true, ..small() });
    render(&mut counting, 2);
    let counts = counting.counts().unwrap();
    let found = |name: &str| {
        let counts = counts.iter().find(|counts| format!("{}.{}", counts.pass, counts.port) == name).unwrap();
        (counts.nan, counts.infinite)
    };
    // Two frames; 13 pixels a row.
    assert_eq!([found("source.value"), found("sick.mixed"), found("sick.value"), found("copy.image")], [(0, 0), (2, 0), (0, 26), (0, 26)]);
    let bits = |renderer: &mut aquifer_render::Renderer| renderer.read("copy.image").unwrap();
    assert_eq!(bits(&mut blind), bits(&mut counting), "counting changes nothing");
}
