//! What a session is opened with.

use aquifer_graph::{Document, FsFiles, Layered, Shelf};
use aquifer_viewer::{Loaded, Opening, Recipe};
use std::{path::PathBuf, sync::Arc};

/// These graphs on a scene in code, at the least size.
pub fn opening(graphs: &[&str], scene: &'static str, shaders: Vec<PathBuf>) -> Opening {
    let files = Layered { upper: FsFiles, lower: Shelf::new("built-in", aquifer_graphs::files()) };
    let name = |graph: &str| if graph.ends_with(".toml") { graph.to_owned() } else { format!("{graph}.toml") };
    let load_scene = move || {
        let made = (aquifer_scenes::by_name(scene).unwrap().make)().finish().map_err(|error| error.to_string())?;
        Ok(Loaded { scene: Arc::new(made), content: Arc::new(move || Ok(scene.to_owned())), environment: None })
    };
    Opening {
        graphs: graphs.iter().map(|graph| Recipe::of(*graph)).collect(),
        load_graph: Arc::new(move |graph| Document::load(&name(graph), &files)),
        known_graphs: aquifer_graphs::files().iter().map(|(path, _)| path.trim_end_matches(".toml").to_owned()).collect(),
        load_scene: Box::new(load_scene),
        scene: scene.to_owned(),
        options: Vec::new(),
        shaders,
        adapter: None,
        camera: None,
        size: aquifer_viewer::session::LEAST,
        seed: 0,
        cache: std::env::temp_dir().join("aquifer-viewer-tests"),
        version: "test".to_owned(),
    }
}
