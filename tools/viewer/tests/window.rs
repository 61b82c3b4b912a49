//! The window without a display: what people see and what keys and mouse do, by egui_kittest, drawn by wgpu.

#[path = "common/adapter.rs"]
mod adapter;
#[path = "common/opening.rs"]
mod opening;
#[path = "common/screen.rs"]
mod screen;
#[path = "common/waiting.rs"]
mod waiting;

use adapter::has_adapter;
use aquifer_graph::{Document, FsFiles, Graph, Value};
use aquifer_viewer::{session::Board, testimony::lines, window::Viewer};
use eframe::egui;
use egui_kittest::{Harness, kittest::Queryable as _};
use image::RgbaImage;
use opening::opening;
use screen::Screen;
use std::{path::Path, time::Duration};

const WINDOW: [f32; 2] = [1000.0, 640.0];

/// A window with these graphs, or nothing where there is no adapter.
fn window(graphs: &[&str]) -> Option<Harness<'static, Viewer>> {
    if !has_adapter() {
        return None;
    }
    let viewer = Viewer::new(opening(graphs, "cornell", vec![]), &egui::Context::default());
    let harness =
        Harness::builder().with_size(WINDOW).renderer(Screen::new()).build_ui_state(|ui, viewer: &mut Viewer| viewer.show(ui), viewer);
    Some(harness)
}

/// Steps until the board is as wanted.
fn until(harness: &mut Harness<'_, Viewer>, what: &str, wanted: impl Fn(&Board) -> bool) {
    waiting::until(what, || {
        harness.step();
        let board = harness.state().board();
        if wanted(board) {
            return Ok(());
        }
        Err(format!("faults {:?}", board.sides.iter().map(|side| &side.fault).collect::<Vec<_>>()))
    });
}

fn pictures(board: &Board) -> bool {
    board.sides.iter().all(|side| side.picture.as_ref().is_some_and(|picture| picture.frames > 1))
}

fn press(harness: &mut Harness<'_, Viewer>, key: egui::Key) {
    harness.key_press(key);
    harness.run_steps(2);
}

fn click(harness: &mut Harness<'_, Viewer>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(2);
}

/// Part of the stage, away from words and slider.
fn part(image: &RgbaImage, from: f32, to: f32) -> Vec<[u8; 4]> {
    let stage = 0.6 * image.width() as f32;
    let [from, to] = [from, to].map(|share| (share * stage) as u32);
    let rows = image.height() * 2 / 5..image.height() * 3 / 5;
    rows.flat_map(|y| (from..to).map(move |x| image.get_pixel(x, y).0)).collect()
}

#[test]
fn the_slider_splits_and_space_flips() {
    let Some(mut harness) = window(&["path_tracer", "gbuffer_view"]) else { return };
    until(&mut harness, "both render", pictures);
    press(&mut harness, egui::Key::H);
    let held = harness.state().board().updates;
    until(&mut harness, "rendering is held", |board| board.updates >= held);
    std::thread::sleep(Duration::from_millis(500));
    harness.run_steps(3);
    click(&mut harness, "Only A");
    let a = harness.render().unwrap();
    press(&mut harness, egui::Key::Space);
    let b = harness.render().unwrap();
    assert_ne!(part(&a, 0.1, 0.9), part(&b, 0.1, 0.9), "space flips");
    press(&mut harness, egui::Key::Space);
    assert_eq!(part(&a, 0.1, 0.9), part(&harness.render().unwrap(), 0.1, 0.9), "and back");
    press(&mut harness, egui::Key::Num1);
    let split = harness.render().unwrap();
    assert_eq!(part(&split, 0.1, 0.4), part(&a, 0.1, 0.4), "left of the slider is A");
    assert_eq!(part(&split, 0.6, 0.9), part(&b, 0.6, 0.9), "right of it is B");
    let slider = harness.get_by_label("split").rect();
    harness.drag_at(slider.center() + egui::vec2(0.0, 40.0));
    harness.run_steps(2);
    let moved = slider.center() + egui::vec2(-0.4 * 0.6 * WINDOW[0], 40.0);
    harness.hover_at(moved);
    harness.run_steps(2);
    harness.drop_at(moved);
    harness.run_steps(2);
    assert_eq!(part(&harness.render().unwrap(), 0.25, 0.4), part(&b, 0.25, 0.4), "the slider was dragged");
}

#[test]
fn parameters_change_the_graph_and_can_be_reset() {
    let Some(mut harness) = window(&["ris_only"]) else { return };
    until(&mut harness, "it renders", pictures);
    let of =
        |board: &Board, name: &str| board.sides[0].shown.as_ref()?.graph.nodes().iter().find_map(|node| node.params.get(name).copied());
    let before = of(harness.state().board(), "candidates");
    assert_eq!(before, Some(Value::U32(32)));
    // A baked parameter.
    harness.get_by_label("initial.candidates").set_value_accesskit(33.0);
    harness.run_steps(2);
    until(&mut harness, "it is compiled anew", |board| of(board, "candidates").is_some_and(|now| Some(now) != before));
    assert!(harness.state().board().sides[0].fault.is_none());
    click(&mut harness, "Reset initial.candidates");
    until(&mut harness, "it is as the file has it", |board| of(board, "candidates") == before && !board.sides[0].building);
}

#[test]
fn a_broken_file_is_told_and_the_picture_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let write = |text: &str| std::fs::write(&path, text).unwrap();
    write("extends = 'light_sampling.toml'\n");
    let Some(mut harness) = window(&[path.to_str().unwrap()]) else { return };
    until(&mut harness, "it renders", pictures);
    write("extends = 'light_sampling.toml'\n[slots]\nproposal = 'unifrom'\n");
    until(&mut harness, "the fault is told", |board| board.sides[0].fault.is_some());
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("the last good graph goes on").is_some());
    assert!(harness.query_by_label_contains("did you mean `uniform`?").is_some());
    let broken = harness.state().board().updates;
    until(&mut harness, "the picture goes on", |board| board.updates > broken + 1);
    write("extends = 'light_sampling.toml'\n[slots]\nproposal = 'uniform'\n");
    until(&mut harness, "the cure is taken over", |board| {
        let shown = board.sides[0].shown.as_ref().unwrap();
        board.sides[0].fault.is_none()
            && shown.graph.nodes().iter().any(|node| node.slots.get("proposal").is_some_and(|slot| slot == "uniform"))
    });
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("the last good graph goes on").is_none());
}

#[test]
fn the_inspector_shows_the_reservoirs_of_a_pixel_and_what_it_tried() {
    let Some(mut harness) = window(&["restir_di"]) else { return };
    until(&mut harness, "it renders", pictures);
    press(&mut harness, egui::Key::I);
    assert!(harness.query_by_label_contains("Click a pixel").is_some());
    let middle = egui::pos2(0.3 * WINDOW[0], 0.55 * WINDOW[1]);
    harness.drag_at(middle);
    harness.step();
    harness.drop_at(middle);
    until(&mut harness, "the pixel is read", |board| board.sides[0].records.iter().any(|record| record.resource == "spatial.1.testimony"));
    harness.run_steps(2);
    for label in ["initial.reservoir", "temporal.reservoir", "spatial.2.reservoir", "confidence", "sample.light", "Jacobian"] {
        assert!(harness.query_all_by_label_contains(label).next().is_some(), "{label}");
    }
    let board = harness.state().board();
    let of = |name: &str| board.sides[0].records.iter().find(|record| record.resource == name).unwrap().clone();
    let told = lines(&of("spatial.1.testimony"));
    let size = board.sides[0].picture.as_ref().unwrap().film.size.map(|side| side as i32);
    assert!(
        told.iter().filter(|line| line.against.is_none()).all(|line| (0..2).all(|axis| (0..size[axis]).contains(&line.pixel[axis]))),
        "{told:?}"
    );
    assert!((2..=7).contains(&told.len()), "the pixel itself and up to five neighbours, tried and carried: {told:?}");
    assert!(told.iter().all(|line| !line.before), "no history is wired to spatial, so none was looked at: {told:?}");
    let kept: Vec<_> = told.iter().filter_map(|line| line.carried.filter(|carried| carried.kept)).collect();
    assert_eq!(kept.len(), 1, "{told:?}");
    // What was kept is what the reservoir holds: W = Σw / p̂.
    let sum: f32 = told.iter().filter_map(|line| line.carried).map(|carried| carried.resampling).sum();
    let weight = of("spatial.1.reservoir").value("weight.value").unwrap() as f32;
    assert!((sum / kept[0].target - weight).abs() <= 1e-4 * weight, "{sum} / {} is not {weight}", kept[0].target);
}

#[test]
fn a_second_side_comes_and_goes_while_a_pixel_is_inspected() {
    let Some(mut harness) = window(&["light_sampling"]) else { return };
    until(&mut harness, "it renders", pictures);
    press(&mut harness, egui::Key::I);
    let middle = egui::pos2(0.3 * WINDOW[0], 0.55 * WINDOW[1]);
    harness.drag_at(middle);
    harness.step();
    harness.drop_at(middle);
    until(&mut harness, "the pixel is read", |board| !board.sides[0].records.is_empty());
    click(&mut harness, "Compare with …");
    until(&mut harness, "both are read", |board| board.sides.len() == 2 && board.sides.iter().all(|side| !side.records.is_empty()));
    click(&mut harness, "Close B");
    until(&mut harness, "B is gone", |board| board.sides.len() == 1);
}

#[test]
fn the_window_says_why_a_side_is_not_judged() {
    let Some(mut harness) = window(&["light_sampling", "gbuffer_view"]) else { return };
    until(&mut harness, "both render", pictures);
    click(&mut harness, "Errors");
    harness.get_by_label("Reference").click();
    harness.run_steps(2);
    click(&mut harness, "256 samples a pixel");
    until(&mut harness, "the reference is asked for", |board| board.truth.is_some() || !board.truth_state.is_empty());
    // So that it comes sooner.
    press(&mut harness, egui::Key::H);
    until(&mut harness, "there is a reference", |board| board.truth.is_some());
    press(&mut harness, egui::Key::H);
    until(&mut harness, "A is judged", |board| board.sides[0].judged.is_some());
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("B is not judged: the reference is of `direct`").is_some());
    assert!(harness.query_by_label_contains("A is not judged").is_none());
    assert!(harness.query_by_label_contains("times the error of B").is_none());
}

#[test]
fn changes_are_saved_as_the_difference_and_nothing_else() {
    let Some(mut harness) = window(&["ris_only"]) else { return };
    until(&mut harness, "it renders", pictures);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine");
    harness.get_by_label("initial.candidates").set_value_accesskit(33.0);
    harness.run_steps(2);
    let digest = |board: &Board| board.sides[0].shown.as_ref().map(|shown| shown.graph.digest());
    let before = digest(harness.state().board());
    until(&mut harness, "it is compiled anew", |board| digest(board) != before);
    harness.state_mut().keep(path.to_str().unwrap());
    harness.run_steps(2);
    click(&mut harness, "Changes (.toml)");
    let file = path.with_extension("toml");
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(text.starts_with("extends = \"ris_only.toml\"\n"), "{text}");
    assert_eq!(text.matches(" = ").count(), 3, "extends, title and one parameter:\n{text}");
    let files = aquifer_graph::Layered { upper: FsFiles, lower: aquifer_graph::Shelf::new("built-in", aquifer_graphs::files()) };
    let document = Document::load(file.to_str().unwrap(), &files).unwrap();
    let scene = (aquifer_scenes::by_name("cornell").unwrap().make)().finish().unwrap();
    let graph = Graph::check(&document, &aquifer_lab::stage::registry(Some(&scene), &[]).unwrap()).unwrap();
    assert_eq!(Some(graph.digest()), digest(harness.state().board()), "the file gives the graph that was seen:\n{text}");
    assert!(Path::new(&file).is_file());
}
