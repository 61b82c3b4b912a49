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
    Loaded, Opening, Recipe,
    session::{Camera, LEAST, Message, Session, Watch},
};
use board::wait;
use opening::opening;
use std::sync::Arc;

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

#[test]
fn what_holds_no_numbers_is_no_picture_and_the_session_goes_on() {
    if !has_adapter() {
        return;
    }
    let mut opening = opening(&["light_sampling"], "cornell", vec![]);
    opening.graphs[0].set("slots.trace", Some("\"counted\"".to_owned()));
    let session = Session::start(opening, || {});
    let board = wait(&session, "it renders", |board| board.sides[0].picture.is_some());
    let resources = &board.sides[0].shown.as_ref().unwrap().plan.resources;
    let counter = resources.iter().find(|resource| resource.name.ends_with(".traced")).expect("rays are counted").name.clone();
    session.send(Message::Watch(0, Some(Watch { resource: counter, member: None })));
    let board = wait(&session, "the counter is read", |board| board.sides[0].watched.is_some() || board.trouble.is_some());
    assert_eq!(board.trouble, None);
    assert!(board.sides[0].watched.as_ref().unwrap().film.is_none());
    wait(&session, "the picture goes on", |after| after.updates > board.updates + 1);
}

#[test]
fn panics_are_told_on_the_board() {
    let loads_nothing =
        Opening { load_scene: Box::new(|| panic!("a scene that panics")), ..opening(&["light_sampling"], "cornell", vec![]) };
    let session = Session::start(loads_nothing, || {});
    let board = wait(&session, "the panic is told", |board| board.trouble.is_some());
    assert!(board.trouble.unwrap().contains("a scene that panics"));
    assert_eq!(board.waiting, None);
    if !has_adapter() {
        return;
    }
    let makes_nothing =
        Opening { load_graph: Arc::new(|_| panic!("a graph that panics")), ..opening(&["light_sampling"], "cornell", vec![]) };
    let session = Session::start(makes_nothing, || {});
    let board = wait(&session, "the panic is told", |board| board.sides[0].fault.is_some());
    assert!(board.sides[0].fault.as_ref().unwrap().contains("a graph that panics"));
    assert!(!board.sides[0].building);
}

#[test]
fn sides_are_judged_by_the_reference_of_their_own_light_paths_and_anew_when_the_camera_comes_back() {
    if !has_adapter() {
        return;
    }
    let cache = tempfile::tempdir().unwrap();
    let graphs = ["light_sampling", "gbuffer_view"];
    let session = Session::start(Opening { cache: cache.path().to_owned(), ..opening(&graphs, "cornell", vec![]) }, || {});
    wait(&session, "both render", |board| board.sides.iter().all(|side| side.picture.is_some()));
    session.send(Message::Truth(1));
    wait(&session, "the reference is asked for", |board| board.truth.is_some() || !board.truth_state.is_empty());
    // So that it comes sooner.
    session.send(Message::Hold(true));
    wait(&session, "there is a reference", |board| board.truth.is_some());
    session.send(Message::Hold(false));
    let judged = wait(&session, "A is judged", |board| board.sides[0].judged.as_ref().is_some_and(|judged| judged.curve.len() > 2));
    let (truth, first) = (judged.truth.clone().unwrap(), judged.sides[0].judged.clone().unwrap());
    assert_eq!((truth.about.size, truth.about.transport.to_string()), (LEAST, "direct".to_owned()));
    assert!(truth.samples > 0 && first.metrics.iter().all(|(_, value)| value.is_finite()), "{:?}", first.metrics);
    assert!(first.curve.iter().all(|point| point.rel_mse > 0.0), "{:?}", first.curve);

    assert!(judged.sides[1].judged.is_none(), "B renders other light paths");
    assert!(judged.unjudged(1).unwrap().contains("`emission`") && judged.unjudged(0).is_none());
    session.send(Message::Recipe(1, Recipe::of("light_sampling")));
    wait(&session, "B is judged too", |board| board.sides[1].judged.is_some());
    session.send(Message::Recipe(1, Recipe::of("gbuffer_view")));
    wait(&session, "it is judged no more", |board| board.sides[1].judged.is_none() && board.unjudged(1).is_some());

    let camera = judged.moment.unwrap().camera;
    session.send(Message::Camera(Camera::Free(camera)));
    let moved = wait(&session, "the judgement is withdrawn", |board| board.truth.is_none() && board.sides[0].judged.is_none());
    let later = wait(&session, "pictures go on", |board| board.updates > moved.updates + 3);
    assert!(later.truth.is_none() && later.sides[0].judged.is_none(), "references are of the scene's cameras");
    assert!(later.moment.is_some_and(|moment| moment.name.is_none() && moment.camera == camera));

    session.send(Message::Camera(Camera::Named(None)));
    let anew = wait(&session, "A is judged anew", |board| board.sides[0].judged.is_some());
    assert_eq!(anew.truth.unwrap().samples, truth.samples, "it was in the cache");
    let curve = &anew.sides[0].judged.as_ref().unwrap().curve;
    assert!(!curve.is_empty() && curve.iter().all(|point| !first.curve.contains(point)), "{curve:?} goes on from {:?}", first.curve);
}

#[test]
fn far_from_the_scenes_origin_commands_tell_the_scenes_own_places() {
    if !has_adapter() {
        return;
    }
    const FAR: f32 = 4096.0;
    let load_scene = || {
        let mut scene = (aquifer_scenes::by_name("cornell").unwrap().make)();
        scene.nodes.iter_mut().filter(|node| node.parent.is_none()).for_each(|node| node.translation.x += FAR);
        let scene = Arc::new(scene.finish().map_err(|error| error.to_string())?);
        Ok(Loaded { scene, content: Arc::new(|| Ok("far".to_owned())), environment: None })
    };
    let opening = Opening { load_scene: Box::new(load_scene), ..opening(&["gbuffer_view"], "cornell", vec![]) };
    let recipe = opening.graphs[0].clone();
    let session = Session::start(opening, || {});
    let board = wait(&session, "it renders", |board| board.sides[0].picture.is_some());
    let camera = board.moment.unwrap().camera;
    session.send(Message::Camera(Camera::Free(camera)));
    let picture = |board: &aquifer_viewer::session::Board| board.sides[0].picture.clone().unwrap();
    let free = picture(&wait(&session, "the camera is free", |board| picture(board).moment.name.is_none()));
    let command = aquifer_viewer::save::render_command(&recipe, "far.glb", &[], 0, &free);
    let look = command.split_once("--look ").unwrap().1;
    let x: f32 = look.split_once(',').unwrap().0.parse().unwrap();
    assert!((x - FAR - camera.position().x).abs() < 1e-2 && camera.position().x.abs() < 0.5 * FAR, "{command}");
}

/// Mean absolute difference of the first sides' pictures.
fn difference(a: &aquifer_viewer::session::Board, b: &aquifer_viewer::session::Board) -> f32 {
    let color = |board: &aquifer_viewer::session::Board| board.sides[0].picture.clone().unwrap().film.color.clone();
    let (a, b) = (color(a), color(b));
    a.iter().zip(&b).map(|(a, b)| (a[1] - b[1]).abs()).sum::<f32>() / a.len() as f32
}
