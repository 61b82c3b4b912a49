//! What a comparison has measured so far, on disk: films and times, never errors.
//!
//! Errors are computed from films at the end, against whatever reference there is then. So a comparison that was interrupted continues with
//! the first round that is missing, and its errors are those of an uninterrupted run to the last bit. A round counts when its own file is
//! there and every film in it has the hash noted; that file is written last.

use super::{budget::Offer, error::CompareError};
use crate::{
    atomic,
    film::{Film, Packing},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// The folder of one scene of one comparison.
pub struct Store {
    folder: PathBuf,
}

/// What each graph runs, settled before the first round.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Settled {
    /// Milliseconds of one frame of each graph as written.
    pub frame_ms: Vec<f64>,
    /// What is measured in every round, in this order.
    pub cells: Vec<SettledCell>,
}

/// A graph at one budget.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SettledCell {
    /// Index of the graph.
    pub graph: usize,
    /// Milliseconds aimed at, and the graph that they are the frame time of.
    pub budget: Option<(f64, Option<usize>)>,
    /// One or two ways to meet the budget.
    pub offers: Vec<Offer>,
}

/// One seed of every cell.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// By cell, by offer.
    pub runs: Vec<Vec<Run>>,
    /// Seconds of rendering.
    pub seconds: f64,
    /// Seconds of everything else.
    pub lab_seconds: f64,
}

/// One run of one graph with one seed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// In order of time: one in the protocol of the frame, several in the others.
    pub takes: Vec<Take>,
    /// Median milliseconds of each pass over the frames that counted; `None` where the clock ran backwards in all of them.
    pub passes: Vec<Option<f64>>,
}

/// A film with its cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Take {
    /// Number of frames averaged, or of the frame.
    pub frame: u32,
    /// Milliseconds of all that made it.
    pub ms: f64,
    /// The film's file.
    pub film: String,
    /// Of the file.
    pub hash: String,
}

impl Settled {
    /// Can these be cells of so many graphs?
    pub fn fits(&self, graphs: usize) -> bool {
        let budgets = |cell: &SettledCell| cell.budget.is_none_or(|(ms, of)| ms > 0.0 && of.is_none_or(|of| of < graphs));
        !self.cells.is_empty() && self.cells.iter().all(|cell| cell.graph < graphs && !cell.offers.is_empty() && budgets(cell))
    }
}

impl Round {
    /// Holds what was settled, no more and no less.
    pub fn fits(&self, settled: &Settled) -> bool {
        let runs =
            |(runs, cell): (&Vec<Run>, &SettledCell)| runs.len() == cell.offers.len() && runs.iter().all(|run| !run.takes.is_empty());
        self.runs.len() == settled.cells.len() && self.runs.iter().zip(&settled.cells).all(runs)
    }
}

const SETTLED: &str = "settled.json";

impl Store {
    /// Opens or makes the folder.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn open(folder: PathBuf) -> Result<Self, CompareError> {
        fs::create_dir_all(&folder).map_err(|source| CompareError::Io { path: folder.clone(), source })?;
        Ok(Self { folder })
    }

    /// What was settled, if anything was.
    pub fn settled(&self) -> Option<Settled> {
        self.json(SETTLED)
    }

    /// Settles what every round measures.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn settle(&self, settled: &Settled) -> Result<(), CompareError> {
        self.write_json(SETTLED, settled)
    }

    /// A round, if it is there and whole.
    pub fn round(&self, number: u32) -> Option<Round> {
        let round: Round = self.json(&round_name(number))?;
        let takes = round.runs.iter().flatten().flat_map(|run| &run.takes);
        let is_here = |take: &Take| Path::new(&take.film).file_name().is_some_and(|name| name == take.film.as_str());
        let as_kept = |take: &Take| fs::read(self.folder.join(&take.film)).is_ok_and(|bytes| short(blake3::hash(&bytes)) == take.hash);
        let whole = takes.into_iter().all(|take| is_here(take) && as_kept(take));
        whole.then_some(round)
    }

    /// Keeps a round; its films are kept already.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn keep_round(&self, number: u32, round: &Round) -> Result<(), CompareError> {
        self.write_json(&round_name(number), round)
    }

    /// Keeps a film: (name, hash).
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn keep_film(&self, name: String, film: &Film) -> Result<(String, String), CompareError> {
        let hash = film.write_hashed(&self.folder.join(&name), Packing::Plain)?;
        Ok((name, short(hash)))
    }

    /// The film of a take.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn film(&self, take: &Take) -> Result<Film, CompareError> {
        Ok(Film::read(&self.folder.join(&take.film))?)
    }

    fn json<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        serde_json::from_slice(&fs::read(self.folder.join(name)).ok()?).ok()
    }

    fn write_json(&self, name: &str, value: &impl Serialize) -> Result<(), CompareError> {
        let text = serde_json::to_vec_pretty(value).expect("plain data");
        Ok(atomic::write(&self.folder.join(name), &text)?)
    }
}

fn round_name(number: u32) -> String {
    format!("round-{number:04}.json")
}

fn short(hash: blake3::Hash) -> String {
    hash.to_hex()[..32].to_owned()
}

/// Makes a folder that may be there.
///
/// # Errors
/// When it cannot be made.
pub fn make_folder(path: &Path) -> Result<(), CompareError> {
    match fs::create_dir_all(path) {
        Err(source) if source.kind() != io::ErrorKind::AlreadyExists => Err(CompareError::Io { path: path.to_owned(), source }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_with_a_damaged_film_is_missing() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path().join("s")).unwrap();
        let film = Film::new([2, 1], vec![[0.5; 3]; 2]).unwrap();
        let (film, hash) = store.keep_film("a.exr".into(), &film).unwrap();
        let take = Take { frame: 1, ms: 2.0, film, hash };
        let round = Round { runs: vec![vec![Run { takes: vec![take.clone()], passes: vec![Some(2.0)] }]], ..Round::default() };
        assert_eq!(store.round(0), None);
        store.keep_round(0, &round).unwrap();
        assert_eq!(store.round(0).as_ref(), Some(&round));
        assert_eq!(store.film(&take).unwrap().color, [[0.5; 3]; 2]);
        let cell = |graph| SettledCell { graph, budget: None, offers: vec![Offer { knob: None, frames: 1 }] };
        let settled = |cells: Vec<SettledCell>| Settled { cells, ..Settled::default() };
        assert!(
            round.fits(&settled(vec![cell(0)]))
                && !round.fits(&settled(vec![cell(0), cell(1)]))
                && !Round::default().fits(&settled(vec![cell(0)]))
        );
        assert!(settled(vec![cell(1)]).fits(2) && !settled(vec![cell(2)]).fits(2) && !settled(vec![]).fits(2));
        for elsewhere in ["../s/a.exr", "./a.exr", "..", ""] {
            let mut round = round.clone();
            round.runs[0][0].takes[0].film = elsewhere.into();
            store.keep_round(1, &round).unwrap();
            assert_eq!(store.round(1), None, "`{elsewhere}` is no film of this folder");
        }
        let path = folder.path().join("s/a.exr");
        let mut bytes = fs::read(&path).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(&path, bytes).unwrap();
        assert_eq!(store.round(0), None);
    }
}
