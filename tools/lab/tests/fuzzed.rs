//! Files that fuzzing starts from or has found (`tools/fuzz.sh film`, `report`, `measured`), read without a fuzzer.

#[path = "common/film.rs"]
mod film;
#[path = "common/measured.rs"]
mod measured;
#[path = "common/report.rs"]
mod report;

use std::path::{Path, PathBuf};

/// Those that a name was given to are whole; the fuzzer calls its own by hashes, and they may be refused.
fn every_file(target: &str, is_whole: fn(&[u8]) -> bool) {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus")).join(target);
    let files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let named = |file: &Path| file.extension().is_some();
    assert!(files.iter().any(|file| named(file)), "{target}: nothing to start from");
    for file in files {
        let whole = is_whole(&std::fs::read(&file).unwrap());
        assert!(whole || !named(&file), "{}: only files that the fuzzer named may be refused", file.display());
    }
}

#[test]
fn films_are_refused_or_whole() {
    every_file("film", film::is_whole);
}

#[test]
fn reports_are_refused_or_make_a_page() {
    every_file("report", report::is_whole);
}

#[test]
fn measurements_are_missing_or_whole() {
    every_file("measured", measured::is_whole);
}
