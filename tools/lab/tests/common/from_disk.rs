//! Files that the lab reads again, whatever their bytes: an error that says something, or something whole. For the fuzzer and for tests without one.

use aquifer_lab::{
    compare::{report::Report, store::Store},
    film::Film,
    page,
};
use std::fs;

/// Films, also those of the cache of references: whether the bytes are one.
pub fn film(bytes: &[u8]) -> bool {
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

/// `report.json`: whether a page could be made of it.
pub fn report(bytes: &[u8]) -> bool {
    let Ok(report) = serde_json::from_slice::<Report>(bytes) else { return false };
    let folder = tempfile::tempdir().expect("a temporary folder");
    match page::html(&report, folder.path()) {
        Ok(html) => {
            assert!(html.trim_end().ends_with("</html>"));
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// What a comparison has measured: whether the bytes are what was settled, or a round with one film, `film.exr`, of the bytes `film`; all else counts as
/// missing.
pub fn measured(bytes: &[u8]) -> bool {
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
