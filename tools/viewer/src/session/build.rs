//! Makes a graph ready in a thread of its own, so that pictures go on meanwhile.

use super::live::Live;
use crate::{Opening, Recipe, opening::LoadGraph};
use aquifer_graph::{Faults, Graph, PlanError, Source};
use aquifer_lab::{
    capture::{Capture, running_means},
    stage::{self, StageError},
};
use aquifer_render::{Context, Registry, Renderer, RendererOptions, SceneGlobals, View};
use aquifer_scene::{Features, Scene};
use std::{
    path::PathBuf,
    sync::{Arc, OnceLock},
};

/// What every graph of a session is made with.
#[derive(Clone)]
pub struct Workshop {
    pub context: Context,
    pub scene: Arc<Scene>,
    /// The scene's, and a camera that moves: people move it.
    pub features: Features,
    pub registry: Arc<Registry>,
    /// [`Workshop::registry`] with witnesses, once it was needed.
    pub witnessing: Arc<OnceLock<Arc<Registry>>>,
    pub shaders: Vec<PathBuf>,
    pub load: LoadGraph,
    pub seed: u64,
}

/// A wish for a graph.
#[derive(Clone)]
pub struct Order {
    pub side: usize,
    pub recipe: Recipe,
    pub size: [u32; 2],
    /// Resources to keep readable, beside the frame's radiance.
    pub keep: Vec<String>,
    /// Keeps every reservoir readable, with what passes tell of it.
    pub reservoirs: bool,
}

/// What became of an order.
pub struct Built {
    pub order: Order,
    pub outcome: Result<Live, Refused>,
}

/// Why an order came to nothing.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// The graph's texts are faulty, or its shaders.
    #[error("{0}")]
    Graph(Box<Faults>),
    /// It cannot run.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Its shaders cannot be read.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The device refuses it.
    #[error(transparent)]
    Render(#[from] aquifer_render::Error),
    /// Making it panicked.
    #[error("{0}")]
    Panic(String),
}

impl From<Faults> for Refused {
    fn from(faults: Faults) -> Self {
        Self::Graph(Box::new(faults))
    }
}

impl Refused {
    /// Files that the fault may be cured in.
    pub fn files(&self) -> Vec<PathBuf> {
        match self {
            Self::Graph(faults) => files_of(faults.sources.iter()),
            _ => Vec::new(),
        }
    }
}

/// What a recipe lays over its graph.
fn edits(recipe: &Recipe) -> impl Iterator<Item = Source> {
    recipe.settings.iter().map(|(key, value)| Source::new("viewer", format!("{key}={value}")))
}

/// Those of the texts that are files.
pub fn files_of<'a>(sources: impl Iterator<Item = &'a Source>) -> Vec<PathBuf> {
    sources.map(|source| PathBuf::from(&source.name)).filter(|path| path.is_file()).collect()
}

impl Workshop {
    /// Opens the device for a scene.
    ///
    /// # Errors
    /// Words, where there is no device or a folder of shaders cannot be read.
    pub fn open(opening: &Opening, scene: Arc<Scene>, context: Context) -> Result<Self, String> {
        let features = Features { moving_camera: true, ..Features::of(&scene) };
        let registry = Arc::new(stage::registry_keeping(&scene, &features, &opening.shaders).map_err(|error| error.to_string())?);
        let (load, shaders) = (opening.load_graph.clone(), opening.shaders.clone());
        Ok(Self { context, scene, features, registry, witnessing: Arc::default(), shaders, load, seed: opening.seed })
    }

    /// Reads the shaders anew.
    ///
    /// # Errors
    /// Words; everything then stays as it was.
    pub fn reload(&mut self) -> Result<(), String> {
        self.registry = Arc::new(stage::registry_keeping(&self.scene, &self.features, &self.shaders).map_err(|error| error.to_string())?);
        self.witnessing = Arc::default();
        Ok(())
    }

    /// The registry that a graph runs with.
    fn runs_with(&self, witnesses: bool) -> Result<Arc<Registry>, StageError> {
        if !witnesses {
            return Ok(self.registry.clone());
        }
        if let Some(known) = self.witnessing.get() {
            return Ok(known.clone());
        }
        let made = Arc::new(stage::witnessing(&self.scene, &self.features, &self.shaders)?);
        Ok(self.witnessing.get_or_init(|| made).clone())
    }

    /// A recipe's graph.
    pub fn checked(&self, recipe: &Recipe) -> Result<Graph, Faults> {
        Graph::check_with((self.load)(&recipe.graph)?, edits(recipe), &*self.registry)
    }

    /// Checks, compiles and renders until nothing is compiled late.
    pub fn make(&self, order: &Order) -> Result<Live, Refused> {
        let written = (self.load)(&order.recipe.graph)?;
        let graph = self.checked(&order.recipe)?;
        let bare = Graph::check(&written, &*self.registry).unwrap_or_else(|_| graph.clone());
        // The mean over frames is the session's: it begins anew when the camera moves, and histories do not.
        let unwired = running_means(&graph).into_iter().map(|(pass, input)| Source::new("viewer", format!("pass.{pass}.in.{input}=false")));
        let registry = self.runs_with(order.reservoirs)?;
        let running = Graph::check_with(written, edits(&order.recipe).chain(unwired), &*registry)?;
        let capture = Capture::of(&running);
        let plan =
            running.plan(&*registry, &self.kept(&running, &registry, &capture, order).iter().map(String::as_str).collect::<Vec<_>>())?;
        let globals = SceneGlobals::keeping(&self.context, self.scene.clone(), View::default(), &self.features)?;
        let options = RendererOptions { size: order.size, seed: self.seed, ..RendererOptions::default() };
        let mut renderer = Renderer::new(&self.context, &registry, plan, Box::new(globals), options)?;
        // Drivers compile in the first frame, and the first is not timed.
        for _ in 0..2 {
            renderer.frame()?;
        }
        renderer.finish()?;
        renderer.restart()?;
        Ok(Live::new([graph, bare, running], registry, capture, renderer))
    }

    fn kept(&self, running: &Graph, registry: &Registry, capture: &Capture, order: &Order) -> Vec<String> {
        let exists = |name: &&String| running.plan(registry, &[name]).is_ok();
        let mut keep = vec![running.port_name(capture.frame_port(running))];
        keep.extend(order.keep.iter().filter(exists).cloned());
        if order.reservoirs {
            keep.extend(super::live::reservoirs(running).into_iter().filter(|name| exists(&name)));
        }
        keep
    }
}
