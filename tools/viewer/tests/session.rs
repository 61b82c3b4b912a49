//! A session without a window.

#[path = "common/adapter.rs"]
mod adapter;
#[path = "common/board.rs"]
mod board;
#[path = "common/opening.rs"]
mod opening;
#[path = "common/waiting.rs"]
mod waiting;

use adapter::has_adapter;
use aquifer_viewer::{
    Recipe,
    session::{Camera, LEAST, Message, Session, Watch},
};
use board::wait;
use opening::opening;

#[test]
fn two_graphs_spend_the_same_time_and_switch_while_they_run() {
    if !has_adapter() {
        return;
    }
    let session = Session::start(opening(&["path_tracer", "light_sampling"], "cornell", vec![]), || {});
    let board = wait(&session, "both render", |board| {
        board.sides.iter().all(|side| side.picture.as_ref().is_some_and(|picture| picture.frames > 12))
    });
    let pictures: Vec<_> = board.sides.iter().map(|side| side.picture.clone().unwrap()).collect();
    assert!(pictures.iter().all(|picture| picture.film.size == LEAST));
    let dearest = pictures.iter().map(|picture| picture.spent / f64::from(picture.frames)).fold(0.0, f64::max);
    // One frame may be dearer than the mean one.
    assert!((pictures[0].spent - pictures[1].spent).abs() <= 3.0 * dearest, "{} ms and {} ms", pictures[0].spent, pictures[1].spent);
    assert!(pictures[1].frames > pictures[0].frames, "direct light is cheaper than full paths");

    // Another graph is compiled while the old one goes on.
    session.send(Message::Recipe(1, Recipe::of("ris_only")));
    let before = wait(&session, "it compiles", |board| board.sides[1].building);
    let after = wait(&session, "it renders", |board| {
        !board.sides[1].building && board.sides[1].picture.as_ref().is_some_and(|picture| picture.frames > 1)
    });
    assert_eq!(after.sides[1].shown.as_ref().unwrap().graph.title(), "Resampled importance sampling");
    assert!(after.updates > before.updates && after.sides[0].fault.is_none());

    // Nothing of a graph that does not exist is taken over.
    session.send(Message::Recipe(1, Recipe::of("no_such_graph")));
    let faulty = wait(&session, "it is refused", |board| board.sides[1].fault.is_some());
    assert!(faulty.sides[1].fault.as_ref().unwrap().contains("no_such_graph"));
    wait(&session, "the old one goes on", |board| board.updates > faulty.updates + 2);
}

#[test]
fn moving_begins_the_mean_anew_and_settings_change_the_picture() {
    if !has_adapter() {
        return;
    }
    let session = Session::start(opening(&["light_sampling"], "cornell", vec![]), || {});
    let board = wait(&session, "it renders", |board| board.sides[0].picture.as_ref().is_some_and(|picture| picture.frames > 5));
    let mut camera = board.moment.clone().unwrap().camera;
    camera.to_world.translation.x += 0.1;
    session.send(Message::Camera(Camera::Free(camera)));
    let moved = wait(&session, "the camera moves", |board| board.moment.as_ref().is_some_and(|moment| moment.name.is_none()));
    assert!(moved.sides[0].picture.as_ref().unwrap().frames < 5);
    assert!(difference(&board, &moved) > 1e-3, "nothing moved");

    // A live parameter changes without compiling.
    let mut recipe = Recipe::of("light_sampling");
    recipe.set("tonemap.exposure", Some("2.0".to_owned()));
    session.send(Message::Recipe(0, recipe.clone()));
    let set = wait(&session, "the parameter is set", |board| {
        let graph = &board.sides[0].shown.as_ref().unwrap().graph;
        graph.nodes().iter().any(|node| node.params.get("exposure") == Some(&aquifer_graph::Value::F32(2.0)))
    });
    assert!(!set.sides[0].building);

    // A value out of range is told, and the picture goes on.
    recipe.set("tonemap.exposure", Some("1e9".to_owned()));
    session.send(Message::Recipe(0, recipe));
    let refused = wait(&session, "the value is refused", |board| board.sides[0].fault.is_some());
    wait(&session, "the picture goes on", |board| board.updates > refused.updates + 1);
}

#[test]
fn resources_and_reservoirs_can_be_looked_at() {
    if !has_adapter() {
        return;
    }
    let session = Session::start(opening(&["ris_only"], "cornell", vec![]), || {});
    wait(&session, "it renders", |board| board.sides[0].picture.is_some());
    session.send(Message::Watch(0, Some(Watch { resource: "initial.reservoir".to_owned(), member: Some("weight.value".to_owned()) })));
    let board = wait(&session, "the resource is read", |board| board.sides[0].watched.is_some());
    let watched = board.sides[0].watched.clone().unwrap();
    assert!(watched.element.starts_with("Reservoir<di"), "{}", watched.element);
    assert!(watched.range[1] > watched.range[0], "weights differ: {:?}", watched.range);

    session.send(Message::Hold(true));
    session.send(Message::Inspect(Some([0.5, 0.8])));
    session.send(Message::Hold(false));
    let board = wait(&session, "the pixel is read", |board| !board.sides[0].records.is_empty());
    let record = board.sides[0].records[0].clone();
    assert_eq!(record.value("confidence"), Some(1.0), "fresh reservoirs count as one: {record:?}");
    assert!(record.value("weight.value").unwrap() >= 0.0 && record.value("light").is_some());
    session.send(Message::Watch(0, None));
    wait(&session, "back to the picture", |board| board.sides[0].watched.is_none());
}

/// Mean absolute difference of the first sides' pictures.
fn difference(a: &aquifer_viewer::session::Board, b: &aquifer_viewer::session::Board) -> f32 {
    let color = |board: &aquifer_viewer::session::Board| board.sides[0].picture.clone().unwrap().film.color.clone();
    let (a, b) = (color(a), color(b));
    a.iter().zip(&b).map(|(a, b)| (a[1] - b[1]).abs()).sum::<f32>() / a.len() as f32
}
