//! What a comparison has measured, from disk: whole, or counted as missing.

#![no_main]

use aquifer_lab::compare::store::Store;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for name in ["settled.json", "round-0000.json"] {
        std::fs::write(folder.path().join(name), bytes).expect("the file can be written");
    }
    let store = Store::open(folder.path().to_owned()).expect("the folder is there");
    let settled = store.settled();
    if let (Some(settled), Some(round)) = (settled, store.round(0)) {
        round.fits(&settled);
    }
});
