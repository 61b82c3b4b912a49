//! Whatever the bytes of a film: an error that says something, or a film whose planes have its size. For the fuzzer and for tests without one.

use aquifer_lab::film::Film;
use std::fs;

/// Films, also those of the cache of references: whether the bytes are one.
pub fn is_whole(bytes: &[u8]) -> bool {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("film.exr");
    fs::write(&path, bytes).expect("the file can be written");
    match Film::read(&path) {
        Ok(film) => {
            let all = film.size[0] as usize * film.size[1] as usize;
            let three = [Some(&film.color), film.variance.as_ref(), film.albedo.as_ref(), film.normal.as_ref()];
            let found = three.into_iter().flatten().map(Vec::len).chain(film.depth.as_ref().map(Vec::len));
            assert!(found.into_iter().all(|pixels| pixels == all), "a plane has another size");
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}
