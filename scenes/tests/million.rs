//! The big scene is big, and quick to make. In a file of its own, so that no other test runs beside it.

use aquifer_scenes::by_name;
use std::time::{Duration, Instant};

#[test]
fn a_million_triangles_take_less_than_five_seconds() {
    let make = by_name("million").expect("it is in the list").make;
    let start = Instant::now();
    let scene = make();
    let took = start.elapsed();
    let triangles: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    assert!(triangles >= 1_000_000, "{triangles}");
    assert!(took < Duration::from_secs(5), "{took:?}");
    println!("{triangles} triangles in {took:?}");
}
