//! What a graph runs on a scene, what it does without, because of which fact, and what that saves.
//!
//! Nothing is worked out here: passes and ports come from the plan, arrays from the scene's upload, pieces of shaders from the composer. What is
//! saved is measured by switching everything back on.

use crate::{
    bench::turns::{Contestant, Middle, turns},
    stage::{StageError, registry_keeping},
};
use aquifer_graph::{Document, Faults, Graph, LeftOut, PlanError};
use aquifer_render::{Context, Registry, Renderer, RendererOptions, ResourceMemory, SceneGlobals, View};
use aquifer_scene::{Features, Scene};
use aquifer_shader::{Cut, Piece};
use serde::Serialize;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
    sync::Arc,
};

/// What is to be explained.
pub struct Request<'a> {
    /// The device.
    pub context: &'a Context,
    /// Finished.
    pub scene: &'a Arc<Scene>,
    /// The graph.
    pub document: &'a Document,
    /// Folders of shaders over the built-in ones.
    pub folders: &'a [PathBuf],
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Frames that are timed each way; 0 measures no time.
    pub rounds: u32,
}

/// Why there is no explanation.
#[derive(Debug, thiserror::Error)]
pub enum ExplainError {
    /// The graph is wrong.
    #[error(transparent)]
    Graph(#[from] Faults),
    /// It has no plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The shaders cannot be made ready.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The device refuses.
    #[error(transparent)]
    Render(#[from] aquifer_render::Error),
    /// A pass has no shader.
    #[error(transparent)]
    Contract(#[from] aquifer_graph::ContractError),
}

/// What runs, what does not, and what that saves.
#[derive(Clone, Debug, Serialize)]
pub struct Explanation {
    /// Title of the graph.
    pub graph: String,
    /// The device.
    pub adapter: String,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// What holds of the scene.
    pub facts: BTreeSet<&'static str>,
    /// Passes in order.
    pub runs: Vec<String>,
    /// Passes and ports of passes.
    pub left_out: Vec<Missing>,
    /// Arrays of the scene.
    pub arrays: Vec<Missing>,
    /// Pieces of shaders.
    pub pieces: Vec<CutPiece>,
    /// Bytes on the device.
    pub bytes: Ways<u64>,
    /// Milliseconds of a frame.
    pub frame_ms: Option<Ways<Middle>>,
    /// Time with everything kept over time as needed, frame by frame in turns.
    pub slowdown: Option<Middle>,
}

/// As the scene needs it, and with everything kept.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ways<T> {
    /// What the scene needs.
    pub needed: T,
    /// Everything.
    pub all: T,
}

/// Something that is not there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Missing {
    /// `pass`, `pass.port` or `module::array`.
    pub name: String,
    /// In words, or the fact that the scene lacks.
    pub because: String,
    /// What it takes when it is kept: `pass`, `port`, `history` or `array`.
    pub what: &'static str,
    /// Bytes that it takes then.
    pub bytes: u64,
}

/// A piece of a module that was not compiled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CutPiece {
    /// `module.wgsl:line`.
    pub place: String,
    /// What its `@if` asks for.
    pub condition: String,
    /// `import`, `binding NAME`, `function NAME` or `branch`.
    pub piece: String,
    /// Passes whose shaders do without it.
    pub passes: BTreeSet<String>,
}

/// Renders both ways and tells them apart.
///
/// # Errors
/// See [`ExplainError`].
pub fn explain(request: &Request<'_>) -> Result<Explanation, ExplainError> {
    let facts = Features::of(request.scene);
    let (mut needed, mut all) = (Side::new(request, &facts)?, Side::new(request, &Features::ALL)?);
    let plan = needed.renderer.plan().clone();
    let times = needed.against(&mut all, request.rounds)?;
    let middle = |way: usize| times.as_ref().and_then(|times| Middle::of(times[way].iter().map(|seconds| 1e3 * seconds)));
    let ratio = |times: &Vec<Vec<f64>>| Middle::of(times[0].iter().zip(&times[1]).map(|(needed, all)| all / needed));
    Ok(Explanation {
        graph: plan.title.clone(),
        adapter: request.context.adapter().name.clone(),
        size: request.size,
        facts: facts.names(),
        runs: plan.steps.iter().map(|step| step.node.clone()).collect(),
        left_out: plan.left_out.iter().map(|left| all.missing(left)).collect(),
        arrays: needed.left_out.iter().map(|(name, fact)| all.array(name, fact)).collect(),
        pieces: pieces(&needed)?,
        bytes: Ways { needed: needed.bytes(), all: all.bytes() },
        frame_ms: middle(0).zip(middle(1)).map(|(needed, all)| Ways { needed, all }),
        slowdown: times.as_ref().and_then(ratio),
    })
}

/// The graph on the device, one way.
struct Side {
    registry: Registry,
    renderer: Renderer,
    /// Bytes by name.
    arrays: BTreeMap<&'static str, u64>,
    left_out: Vec<(&'static str, &'static str)>,
}

impl Side {
    fn new(request: &Request<'_>, features: &Features) -> Result<Side, ExplainError> {
        let registry = registry_keeping(request.scene, features, request.folders)?;
        let graph = Graph::check(request.document, &registry)?;
        let plan = graph.plan(&registry, &[])?;
        let globals = SceneGlobals::keeping(request.context, request.scene.clone(), View::default(), features)?;
        let (arrays, left_out) = (globals.arrays().collect(), globals.left_out().collect());
        let options = RendererOptions { size: request.size, ..RendererOptions::default() };
        let renderer = Renderer::new(request.context, &registry, plan, Box::new(globals), options)?;
        Ok(Side { registry, renderer, arrays, left_out })
    }

    fn bytes(&self) -> u64 {
        self.renderer.memory().allocated + self.arrays.values().sum::<u64>()
    }

    /// Seconds of each frame, in turns.
    fn against(&mut self, other: &mut Side, rounds: u32) -> Result<Option<Vec<Vec<f64>>>, ExplainError> {
        if rounds == 0 {
            return Ok(None);
        }
        let frame = |side: &mut Side| {
            side.renderer.frame()?;
            side.renderer.finish()
        };
        let mut ways: [Contestant<'_, aquifer_render::Error>; 2] = [Box::new(|| frame(self)), Box::new(|| frame(other))];
        Ok(Some(turns(rounds, &mut ways)?))
    }

    fn resources<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a ResourceMemory> {
        self.renderer
            .memory()
            .resources
            .iter()
            .filter(move |resource| resource.name == name || resource.name.strip_prefix(name).is_some_and(|port| port.starts_with('.')))
    }

    /// What something that this side has takes here.
    fn missing(&self, left: &LeftOut) -> Missing {
        let name = left.port.iter().fold(left.node.clone(), |node, port| format!("{node}.{port}"));
        let history = self.resources(&name).any(|resource| resource.life == "history");
        let what = match &left.port {
            None => "pass",
            Some(_) if history => "history",
            Some(_) => "port",
        };
        let bytes = self.resources(&name).map(|resource| resource.bytes).sum();
        Missing { name, because: left.reason.clone(), what, bytes }
    }

    fn array(&self, name: &str, fact: &str) -> Missing {
        let bytes = self.arrays.get(name).copied().unwrap_or(0);
        Missing { name: name.to_owned(), because: format!("the scene has no {}", fact.replace('_', " ")), what: "array", bytes }
    }
}

/// What the composer left out of each pass, one entry a place.
fn pieces(side: &Side) -> Result<Vec<CutPiece>, ExplainError> {
    let mut found: BTreeMap<(String, usize), CutPiece> = BTreeMap::new();
    for step in &side.renderer.plan().steps {
        for cut in &side.registry.known(&step.kind, &step.slots)?.composed.cuts {
            let piece = found.entry((cut.module.clone(), cut.line)).or_insert_with(|| CutPiece {
                place: format!("{}.wgsl:{}", cut.module, cut.line),
                condition: cut.condition.clone(),
                piece: described(cut),
                passes: BTreeSet::new(),
            });
            piece.passes.insert(step.pass.clone());
        }
    }
    Ok(found.into_values().collect())
}

fn described(cut: &Cut) -> String {
    match &cut.piece {
        Piece::Import => "import".to_owned(),
        Piece::Binding { name, .. } => format!("binding {name}"),
        Piece::Function(name) => format!("function {name}"),
        Piece::Branch => "branch".to_owned(),
    }
}
