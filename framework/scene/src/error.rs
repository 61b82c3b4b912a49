//! Why a scene cannot be finished or placed.

/// What is wrong with a scene's arrays, or with a question put to them. Places read like Rust: `meshes[2].triangles[7]`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// An index points past the end of what it indexes.
    #[error("{at}: index {index} is out of range, there are {count}")]
    Index {
        /// Where the index stands.
        at: String,
        /// Its value.
        index: u64,
        /// How many things there are.
        count: usize,
    },
    /// Two arrays that belong together have different lengths.
    #[error("{at}: {found} entries where {expected} are needed")]
    Length {
        /// Which array.
        at: String,
        /// Its length.
        found: usize,
        /// The length that fits.
        expected: usize,
    },
    /// A number is NaN or infinite where nothing sensible could replace it.
    #[error("{at}: not a finite number")]
    NotFinite {
        /// Which number.
        at: String,
    },
    /// A finite number lies outside what it may be.
    #[error("{at}: {value} is out of range: {allowed}")]
    OutOfRange {
        /// Which number.
        at: String,
        /// Its value.
        value: f32,
        /// What is allowed, in words.
        allowed: &'static str,
    },
    /// A node comes before its parent.
    #[error("nodes[{node}]: its parent {parent} does not come before it")]
    ParentOrder {
        /// The node.
        node: usize,
        /// Its parent.
        parent: u32,
    },
    /// Key times do not increase.
    #[error("{at}: key times must increase strictly")]
    KeyTimes {
        /// Which channel.
        at: String,
    },
    /// More than a GPU index can count.
    #[error("{at}: {count} is more than {limit}")]
    TooMany {
        /// What there is too much of.
        at: String,
        /// How many.
        count: u64,
        /// The most there may be.
        limit: u64,
    },
    /// No camera of this name.
    #[error("no camera `{name}`; the scene has {}", list(known))]
    UnknownCamera {
        /// As asked.
        name: String,
        /// All there are, for the nearest name.
        known: Vec<String>,
    },
    /// No node holds a camera; [`crate::Scene::finish`] would have added one.
    #[error("the scene has no camera")]
    NoCamera,
    /// The camera's node squashes its viewing direction or its up direction to nothing, or lies beyond all numbers.
    #[error("camera `{name}` has no place or no direction: its node's scale is zero or too large")]
    FlatCamera {
        /// The camera.
        name: String,
    },
    /// The time is NaN or infinite.
    #[error("{0} is no time")]
    Time(f32),
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
