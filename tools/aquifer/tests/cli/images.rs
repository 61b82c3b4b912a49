//! `aquifer merge` and `diff`

use crate::{
    films::facts,
    run::{aquifer, names},
};
use aquifer_lab::film::{Film, Runs};
use std::path::Path;

/// A flat film of `frames` frames.
fn film(value: f32, first_frame: u64, frames: u32) -> Film {
    let variance = Some(vec![[1e-6; 3]; 64]);
    Film { variance, facts: Some(facts(first_frame, frames)), ..Film::new([8, 8], vec![[value; 3]; 64]).expect("64 pixels") }
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
    let metrics = &report["areas"][0]["metrics"];
    let mse = metrics["mse"]["value"].as_f64().expect("a number");
    assert!((mse - (0.01 - 1e-6)).abs() < 1e-7, "{mse}");
    assert!((metrics["mape"]["value"].as_f64().expect("a number") - 0.1 / 1.01).abs() < 1e-6);
    assert!(metrics["flip_hdr"]["value"].as_f64().is_some_and(|flip| flip > 0.0 && flip < 0.2), "{metrics}");
    assert_eq!(report["agreement"], "failed");
    assert!(aquifer(&["diff", &near, &a, "--agree"]).succeeds().out.contains("passed"));
    assert_eq!(aquifer(&["diff", &far, &a, "--agree"]).code, 1);
    let small = write(folder.path(), "small.exr", &Film::new([1, 1], vec![[1.0; 3]]).expect("1 pixel"));
    aquifer(&["diff", &small, &a]).fails(1, "1×1 and 8×8");
}

#[test]
fn parts_and_limits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let reference = Film::new([8, 8], vec![[1.0; 3]; 64]).expect("64 pixels");
    let mut image = reference.clone();
    (0..4).for_each(|i| image.color[i] = [0.5; 3]);
    let mut mask = Film::new([8, 8], vec![[0.0; 3]; 64]).expect("64 pixels");
    (0..2).for_each(|i| mask.color[i] = [1.0; 3]);
    let [reference, image, mask] =
        [("reference.png", &reference), ("image.png", &image), ("mask.png", &mask)].map(|(name, film)| write(folder.path(), name, film));
    let mse = |more: &[&str], area: usize| -> f64 {
        let args: Vec<&str> = ["diff", &image, &reference, "--json"].into_iter().chain(more.iter().copied()).collect();
        let report: serde_json::Value = serde_json::from_str(&aquifer(&args).succeeds().out).expect("JSON");
        report["areas"][area]["metrics"]["mse"]["value"].as_f64().expect("a number")
    };
    let all = mse(&[], 0);
    assert!((mse(&["--region", "top=0,0,8x1"], 1) - 8.0 * all).abs() < 1e-9);
    assert_eq!(mse(&["--region", "0,1,8x7"], 1), 0.0);
    assert!((mse(&["--mask", &mask], 0) - 16.0 * all).abs() < 1e-9);
    aquifer(&["diff", &image, &reference, "--region", "1,0,8x1"]).fails(1, "leaves the image of 8×8");
    aquifer(&["diff", &image, &reference, "--region", "0,4,8x1", "--mask", &mask]).fails(1, "no pixel is left");
    aquifer(&["diff", &image, &reference, "--limit", "mse=1", "--limit", "psnr=10"]).succeeds();
    assert_eq!(aquifer(&["diff", &image, &reference, "--limit", "mse=0.001"]).code, 1);
    assert_eq!(aquifer(&["diff", &image, &reference, "--limit", "psnr=60"]).code, 1);
    aquifer(&["diff", &image, &reference, "--limit", "flip=1"]).fails(2, "there is no metric `flip`");
}

/// What a colour of the picture must be.
type IsRight = fn([f32; 3]) -> bool;

#[test]
fn differences_become_pictures() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let reference = write(folder.path(), "reference.exr", &film(1.0, 0, 32));
    let image = write(folder.path(), "image.exr", &film(2.0, 0, 32));
    let black = write(folder.path(), "black.exr", &film(0.0, 0, 32));
    let out = folder.path().join("heat.png").to_string_lossy().into_owned();
    let cases: [(&str, IsRight); 3] =
        [("difference", |c| c[0] > 2.0 * c[2]), ("flip-hdr", |c| c[0] > c[1]), ("flip-ldr", |c| c.iter().all(|&c| c < 0.01))];
    for (what, is_right) in cases {
        aquifer(&["diff", &image, &reference, "--heat", &out, "--heat-of", what]).succeeds();
        let heat = Film::read(Path::new(&out)).expect("it was written");
        assert!(heat.size == [8, 8] && is_right(heat.color[0]), "{what}: {:?}", heat.color[0]);
    }
    aquifer(&["diff", &image, &black, "--heat", &out]).fails(1, "the reference is black");
    assert!(aquifer(&["diff", &image, &black]).succeeds().out.contains("undefined (the reference is black)"));
}
