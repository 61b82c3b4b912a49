//! What the tests of this crate share: an opening, and waiting with an end.

use aquifer_graph::{Document, FsFiles, Layered, Shelf};
use aquifer_viewer::{
    Loaded, Opening, Recipe,
    session::{Board, Session},
};
use std::{
    path::PathBuf,
    sync::Arc,
    time::{Duration, Instant},
};

/// Longer than anything takes on a busy machine; only waited for in full when the test fails.
#[allow(dead_code, reason = "not every test waits")]
pub const LONG: Duration = Duration::from_secs(60);

/// Is there an adapter? Where one is required, its absence is a failure.
#[allow(dead_code, reason = "an example has its own way to say so")]
pub fn has_adapter() -> bool {
    let found = !aquifer_render::adapters().is_empty();
    assert!(found || std::env::var_os("AQUIFER_REQUIRE_ADAPTER").is_none(), "no adapter");
    found
}

/// These graphs on a scene in code, at the least size.
pub fn opening(graphs: &[&str], scene: &'static str, shaders: Vec<PathBuf>) -> Opening {
    let files = Layered { upper: FsFiles, lower: Shelf::new("built-in", aquifer_graphs::files()) };
    let name = |graph: &str| if graph.ends_with(".toml") { graph.to_owned() } else { format!("{graph}.toml") };
    let load_scene = move || {
        let scene = (aquifer_scenes::by_name(scene).unwrap().make)().finish().map_err(|error| error.to_string())?;
        Ok(Loaded { scene: Arc::new(scene), content: Arc::new(|| Ok("test".to_owned())), environment: None })
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
    }
}

#[allow(dead_code, reason = "the window is waited for step by step")]
/// Waits until the board is as wanted.
pub fn wait(session: &Session, what: &str, wanted: impl Fn(&Board) -> bool) -> Board {
    let end = Instant::now() + LONG;
    loop {
        let board = session.look();
        if wanted(&board) {
            return board;
        }
        assert!(
            Instant::now() < end,
            "{what}: still waiting; faults {:?}, trouble {:?}",
            board.sides.iter().map(|side| &side.fault).collect::<Vec<_>>(),
            board.trouble
        );
        std::thread::sleep(Duration::from_millis(10));
    }
}
