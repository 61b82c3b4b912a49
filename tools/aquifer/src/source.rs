//! What commands are given: graphs, scenes and shaders, by name or by file.

mod content;

use crate::{failure::Failure, ui::Ui, value};
use aquifer_graph::{Document, Faults, FsFiles, Graph, Layered, Shelf, Source, Transport, nearest};
use aquifer_lab::{
    bench::auto,
    stage::{self, StageError},
};
use aquifer_render::{Context, ContextOptions, Registry};
use aquifer_scene::{Environment, Features, Scene};
use aquifer_scenes::Generator;
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

/// A graph, with what is laid over it.
#[derive(Clone, Debug, clap::Args)]
pub struct GraphArgs {
    /// A built-in graph (see `aquifer graphs`) or a .toml file
    pub graph: String,
    /// Set a value of the graph: a parameter (spatial.taps=5) or a slot (slots.mis=pairwise); repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = value::setting)]
    pub settings: Vec<String>,
    /// Which light paths: emission, direct, indirect:N or full:N (N bounces)
    #[arg(long, value_name = "PATHS", value_parser = value::transport)]
    pub transport: Option<Transport>,
    #[command(flatten)]
    pub shaders: ShaderArgs,
}

/// Shaders beside the built-in ones, and how much of them.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct ShaderArgs {
    /// A folder of .wgsl files that add to the built-in shaders or replace them; repeatable
    #[arg(long = "shaders", value_name = "DIR")]
    pub folders: Vec<PathBuf>,
    /// Leave nothing out that the scene does not need (see `aquifer explain`)
    #[arg(long)]
    pub keep_all: bool,
}

/// A scene.
#[derive(Clone, Debug, clap::Args)]
pub struct SceneArgs {
    /// A built-in scene (see `aquifer scenes list`) or a .glb or .gltf file
    #[arg(long, value_name = "SCENE", default_value = "cornell")]
    pub scene: String,
    /// Light from an equirectangular .exr or .hdr file, in place of the scene's own environment
    #[arg(long, value_name = "FILE")]
    pub environment: Option<PathBuf>,
}

/// The device.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct AdapterArgs {
    /// The graphics adapter whose name contains this (see `aquifer adapters`)
    #[arg(long = "adapter", value_name = "NAME")]
    pub name: Option<String>,
}

impl AdapterArgs {
    /// Opens it.
    pub fn open(&self) -> Result<Context, Failure> {
        Ok(Context::new(&ContextOptions { adapter: self.name.clone(), ..ContextOptions::default() })?)
    }
}

impl GraphArgs {
    /// The graph's text with everything laid over it.
    pub fn document(&self) -> Result<Document, Failure> {
        let mut document = self.written()?;
        document.apply(self.edits())?;
        Ok(document)
    }

    /// The same where `slots.trace` is not `auto`; else with the tracer in its place that is faster on this adapter and scene.
    pub fn choosing(&self, context: &Context, scene: &Arc<Scene>) -> Result<Self, Failure> {
        let mut chosen = self.clone();
        if self.leaves_tracer(&self.written()?, &[]) {
            let tracer = auto::fastest(context, scene, &self.shaders.folders, &cache_folder())?;
            chosen.settings.push(auto::choice(&tracer).text);
        }
        Ok(chosen)
    }

    /// Is the tracer to be chosen, after all edits? What is faulty is told elsewhere.
    fn leaves_tracer(&self, written: &Document, edits: &[Source]) -> bool {
        let mut document = written.clone();
        document.apply(self.edits().chain(edits.iter().cloned())).is_ok() && auto::asked(&document)
    }

    /// The graph's text as its files have it.
    fn written(&self) -> Result<Document, Failure> {
        Ok(load_graph(&self.graph)?)
    }

    /// What the command line lays over it.
    fn edits(&self) -> impl Iterator<Item = Source> {
        let transport = self.transport.map(|transport| Source::new("--transport", format!("transport={transport}")));
        transport.into_iter().chain(self.settings.iter().map(|text| Source::new("--set", text)))
    }

    /// The graph with everything laid over it, checked against the shaders that a scene needs.
    pub fn check(&self, scene: Option<&Scene>) -> Result<(Graph, Registry), Failure> {
        self.check_with(scene, [])
    }

    /// As [`GraphArgs::check`], with further settings laid over it. A tracer that is still to be chosen is the default one: no adapter is at hand.
    pub fn check_with(&self, scene: Option<&Scene>, edits: impl IntoIterator<Item = Source>) -> Result<(Graph, Registry), Failure> {
        let registry = self.shaders.registry(scene)?;
        let (written, mut edits) = (self.written()?, edits.into_iter().collect::<Vec<_>>());
        if self.leaves_tracer(&written, &edits) {
            edits.extend(registry.library().default_slots().get("trace").map(|tracer| auto::choice(tracer)));
        }
        let graph = Graph::check_with(written, self.edits().chain(edits), &registry)?;
        Ok((graph, registry))
    }
}

impl ShaderArgs {
    /// Built-in shaders and passes with those of the folders over them, for a scene or for any.
    pub fn registry(&self, scene: Option<&Scene>) -> Result<Registry, Failure> {
        Ok(match scene {
            Some(scene) => stage::registry_keeping(scene, &self.features(scene), &self.folders)?,
            None => stage::registry(None, &self.folders)?,
        })
    }

    /// A text that changes whenever a shader does, or what is left out of them.
    pub fn content(&self) -> Result<String, Failure> {
        let library = stage::library(&self.folders).map_err(StageError::from)?;
        let mut hash = blake3::Hasher::new();
        for path in library.paths() {
            let text = library.text(path).unwrap_or_default();
            hash.update(format!("{path} {}\n{text}", text.len()).as_bytes());
        }
        Ok(format!("{}, keep all {}", &hash.finalize().to_hex()[..32], self.keep_all))
    }

    /// What shaders for this scene are cut to.
    pub fn features(&self, scene: &Scene) -> Features {
        if self.keep_all { Features::ALL } else { Features::of(scene) }
    }
}

impl SceneArgs {
    /// The finished scene. Its warnings are shown.
    pub fn load(&self, ui: &Ui) -> Result<Scene, Failure> {
        let scene = load_scene(&self.scene, self.environment.as_deref())?;
        for warning in &scene.warnings {
            ui.warn(&format!("{}: {warning}", self.scene));
        }
        Ok(scene)
    }

    /// The scene as films name it: a built-in one by its name, a file by its name and the hash of its bytes and of the files that it names.
    pub fn identity(&self) -> Result<String, Failure> {
        if is_file(&self.scene) { identity(Path::new(&self.scene)) } else { Ok(self.scene.clone()) }
    }

    /// A text that changes whenever what the scene holds does.
    pub fn content(&self) -> Result<String, Failure> {
        if is_file(&self.scene) {
            return self.identity();
        }
        let exported = aquifer_scenes::export(&(generator(&self.scene)?.make)())?;
        let mut hash = blake3::Hasher::new();
        hash.update(&exported.glb).update(&exported.environment.unwrap_or_default());
        Ok(format!("{} {}", self.scene, &hash.finalize().to_hex()[..32]))
    }

    /// The environment as films name it.
    pub fn environment_identity(&self) -> Result<Option<String>, Failure> {
        self.environment.as_deref().map(identity).transpose()
    }
}

/// Where a text was read from, when that is a file.
pub fn file_of(source: &Source) -> Option<PathBuf> {
    let path = Path::new(&source.name);
    path.is_file().then(|| path.to_owned())
}

/// Where programs of this user keep what can be made again.
pub fn cache_folder() -> PathBuf {
    let home = || std::env::var_os("HOME").map(|home| PathBuf::from(home).join(".cache"));
    let folder = std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from).filter(|path| path.is_absolute()).or_else(home);
    folder.unwrap_or_else(std::env::temp_dir).join("aquifer")
}

/// A built-in scene by name, or a file; finished.
pub fn load_scene(name: &str, environment: Option<&Path>) -> Result<Scene, Failure> {
    let environment = environment.map(Environment::load).transpose()?;
    if is_file(name) {
        let scene = Scene::load(Path::new(name))?;
        return match environment {
            Some(environment) => Ok(Scene { environment: Some(environment), ..scene }),
            None => Ok(scene),
        };
    }
    let scene = (generator(name)?.make)();
    let environment = environment.or_else(|| scene.environment.clone());
    Ok(Scene { environment, ..scene }.finish()?)
}

/// A built-in scene by name.
pub fn generator(name: &str) -> Result<&'static Generator, Failure> {
    aquifer_scenes::by_name(name).ok_or_else(|| unknown_scene(name))
}

fn unknown_scene(name: &str) -> Failure {
    let known = aquifer_scenes::all().iter().map(|generator| generator.name);
    let cure = match nearest(name, known) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`aquifer scenes list` shows them; files end in .glb or .gltf".to_owned(),
    };
    Failure::new(format!("there is no scene `{name}`; {cure}"))
}

fn is_file(scene: &str) -> bool {
    let extension = Path::new(scene).extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    extension.eq_ignore_ascii_case("glb") || extension.eq_ignore_ascii_case("gltf")
}

/// A file's name and the first half of the BLAKE3 hash of what it holds.
fn identity(path: &Path) -> Result<String, Failure> {
    let hash = content::hash(path).map_err(|error| Failure::new(format!("cannot read `{}`: {error}", path.display())))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Ok(format!("{name} {}", &hash.to_hex()[..32]))
}

/// Every text that the graph was read from: its files, then what the command line laid over them.
pub fn text_of(graph: &Graph) -> String {
    let part = |source: &Source| format!("# {}\n{}\n", source.name, source.text.trim_end());
    graph.sources().iter().map(part).collect::<Vec<_>>().join("\n")
}

/// A graph by its name or file, as its texts have it. A bare name is the built-in graph's, if there is one, whatever files lie about.
pub fn load_graph(graph: &str) -> Result<Document, Faults> {
    if aquifer_graphs::files().iter().any(|(path, _)| path.strip_suffix(".toml") == Some(graph)) {
        return built_in(graph);
    }
    Document::load(&file_name(graph), &files())
}

/// A built-in graph by its name: what references and truths are made with.
pub fn built_in(graph: &str) -> Result<Document, Faults> {
    Document::load(&format!("{graph}.toml"), &Shelf::new("built-in", aquifer_graphs::files()))
}

/// Graph files on disk, over the built-in ones.
pub fn files() -> Layered<FsFiles> {
    Layered { upper: FsFiles, lower: Shelf::new("built-in", aquifer_graphs::files()) }
}

/// `path_tracer` is the built-in file `path_tracer.toml`.
fn file_name(graph: &str) -> String {
    if graph.ends_with(".toml") || graph.contains(std::path::is_separator) { graph.to_owned() } else { format!("{graph}.toml") }
}
