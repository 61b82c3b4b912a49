//! Films as EXR files, also those of the cache of references: an error, or a film whose planes have its size.

#![no_main]

#[path = "../../tools/lab/tests/common/film.rs"]
mod film;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    film::is_whole(bytes);
});
