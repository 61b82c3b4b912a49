//! `aquifer compare`

use crate::run::{aquifer, names};
use serde_json::Value;
use std::path::Path;

/// Two graphs whose time cannot be chosen, so that what is measured does not hang on the clock.
pub const SMALL: [&str; 11] =
    ["compare", "restir_di", "restir_di_unbiased", "--scene", "cornell", "--size", "16x9", "--warm-up", "2", "--reference-samples", "512"];

fn compare(out: &Path, cache: &Path, more: &[&str]) -> Value {
    let folders = ["-o", out.to_str().unwrap(), "--cache", cache.to_str().unwrap()];
    let args: Vec<&str> = SMALL.iter().chain(&folders).chain(more).copied().collect();
    let run = aquifer(&args);
    assert_eq!(run.code, 0, "{}", run.err);
    report(out)
}

/// What is in a folder that was written.
pub fn report(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("report.json")).unwrap()).unwrap()
}

/// Errors of every seed of every graph.
pub fn errors(report: &Value) -> Vec<Value> {
    report["scenes"][0]["cells"].as_array().unwrap().iter().map(|cell| cell["mse"]["values"].clone()).collect()
}

#[test]
fn an_interrupted_comparison_goes_on_to_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let whole = compare(&path("whole"), &path("cache"), &["--seeds", "3"]);
    compare(&path("parts"), &path("cache"), &["--seeds", "1"]);
    let measured = std::fs::read_dir(path("parts/measured")).unwrap().next().unwrap().unwrap().path();
    // An interruption in the middle of a round leaves films without the round's file; a bad disk leaves a film that is not the one noted.
    let film = names(&measured).into_iter().find(|name| name.ends_with(".exr")).unwrap();
    let mut bytes = std::fs::read(measured.join(&film)).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(measured.join(&film), bytes).unwrap();
    let parts = compare(&path("parts"), &path("cache"), &["--seeds", "3"]);
    assert_eq!(errors(&parts), errors(&whole));
    assert_eq!(errors(&whole)[0].as_array().unwrap().len(), 3);

    // A damaged reference is noticed, said, and made again as it was.
    let reference = names(&path("cache")).into_iter().find(|name| name.ends_with(".exr")).unwrap();
    std::fs::write(path("cache").join(reference), "rubbish").unwrap();
    let again = compare(&path("whole"), &path("cache"), &["--seeds", "3"]);
    assert_eq!(errors(&again), errors(&whole));
    let warnings = again["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|warning| warning.as_str().unwrap().contains("is damaged")), "{warnings:?}");
}

#[test]
fn jobs_make_the_comparison() {
    let folder = tempfile::tempdir().unwrap();
    let (out, cache) = (folder.path().join("out"), folder.path().join("cache"));
    let folders = ["-o", out.to_str().unwrap(), "--cache", cache.to_str().unwrap(), "--seeds", "2", "--sweep", "spatial.taps=1,2"];
    let with = |more: &[&str]| aquifer(&SMALL[..2].iter().chain(&SMALL[3..]).chain(&folders).chain(more).copied().collect::<Vec<&str>>());
    let plan = with(&["--plan"]).succeeds().out;
    assert_eq!(plan.lines().count(), 2, "{plan}");
    assert!(plan.lines().nth(1).unwrap().ends_with("cornell\trestir_di,spatial.taps=2"), "{plan}");
    with(&["--merge"]).fails(1, "2 of 2 jobs are missing");
    assert_eq!(with(&["--index", "1"]).code, 0);
    assert!(with(&["--status"]).succeeds().out.contains("\tmissing\t"));
    with(&["--index", "2"]).fails(1, "there is no job 2");
    assert_eq!(with(&["--shard", "0/2"]).code, 0);
    assert_eq!(with(&["--merge"]).code, 0);
    let report = report(&out);
    let scene = &report["scenes"][0];
    assert_eq!((scene["cells"].as_array().unwrap().len(), scene["pairs"].as_array().unwrap().len()), (2, 1));
    // Times of another adapter are not merged.
    let job = out.join("jobs").join(names(&out.join("jobs")).first().unwrap());
    let text = std::fs::read_to_string(&job).unwrap().replacen("\"adapter\": \"", "\"adapter\": \"another ", 1);
    std::fs::write(&job, text).unwrap();
    with(&["--merge"]).fails(1, "times of different adapters are not merged");
}

/// A triangle before a camera; where its corners are, another file says.
const TRIANGLE: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
"nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
"materials": [{"emissiveFactor": [1, 1, 1]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "corners.bin"}]}"#;

/// Writes such a scene, of that size.
fn triangle(folder: &Path, size: f32) -> String {
    std::fs::create_dir_all(folder).unwrap();
    let corners: Vec<u8> = [-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x: &f32| (size * x).to_le_bytes()).collect();
    std::fs::write(folder.join("corners.bin"), corners).unwrap();
    std::fs::write(folder.join("scene.gltf"), TRIANGLE).unwrap();
    folder.join("scene.gltf").to_str().unwrap().to_owned()
}

#[test]
fn scenes_of_one_name_stay_apart_and_edited_ones_are_measured_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let scenes = [triangle(&path("near"), 1.0), triangle(&path("far"), 0.5)];
    let with = |more: &[&str]| {
        let all =
            ["compare", "light_sampling", "--scene", &scenes[0], &scenes[1], "--size", "16x9", "--seeds", "2", "--reference-samples", "1"];
        let out = ["-o", path("out").to_str().unwrap(), "--cache", path("cache").to_str().unwrap()].map(str::to_owned);
        aquifer(&all.iter().copied().chain(out.iter().map(String::as_str)).chain(more.iter().copied()).collect::<Vec<&str>>())
    };
    assert_eq!(with(&["--shard", "0/1"]).code, 0);
    assert_eq!(with(&["--merge"]).code, 0);
    let merged = report(&path("out"));
    let found = |scene: &Value| (scene["name"].as_str().unwrap().to_owned(), scene["cells"].as_array().unwrap().len());
    let found: Vec<(String, usize)> = merged["scenes"].as_array().unwrap().iter().map(found).collect();
    assert_eq!(found, [("scene".to_owned(), 1), ("scene-2".to_owned(), 1)]);
    assert_eq!(names(&path("out/images")), ["scene", "scene-2"]);

    // Another corner makes another job, and so do other shaders and references.
    let missing = |more: &[&str]| with(&[&["--status"], more].concat()).succeeds().out.matches("\tmissing\t").count();
    assert_eq!(missing(&[]), 0);
    triangle(&path("far"), 0.25);
    assert_eq!(missing(&[]), 1);
    with(&["--merge"]).fails(1, "1 of 2 jobs are missing");
    std::fs::create_dir_all(path("shaders/base")).unwrap();
    let shaders = path("shaders").to_str().unwrap().to_owned();
    let folder = ["--shaders", &shaders];
    assert_eq!(missing(&folder), 1, "nothing is in there yet");
    std::fs::write(path("shaders/base/mine.wgsl"), "const MINE: u32 = 1u;\n").unwrap();
    assert_eq!([missing(&folder), missing(&["--keep-all"]), missing(&["--reference-share", "0.5"])], [2, 2, 2]);
}

#[test]
fn what_cannot_be_compared_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let with = |args: &[&str]| aquifer(&["compare"].iter().chain(args).chain(&["-o", out]).copied().collect::<Vec<&str>>());
    with(&["light_sampling", "path_tracer", "--scene", "cornell"]).fails(1, "only like is compared with like");
    with(&["restir_di", "--scene", "cornell", "--sweep", "spatail.taps=1"]).fails(1, "did you mean `spatial`?");
    with(&["restir_di", "--scene", "cornell", "--sweep", "spatial.tops=1"]).fails(1, "taps");
    with(&["restir_di", "--scene", "cornell", "--budget", "0"]).fails(2, "milliseconds above 0");
    with(&["restir_di", "--scene", "nowhere"]).fails(1, "there is no scene `nowhere`");
    let run = aquifer(&["compare", "restir_di", "--scene", "cornell", "-o", "/proc/nowhere"]);
    run.fails(1, "cannot make `/proc/nowhere");
}

#[test]
fn words_tell_who_is_biased() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let run = aquifer(&[
        "compare",
        "light_sampling",
        "--scene",
        "cornell",
        "--size",
        "32x18",
        "--warm-up",
        "0",
        "--seeds",
        "4",
        "--budget",
        "20",
        "--reference-samples",
        "512",
        "--cache",
        &path("cache"),
        "-o",
        &path("out"),
    ]);
    let found = run.succeeds().out;
    assert!(found.contains("`light_sampling`, mean against the reference: cornell"), "{found}");
}
