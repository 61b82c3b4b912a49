//! What made a film.

use std::fmt;

/// What made a film, enough to repeat it.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// Samples averaged in every pixel.
    pub samples_per_pixel: u32,
    /// Seconds of rendering, set-up left out.
    pub render_seconds: f64,
    /// The graph.
    pub graph: GraphText,
    /// Name of a built-in scene, or a file's name with the hash of its bytes and of the files that it names.
    pub scene: String,
    /// The environment map laid over the scene's own, as `scene`.
    pub environment: Option<String>,
    /// Name of the camera.
    pub camera: String,
    /// Seconds into the scene's animation.
    pub animation_time: f32,
    /// Which light paths the image holds, as a graph file writes it.
    pub transport: String,
    /// Seeds and frames.
    pub runs: Runs,
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Version of Aquifer.
    pub version: String,
}

/// A graph as it was run, overrides included.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GraphText {
    /// The text.
    pub text: String,
    /// Hexadecimal BLAKE3 hash of everything that decides what the graph does.
    pub hash: String,
}

impl GraphText {
    /// A graph that is wholly decided by its text.
    pub fn new(text: impl Into<String>) -> Self {
        let text = text.into();
        let hash = blake3::hash(text.as_bytes()).to_hex().to_string();
        Self { text, hash }
    }
}

/// Consecutive frames of one seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Run {
    /// The seed of the whole render.
    pub seed: u64,
    /// Number of the first frame.
    pub first_frame: u64,
    /// How many frames.
    pub frames: u64,
}

impl Run {
    fn end(&self) -> u64 {
        self.first_frame.saturating_add(self.frames)
    }
}

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "seed {}, frames {}..{}", self.seed, self.first_frame, self.end())
    }
}

/// Frames that are in both of two films: their samples are not independent.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
#[error("both hold frames of {first} and {second}")]
pub struct Overlap {
    /// Of one film.
    pub first: Run,
    /// Of the other.
    pub second: Run,
}

/// Runs in order of seed and frame, none overlapping, neighbours joined.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Runs(Vec<Run>);

impl Runs {
    /// One run.
    pub fn one(seed: u64, first_frame: u64, frames: u64) -> Self {
        Self(vec![Run { seed, first_frame, frames }])
    }

    /// Sorts and joins `runs`.
    pub fn new(mut runs: Vec<Run>) -> Result<Self, Overlap> {
        runs.sort();
        let mut joined: Vec<Run> = Vec::with_capacity(runs.len());
        for run in runs {
            match joined.last_mut().filter(|last| last.seed == run.seed && run.first_frame <= last.end()) {
                Some(last) if run.first_frame < last.end() => return Err(Overlap { first: *last, second: run }),
                Some(last) => last.frames += run.frames,
                None => joined.push(run),
            }
        }
        Ok(Self(joined))
    }

    /// Frames of both.
    pub fn union(&self, other: &Self) -> Result<Self, Overlap> {
        Self::new(self.0.iter().chain(&other.0).copied().collect())
    }

    /// How many frames in all.
    pub fn frames(&self) -> u64 {
        self.0.iter().map(|run| run.frames).sum()
    }

    /// In order of seed and frame.
    pub fn iter(&self) -> impl Iterator<Item = &Run> {
        self.0.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_join_and_overlaps_are_refused() {
        let (early, late) = (Runs::one(7, 0, 32), Runs::one(7, 32, 32));
        assert_eq!(late.union(&early), Ok(Runs::one(7, 0, 64)));
        assert!(early.union(&Runs::one(7, 31, 1)).is_err());
        let both = early.union(&Runs::one(8, 0, 32)).unwrap();
        assert_eq!((both.iter().count(), both.frames()), (2, 64));
        assert!(both.union(&Runs::one(8, 16, 64)).is_err());
    }

    #[test]
    fn gaps_stay() {
        let runs = Runs::one(0, 0, 4).union(&Runs::one(0, 8, 4)).unwrap();
        assert_eq!(runs.iter().count(), 2);
        assert_eq!(runs.union(&Runs::one(0, 4, 4)), Ok(Runs::one(0, 0, 12)));
    }
}
