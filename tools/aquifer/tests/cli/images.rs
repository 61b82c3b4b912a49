//! `aquifer merge` and `diff`

use crate::run::{aquifer, names};
use aquifer_lab::film::{Facts, Film, GraphText, Runs};
use std::path::Path;

/// A flat film of `frames` frames.
fn film(value: f32, first_frame: u64, frames: u32) -> Film {
    let facts = Facts {
        samples_per_pixel: frames,
        render_seconds: 1.0,
        graph: GraphText::new("graph"),
        scene: "cornell".into(),
        environment: None,
        camera: "main".into(),
        animation_time: 0.0,
        transport: "direct".into(),
        runs: Runs::one(0, first_frame, u64::from(frames)),
        adapter: "none".into(),
        version: "0".into(),
    };
    let variance = Some(vec![[1e-6; 3]; 64]);
    Film { variance, facts: Some(facts), ..Film::new([8, 8], vec![[value; 3]; 64]).expect("64 pixels") }
}

fn write(folder: &Path, name: &str, film: &Film) -> String {
    let path = folder.join(name);
    film.write(&path).expect("the folder can be written");
    path.to_string_lossy().into_owned()
}

#[test]
fn halves_make_a_whole() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let a = write(folder.path(), "a.exr", &film(1.0, 0, 32));
    let b = write(folder.path(), "b.exr", &film(3.0, 32, 32));
    let c = write(folder.path(), "c.exr", &film(2.0, 64, 64));
    let out = folder.path().join("out.exr");
    aquifer(&["merge", &a, &b, &c, "-o", &out.to_string_lossy()]).succeeds();
    let merged = Film::read(&out).expect("it was written");
    assert_eq!(merged.color, vec![[2.0; 3]; 64]);
    assert_eq!(merged.facts.map(|facts| (facts.samples_per_pixel, facts.runs)), Some((128, Runs::one(0, 0, 128))));
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let a = write(folder.path(), "a.exr", &film(1.0, 0, 32));
    let same = write(folder.path(), "same.exr", &film(1.0, 16, 32));
    let mut other = film(1.0, 32, 32);
    if let Some(facts) = &mut other.facts {
        facts.scene = "glossy".into();
    }
    let other = write(folder.path(), "other.exr", &other);
    let out = folder.path().join("out.exr").to_string_lossy().into_owned();
    aquifer(&["merge", &a, &same, "-o", &out]).fails(1, "both hold frames of seed 0");
    aquifer(&["merge", &a, &other, "-o", &out]).fails(1, "differ in scene: cornell and glossy");
    aquifer(&["merge", &a, "gone.exr", "-o", &out]).fails(1, "gone.exr");
    aquifer(&["merge", &a, "-o", &out]).fails(2, "2 values");
    aquifer(&["merge", &a, &other, "-o", "/no/such/folder/out.exr"]).fails(1, "there is no folder");
    assert_eq!(names(folder.path()), ["a.exr", "other.exr", "same.exr"]);
}

#[test]
fn distances_are_measured() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let a = write(folder.path(), "a.exr", &film(1.0, 0, 32));
    let near = write(folder.path(), "near.exr", &film(1.001, 32, 32));
    let far = write(folder.path(), "far.exr", &film(1.1, 32, 32));
    let report: serde_json::Value = serde_json::from_str(&aquifer(&["diff", &far, &a, "--json"]).succeeds().out).expect("JSON");
    let mse = report["mse"].as_f64().expect("a number");
    assert!((mse - (0.01 - 1e-6)).abs() < 1e-7, "{mse}");
    assert_eq!(report["agreement"], "failed");
    assert!(aquifer(&["diff", &near, &a, "--agree"]).succeeds().out.contains("passed"));
    assert_eq!(aquifer(&["diff", &far, &a, "--agree"]).code, 1);
    let small = write(folder.path(), "small.exr", &Film::new([1, 1], vec![[1.0; 3]]).expect("1 pixel"));
    aquifer(&["diff", &small, &a]).fails(1, "1×1 and 8×8");
}
