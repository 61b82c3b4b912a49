//! Killed at any moment, on a full disk, without memory: nothing half-written is ever taken for whole.

use crate::{
    films::facts,
    run::{aquifer, names},
};
use aquifer_lab::{film::Film, stats::rng::SplitMix};
use std::{
    path::Path,
    process::{Command, Stdio},
    time::{Duration, Instant},
};

const SIZE: [u32; 2] = [320, 180];

/// Noise, which no compression makes small, of one frame.
fn noise(frame: u64) -> Film {
    let mut rng = SplitMix::new(frame);
    let color = (0..SIZE[0] * SIZE[1]).map(|_| [0, 1, 2].map(|_| rng.normal().abs() as f32)).collect();
    Film { facts: Some(facts(frame, 1)), ..Film::new(SIZE, color).expect("a colour a pixel") }
}

fn merge(folder: &Path) -> Command {
    let at = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let mut command = Command::new(env!("CARGO_BIN_EXE_aquifer"));
    command.args(["merge", &at("a.exr"), &at("b.exr"), "-o", &at("out.exr")]).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// A folder with two films, and what they give when nobody interferes.
fn films() -> (tempfile::TempDir, Vec<u8>, Duration) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, frame) in [("a.exr", 0), ("b.exr", 1)] {
        noise(frame).write(&folder.path().join(name)).expect("the folder can be written");
    }
    let begin = Instant::now();
    assert!(merge(folder.path()).status().expect("it runs").success());
    let took = begin.elapsed();
    let whole = std::fs::read(folder.path().join("out.exr")).expect("it was written");
    (folder, whole, took)
}

#[cfg(unix)]
#[test]
fn killed_at_any_moment_a_file_is_old_or_new() {
    const KILLS: u64 = 60;
    let (folder, whole, took) = films();
    let out = folder.path().join("out.exr");
    let old = b"what was there before".to_vec();
    let [mut left_old, mut left_new] = [0, 0];
    // Every other kill is around the moment of the rename, which is found as it goes: a program takes longer or less long as other work comes and
    // goes. The rest are at any moment before.
    let mut end = took;
    let mut rng = SplitMix::new(0);
    for kill in 0..KILLS {
        std::fs::write(&out, &old).expect("a file");
        let near = kill % 2 == 0;
        let mut child = merge(folder.path()).spawn().expect("it runs");
        std::thread::sleep(if near { end } else { end.mul_f64(rng.uniform()) });
        child.kill().expect("SIGKILL reaches a child");
        child.wait().expect("it ends");
        let is_new = match std::fs::read(&out).expect("there is always a file") {
            bytes if bytes == old => false,
            bytes if bytes == whole => true,
            bytes => panic!("kill {kill} left {} bytes that are neither old nor new", bytes.len()),
        };
        *if is_new { &mut left_new } else { &mut left_old } += 1;
        if near {
            end = end.mul_f64(if is_new { 0.8 } else { 1.25 });
        }
    }
    let mut files = names(folder.path());
    files.retain(|name| !name.starts_with(".aquifer-"));
    assert_eq!(files, ["a.exr", "b.exr", "out.exr"], "what is not finished has a name of its own");
    assert!(left_old >= 5 && left_new >= 5, "the kills missed the writing: {left_old} old, {left_new} new");
}

/// A limit of the size of files stands in for a full disk: writing fails in its midst, with another error number.
#[cfg(unix)]
#[test]
fn a_disk_that_is_full_is_told_and_leaves_nothing() {
    let (folder, whole, _) = films();
    let out = folder.path().join("out.exr");
    std::fs::remove_file(&out).expect("it was written");
    let blocks = whole.len() / 512 / 2;
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" merge a.exr b.exr -o out.exr");
    let output = Command::new("sh").args(["-c", &script, env!("CARGO_BIN_EXE_aquifer")]).current_dir(folder.path()).output();
    let output = output.expect("there is a shell");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot write `out.exr`"), "{message}");
    assert_eq!(names(folder.path()), ["a.exr", "b.exr"]);
}

#[test]
fn a_size_beyond_the_adapter_is_told_before_anything_is_written() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out.exr").to_string_lossy().into_owned();
    if aquifer_render::adapters().is_empty() {
        assert!(std::env::var_os("AQUIFER_REQUIRE_ADAPTER").is_none(), "no adapter was found, and AQUIFER_REQUIRE_ADAPTER is set");
        return;
    }
    // 64 bytes of surface for each of 2^28 pixels: adapters bind 4 GiB at most at once.
    let run = aquifer(&["render", "path_tracer", "--size", "16384x16384", "-o", &out]).fails(1, "max_storage_buffer_binding_size");
    assert!(run.err.contains("needs 17179869184 bytes, but the adapter offers"), "{}", run.err);
    assert!(names(folder.path()).is_empty());
}
