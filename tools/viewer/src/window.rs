//! The window: shows the board of a session, and sends it messages.

mod bar;
mod curves;
mod files;
mod graph;
mod images;
mod inspector;
mod keys;
mod panel;
mod params;
mod stage;
mod state;

use crate::{
    Opening, Recipe,
    camera::Mover,
    session::{Board, Camera, Message, Session},
};
use eframe::egui;
use std::time::Duration;

/// Points across and down, at first.
const WINDOW: [f32; 2] = [1280.0, 800.0];
/// How often the window looks at the board where nothing tells it to.
const LOOK: Duration = Duration::from_millis(500);

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// There is no display, or it refuses.
    #[error("no window can be opened here ({0}); `aquifer compare` compares graphs without a display")]
    NoWindow(String),
}

/// Opens the window, and returns when it is closed.
///
/// # Errors
/// [`ViewError::NoWindow`].
pub fn run(opening: Opening) -> Result<(), ViewError> {
    if !has_display() {
        return Err(ViewError::NoWindow("neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned()));
    }
    let viewport = egui::ViewportBuilder::default().with_inner_size(WINDOW).with_title("Aquifer").with_app_id("aquifer");
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    let outcome = eframe::run_native("Aquifer", options, Box::new(|creation| Ok(Box::new(Viewer::new(opening, &creation.egui_ctx)))));
    outcome.map_err(|error| ViewError::NoWindow(error.to_string()))
}

/// Only where windows come from X11 or Wayland can their absence be told beforehand.
fn has_display() -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_vendor = "apple"))) || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

/// The viewer's window.
pub struct Viewer {
    session: Session,
    board: Board,
    known_graphs: Vec<String>,
    scene: String,
    options: Vec<String>,
    seed: u64,
    version: String,
    /// What the user wants; the board follows.
    recipes: Vec<Recipe>,
    state: state::State,
    images: images::Images,
    history: panel::History,
}

impl Viewer {
    /// Begins a session that wakes the window when there is something new.
    pub fn new(opening: Opening, context: &egui::Context) -> Self {
        let (known_graphs, scene, options) = (opening.known_graphs.clone(), opening.scene.clone(), opening.options.clone());
        let (seed, version) = (opening.seed, opening.version.clone());
        let recipes = opening.graphs.clone();
        let state = state::State { camera: opening.camera.clone(), ..state::State::new(recipes.len()) };
        let waker = context.clone();
        let session = Session::start(opening, move || waker.request_repaint());
        let board = session.look();
        Self {
            session,
            board,
            known_graphs,
            scene,
            options,
            seed,
            version,
            recipes,
            state,
            images: images::Images::default(),
            history: panel::History::default(),
        }
    }

    /// What was last seen of the session.
    pub fn board(&self) -> &Board {
        &self.board
    }

    /// Everything in the window.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        self.board = self.session.look();
        self.history.note(&self.board);
        self.begin();
        self.keys(ui);
        egui::Panel::top("bar").show(ui, |ui| self.bar(ui));
        egui::Panel::bottom("status").show(ui, |ui| self.status(ui));
        if self.state.panel {
            egui::Panel::right("panel").default_size(360.0).min_size(280.0).show(ui, |ui| self.panel(ui));
        }
        egui::CentralPanel::default().frame(egui::Frame::NONE).show(ui, |ui| self.stage(ui));
        self.files(ui);
        ui.ctx().request_repaint_after(LOOK);
    }

    /// Takes over what the first graph says about its display, once.
    fn begin(&mut self) {
        let Some(shown) = self.board.sides.first().and_then(|side| side.shown.as_ref()) else { return };
        if !std::mem::replace(&mut self.state.begun, true) {
            self.state.developing = images::developing_of(&shown.graph);
        }
    }

    /// Sends a side's recipe, as the user now wants it.
    fn send_recipe(&self, side: usize) {
        self.session.send(Message::Recipe(side, self.recipes[side].clone()));
    }

    /// The camera that the user moves; it begins where the picture was last taken from.
    fn mover(&mut self) -> Option<&mut Mover> {
        if self.state.mover.is_none() {
            self.state.mover = self.board.moment.as_ref().map(|moment| Mover::new(moment.camera, self.board.extent));
        }
        self.state.mover.as_mut()
    }

    fn send_mover(&self) {
        if let Some(mover) = &self.state.mover {
            self.session.send(Message::Camera(Camera::Free(mover.camera)));
        }
    }

    /// Back to a camera of the scene.
    fn use_camera(&mut self, name: Option<String>) {
        self.state.mover = None;
        self.state.camera.clone_from(&name);
        self.session.send(Message::Camera(Camera::Named(name)));
    }
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.show(ui);
    }
}
