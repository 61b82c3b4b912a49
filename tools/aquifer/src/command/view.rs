//! `aquifer view [A [B]]`

use crate::{
    cli::VERSION,
    failure::Failure,
    source::{AdapterArgs, SceneArgs, ShaderArgs, cache_folder, load_graph, load_scene},
    value,
};
use aquifer_graph::Transport;
use aquifer_viewer::{Loaded, Opening, Recipe};
use std::{path::PathBuf, sync::Arc};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// One graph, or two to compare: built-in ones (see `aquifer graphs`) or .toml files
    #[arg(value_name = "GRAPH", num_args = 0..=2, default_value = "path_tracer")]
    graphs: Vec<String>,
    /// Set a value of the graphs: a parameter (spatial.taps=5) or a slot (slots.mis=pairwise); repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = value::setting)]
    settings: Vec<String>,
    /// Which light paths: emission, direct, indirect:N or full:N (N bounces)
    #[arg(long, value_name = "PATHS", value_parser = value::transport)]
    transport: Option<Transport>,
    #[command(flatten)]
    shaders: ShaderArgs,
    #[command(flatten)]
    scene: SceneArgs,
    /// The scene's camera of this name; without it the first
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Pixels across and down at full scale; the window renders fewer where it must to stay interactive
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = value::size)]
    size: [u32; 2],
    /// Seed of all random numbers
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Folder where references are kept [default: aquifer in the user's cache folder]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
}

pub fn run(args: Args) -> Result<(), Failure> {
    let transport = args.transport.map(|transport| ("transport".to_owned(), format!("\"{transport}\"")));
    let setting = |text: &String| text.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned()));
    let settings: Vec<(String, String)> = transport.into_iter().chain(args.settings.iter().filter_map(setting)).collect();
    let environment = args.scene.environment.as_ref().map(|path| ["--environment".to_owned(), path.display().to_string()]);
    let folders = args.shaders.folders.iter().flat_map(|folder| ["--shaders".to_owned(), folder.display().to_string()]);
    let options = environment.into_iter().flatten().chain(folders).collect();
    let built_in = aquifer_graphs::files().into_iter().map(|(path, _)| path.trim_end_matches(".toml").to_owned());
    let named = args.graphs.iter().filter(|graph| graph.ends_with(".toml")).cloned();
    let opening = Opening {
        graphs: args.graphs.iter().map(|graph| Recipe { graph: graph.clone(), settings: settings.clone() }).collect(),
        load_graph: Arc::new(load_graph),
        known_graphs: named.chain(built_in).collect(),
        scene: args.scene.scene.clone(),
        options,
        shaders: args.shaders.folders,
        adapter: args.adapter.name,
        camera: args.camera,
        size: args.size,
        seed: args.seed,
        cache: args.cache.unwrap_or_else(cache_folder),
        version: VERSION.to_owned(),
        load_scene: Box::new(move || loaded(&args.scene).map_err(|failure| failure.words())),
    };
    aquifer_viewer::run(opening).map_err(|error| Failure::new(error.to_string()))
}

fn loaded(scene: &SceneArgs) -> Result<Loaded, Failure> {
    let loaded = load_scene(&scene.scene, scene.environment.as_deref())?;
    let (environment, scene) = (scene.environment_identity()?, scene.clone());
    let content = move || scene.content().map_err(|failure| failure.words());
    Ok(Loaded { scene: Arc::new(loaded), content: Arc::new(content), environment })
}
