//! What a viewer is opened with: scene, graphs, and where their texts come from.

use aquifer_graph::{Document, Faults};
use aquifer_scene::Scene;
use std::{path::PathBuf, sync::Arc};

/// Reads a graph by its name or file.
pub type LoadGraph = Arc<dyn Fn(&str) -> Result<Document, Faults> + Send + Sync>;

/// Loads the scene; called once, off the window's thread.
pub type LoadScene = Box<dyn FnOnce() -> Result<Loaded, String> + Send>;

/// Tells the content of a scene; may take as long as loading it.
pub type Content = Arc<dyn Fn() -> Result<String, String> + Send + Sync>;

/// A scene with its names.
pub struct Loaded {
    /// Finished.
    pub scene: Arc<Scene>,
    /// Makes a text that changes whenever what the scene holds does: names references.
    pub content: Content,
    /// The environment over the scene's own, as films name it.
    pub environment: Option<String>,
}

/// A graph with what is laid over it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recipe {
    /// A built-in graph or a file.
    pub graph: String,
    /// Settings as `--set` takes them, in the order in which they were made: (key, value).
    pub settings: Vec<(String, String)>,
}

/// What to open.
pub struct Opening {
    /// One graph, or two to compare.
    pub graphs: Vec<Recipe>,
    /// Reads graphs.
    pub load_graph: LoadGraph,
    /// Names to offer for a graph.
    pub known_graphs: Vec<String>,
    /// Loads the scene.
    pub load_scene: LoadScene,
    /// The scene as the command line has it.
    pub scene: String,
    /// Options of the command line that the window does not change, ready to be copied.
    pub options: Vec<String>,
    /// Folders of shaders over the built-in ones.
    pub shaders: Vec<PathBuf>,
    /// Part of the adapter's name.
    pub adapter: Option<String>,
    /// Name of the camera; `None` is the first.
    pub camera: Option<String>,
    /// Pixels at full scale.
    pub size: [u32; 2],
    /// Of all random numbers.
    pub seed: u64,
    /// Where references are kept.
    pub cache: PathBuf,
    /// Of the program, for the films it keeps.
    pub version: String,
}

impl Recipe {
    /// A graph as it is written.
    pub fn of(graph: impl Into<String>) -> Self {
        Self { graph: graph.into(), settings: Vec::new() }
    }

    /// Lays a setting over the graph, in place of an older one of that key; `None` takes it away.
    pub fn set(&mut self, key: &str, value: Option<String>) {
        self.settings.retain(|(known, _)| known != key);
        self.settings.extend(value.map(|value| (key.to_owned(), value)));
    }

    /// What is laid over the graph under that key.
    pub fn setting(&self, key: &str) -> Option<&str> {
        self.settings.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str())
    }
}
