//! What a case is.

use aquifer_scene::Scene;

/// Something hard to render.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// As the command line names it.
    pub name: &'static str,
    /// What is hard about it.
    pub about: &'static str,
    /// Not finished yet.
    pub scene: fn() -> Scene,
    /// Another scene that must look the same; `None` is the case's own.
    pub truth: Option<fn() -> Scene>,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Parameters, by name, that every pass which has them gets.
    pub turned: &'static [(&'static str, Turned)],
    /// What is looked at.
    pub looks: Looks,
    /// Graphs that do not pass.
    pub known: &'static [Known],
}

/// Where a parameter is turned to; it stays in its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turned {
    /// The least that its range allows.
    Least,
    /// The most.
    Most,
    /// A value, or the nearest to it that the range allows.
    To(f64),
}

/// Which frames are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Looks {
    /// Nothing moves: frames with much history must be right, and show what those with little do.
    Still,
    /// A second passes from frame to frame. The frames after the change, the first of them that of the change; the last must be right.
    After(&'static [u32]),
    /// One frame, whose numbers must be finite; or the adapter's limit that forbids it is told.
    Once,
    /// The scene is not taken, in these words.
    Refused(&'static str),
}

impl Looks {
    /// Frames with little history, and with much.
    const STILL: [u32; 8] = [1, 2, 3, 4, 9, 10, 11, 12];

    /// Numbers of the frames.
    pub fn frames(self) -> &'static [u32] {
        match self {
            Looks::Still => &Self::STILL,
            Looks::After(frames) => frames,
            Looks::Once => &[0],
            Looks::Refused(_) => &[],
        }
    }

    /// How many frames, the last ones, are judged together.
    pub fn judged(self) -> usize {
        if self == Looks::Still { Self::STILL.len() / 2 } else { 1 }
    }

    /// Seconds from frame to frame.
    pub fn step(self) -> f32 {
        if matches!(self, Looks::After(_)) { 1.0 } else { 0.0 }
    }
}

/// A graph that does not pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Known {
    /// The graph.
    pub graph: &'static str,
    /// Why.
    pub why: &'static str,
}

impl Case {
    /// The size of most cases.
    pub const SMALL: [u32; 2] = [32, 18];

    /// A still case of a scene.
    pub const fn still(name: &'static str, about: &'static str, scene: fn() -> Scene) -> Self {
        Case { name, about, scene, truth: None, size: Self::SMALL, turned: &[], looks: Looks::Still, known: &[] }
    }

    /// How many times as many samples of a pixel are affordable, and needed, as in a case of the usual size.
    pub fn scarcity(&self) -> u64 {
        let pixels = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
        (pixels(Self::SMALL) / pixels(self.size)).clamp(1, 16)
    }

    /// Why the graph is known not to pass.
    pub fn known(&self, graph: &str) -> Option<&'static str> {
        self.known.iter().find(|known| known.graph == graph).map(|known| known.why)
    }
}
