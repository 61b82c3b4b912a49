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
