//! `aquifer compare`, ended in the middle: by a signal, by a full disk, by a scene that holds no light.

use crate::{
    compare::{SMALL, errors, report},
    dark_triangle::dark_triangle,
    run::{aquifer, names},
};
use std::{
    path::Path,
    process::{Command, Stdio},
    time::Duration,
};

/// The arguments of a small comparison into a folder with a cache of its own.
fn small(folder: &Path) -> Vec<String> {
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let more = ["-o".into(), path("out"), "--cache".into(), path("cache"), "--seeds".into(), "3".into()];
    SMALL.iter().map(|word| (*word).to_owned()).chain(more).collect()
}

/// Is there a file in the folder, or in one below it, whose name has this in it?
fn holds(folder: &Path, part: &str) -> bool {
    let Ok(entries) = std::fs::read_dir(folder) else { return false };
    entries.filter_map(Result::ok).any(|entry| {
        let path = entry.path();
        if path.is_dir() { holds(&path, part) } else { entry.file_name().to_string_lossy().contains(part) }
    })
}

#[test]
fn ended_at_any_point_it_goes_on_to_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    let words = small(&whole);
    assert_eq!(aquifer(&words.iter().map(String::as_str).collect::<Vec<_>>()).code, 0);
    let mut ended = 0;
    // Budgets settled; a round half done; between rounds; a reference begun.
    for (sign, signal) in [("settled.json", "KILL"), ("0000-1-0", "KILL"), ("round-0001.json", "INT"), ("-1.exr", "KILL")] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_aquifer"));
        let mut child = program.args(small(&parts)).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        while !holds(&parts, sign) && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        if child.try_wait().unwrap().is_none() {
            assert!(Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap().success());
            ended += u32::from(!child.wait().unwrap().success());
        }
    }
    assert!(ended >= 3, "only {ended} runs were ended before they were done");
    let words = small(&parts);
    let run = aquifer(&words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(run.code, 0, "{}", run.err);
    let [whole, parts] = [whole, parts].map(|folder| report(&folder.join("out")));
    assert_eq!(errors(&parts), errors(&whole));
    assert_eq!(parts["scenes"][0]["references"][0]["variance"], whole["scenes"][0]["references"][0]["variance"]);
}

/// A limit on the size of files stands for a full disk: writing fails in the middle of a file.
#[test]
#[cfg(unix)]
fn a_full_disk_is_said_and_what_was_measured_stays() {
    let folder = tempfile::tempdir().unwrap();
    let words = small(folder.path());
    let limited = |blocks: &str| {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
        let output = Command::new("sh").args(["-c", &script, "sh", env!("CARGO_BIN_EXE_aquifer")]).args(&words).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    // Films of 16×9 fit into three kilobytes; the reference with its variance does not.
    let (code, err) = limited("6");
    assert_eq!(code, Some(1), "{err}");
    assert!(err.contains("cannot write") && !err.contains("panicked"), "{err}");
    let measured = std::fs::read_dir(folder.path().join("out/measured")).unwrap().next().unwrap().unwrap().path();
    let kept = names(&measured);
    assert!(kept.iter().any(|name| name.ends_with(".exr")), "{kept:?}");
    assert!(kept.iter().all(|name| name.ends_with(".exr") || name.ends_with(".json")), "no half file is left: {kept:?}");
    let run = aquifer(&words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(kept.iter().all(|name| names(&measured).contains(name)));
}

#[test]
fn without_light_relative_errors_are_undefined_and_it_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("dark.gltf");
    std::fs::write(&scene, dark_triangle(0)).unwrap();
    let out = folder.path().join("out");
    let path = |path: &Path| path.to_str().unwrap().to_owned();
    let run = aquifer(&[
        "compare",
        "light_sampling",
        "restir_di",
        "--scene",
        &path(&scene),
        "--size",
        "16x9",
        "--warm-up",
        "2",
        "--seeds",
        "3",
        "--protocol",
        "accumulate",
        "--frames",
        "4",
        "-o",
        &path(&out),
        "--cache",
        &path(&out),
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("the reference holds no light: relative metrics are undefined"), "{}", run.err);
    assert!(run.out.contains("undefined"), "{}", run.out);
    let scene = &report(&out)["scenes"][0];
    assert_eq!(scene["references"][0]["black"], true);
    assert!(scene["cells"].as_array().unwrap().iter().all(|cell| cell["rel_mse"].is_null() && cell["mse"]["median"] == 0.0), "{scene}");
    // The report is read back whole: nothing in it is infinite.
    assert_eq!(aquifer(&["report", &path(&out)]).code, 0);
}
