//! What a session can be asked for.

use super::{build::Built, scale::Choice, truth::News};
use crate::Recipe;

/// Where the picture is taken from.
#[derive(Clone, Debug, PartialEq)]
pub enum Camera {
    /// A camera of the scene; `None` is the first.
    Named(Option<String>),
    /// Anywhere.
    Free(aquifer_scene::Camera),
}

/// What is rendered: both sides render the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Where the camera stands, counted from `origin`.
    pub camera: aquifer_scene::Camera,
    /// In the scene's own world, see [`aquifer_scene::Moment::origin`].
    pub origin: glam::DVec3,
    /// Name of the scene's camera that stands there.
    pub name: Option<String>,
    /// Seconds into the animation.
    pub time: f32,
}

/// A resource to look at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Watch {
    /// `node.port`
    pub resource: String,
    /// Which number of its elements, where they are records.
    pub member: Option<String>,
}

/// What a session can be asked for.
pub enum Message {
    /// Another graph, or other settings, on a side; a second side is opened by the number after the last.
    Recipe(usize, Recipe),
    /// The second graph goes.
    Close,
    /// Looks from elsewhere.
    Camera(Camera),
    /// Seconds into the animation.
    Time(f32),
    /// Time goes by.
    Play(bool),
    /// Renders one update more, while nothing else moves.
    Step,
    /// Rendering stands still.
    Hold(bool),
    /// Frames are averaged while nothing moves.
    Average(bool),
    /// Who chooses the resolution.
    Scale(Choice),
    /// Looks at a resource of a side, or at none.
    Watch(usize, Option<Watch>),
    /// Tells what the reservoirs of a pixel hold, or of none: (x, y) as shares of the picture.
    Inspect(Option<[f32; 2]>),
    /// Makes the reference better, up to so many samples a pixel; 0: only what the cache has.
    Truth(u64),
    /// FLIP is wanted too.
    Flip(bool),
    /// Ends.
    End,
}

/// What reaches the thread of a session.
pub(super) enum Inbox {
    /// From whoever holds the session.
    Asked(Message),
    /// A graph was made, or not.
    Built(Box<Built>),
    /// The reference's maker has news.
    News(News),
}
