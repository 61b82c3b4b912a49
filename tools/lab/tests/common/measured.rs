//! Whatever the bytes of what a comparison has measured: whole, or counted as missing. For the fuzzer and for tests without one.

use aquifer_lab::compare::store::Store;
use std::fs;

/// What a comparison has measured: whether the bytes are what was settled, or a round with one film, `film.exr`, of the bytes `film`; all else counts as
/// missing.
pub fn is_whole(bytes: &[u8]) -> bool {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, bytes) in [("settled.json", bytes), ("round-0000.json", bytes), ("film.exr", b"film")] {
        fs::write(folder.path().join(name), bytes).expect("the file can be written");
    }
    let store = Store::open(folder.path().to_owned()).expect("the folder is there");
    let (settled, round) = (store.settled(), store.round(0));
    if let (Some(settled), Some(round)) = (&settled, &round) {
        round.fits(settled);
    }
    settled.is_some() || round.is_some()
}
