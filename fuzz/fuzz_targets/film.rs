//! Films as EXR files, also those of the cache of references: an error, or a film whose planes have its size.

#![no_main]

use aquifer_lab::film::Film;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("film.exr");
    std::fs::write(&path, bytes).expect("the file can be written");
    match Film::read(&path) {
        Ok(film) => film.check().expect("what was read is whole"),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
