//! What can be kept: changes as a graph file, pictures, films, the command line.

use super::{
    Viewer, images,
    state::{SIDE_NAMES, Show},
};
use crate::save;
use aquifer_lab::{
    atomic,
    film::{Facts, Film, GraphText, Runs, linear},
};
use eframe::egui::{self, RichText};
use std::{
    path::Path,
    sync::{Arc, Mutex, PoisonError},
};

/// The dialogue.
#[derive(Clone, Debug)]
pub struct Files {
    pub open: bool,
    /// Side that is kept.
    pub side: usize,
    /// Folder and name, without an ending.
    pub path: String,
    /// What was done, or why not.
    pub outcome: Result<String, String>,
    /// What became of a screenshot.
    pub shot: Arc<Mutex<Option<Result<String, String>>>>,
}

impl Default for Files {
    fn default() -> Self {
        Self { open: false, side: 0, path: "aquifer_view".to_owned(), outcome: Ok(String::new()), shot: Arc::default() }
    }
}

impl Viewer {
    /// Opens the dialogue that keeps things, for files of that folder and name.
    pub fn keep(&mut self, path: &str) {
        self.state.files = Files { open: true, path: path.to_owned(), ..Files::default() };
    }

    pub(super) fn files(&mut self, ui: &egui::Ui) {
        let shot = self.state.files.shot.lock().unwrap_or_else(PoisonError::into_inner).take();
        self.state.files.outcome = shot.unwrap_or_else(|| self.state.files.outcome.clone());
        let mut open = self.state.files.open;
        egui::Window::new("Keep").open(&mut open).resizable(false).show(ui.ctx(), |ui| {
            ui.horizontal(|ui| {
                for (side, name) in SIDE_NAMES.iter().enumerate().take(self.recipes.len()) {
                    ui.selectable_value(&mut self.state.files.side, side, format!("of {name}"));
                }
            });
            ui.horizontal(|ui| {
                let label = ui.label("file, without ending");
                ui.text_edit_singleline(&mut self.state.files.path).labelled_by(label.id);
            });
            let side = self.state.files.side.min(self.recipes.len() - 1);
            ui.horizontal_wrapped(|ui| {
                if ui.button("Changes (.toml)").on_hover_text("A graph file that extends this one and says what differs").clicked() {
                    self.state.files.outcome = self.save_diff(side);
                }
                if ui.button("Film (.exr)").on_hover_text("Radiance with what made it").clicked() {
                    self.state.files.outcome = self.save_film(side);
                }
                if ui.button("Picture (.png)").on_hover_text("The side as it is shown").clicked() {
                    self.state.files.outcome = self.save_picture(side);
                }
                if ui.button("Screenshot (.png)").on_hover_text("The whole window").clicked() {
                    self.screenshot(ui.ctx());
                }
                if ui.button("Copy command").on_hover_text("The command line that renders this picture again").clicked() {
                    self.state.files.outcome = self.command(side).inspect(|command| ui.ctx().copy_text(command.clone()));
                }
            });
            match &self.state.files.outcome {
                Ok(words) => ui.label(RichText::new(words).monospace()),
                Err(words) => ui.label(RichText::new(words).color(ui.visuals().error_fg_color)),
            };
        });
        self.state.files.open = open;
    }

    fn path(&self, ending: &str) -> String {
        format!("{}.{ending}", self.state.files.path)
    }

    fn save_diff(&self, side: usize) -> Result<String, String> {
        let shown = self.board.sides.get(side).and_then(|board| board.shown.as_ref()).ok_or("there is no graph yet")?;
        let path = self.path("toml");
        let folder = Path::new(&path).parent().unwrap_or(Path::new(""));
        let text = save::diff(&self.recipes[side], &shown.graph, &shown.written, folder);
        atomic::write(Path::new(&path), text.as_bytes()).map_err(|error| error.to_string())?;
        Ok(format!("{path}:\n\n{text}"))
    }

    fn save_film(&self, side: usize) -> Result<String, String> {
        let (board, path) = (self.board.sides.get(side).ok_or("there is no graph yet")?, self.path("exr"));
        let picture = board.picture.as_ref().ok_or("there is no picture yet")?;
        let graph = &board.shown.as_ref().ok_or("there is no graph yet")?.graph;
        let text =
            graph.sources().iter().map(|source| format!("# {}\n{}\n", source.name, source.text.trim_end())).collect::<Vec<_>>().join("\n");
        let facts = Facts {
            samples_per_pixel: u32::try_from(picture.samples).unwrap_or(u32::MAX),
            render_seconds: picture.spent * 1e-3,
            graph: GraphText { text, hash: graph.digest() },
            scene: self.scene.clone(),
            environment: self.board.environment.clone(),
            camera: picture.moment.name.clone().unwrap_or_else(|| "free".to_owned()),
            animation_time: picture.moment.time,
            transport: graph.transport().to_string(),
            runs: Runs::one(self.seed, u64::from(picture.first), u64::from(picture.frames)),
            adapter: self.board.adapter.clone(),
            version: self.version.clone(),
        };
        let film = Film { facts: Some(facts), ..picture.film.clone() };
        film.write(Path::new(&path)).map_err(|error| error.to_string())?;
        Ok(path)
    }

    fn save_picture(&self, side: usize) -> Result<String, String> {
        let path = self.path("png");
        let (film, how) = images::film(&self.board, &self.state, side).ok_or("there is nothing to be seen yet")?;
        let bytes = crate::develop::bytes(&film, how);
        write_png(&path, film.size, &bytes)
    }

    /// Asks for the window as it is shown next; it is written when it comes.
    fn screenshot(&self, context: &egui::Context) {
        let (path, outcome) = (self.path("png"), self.state.files.shot.clone());
        let write = egui::ScreenshotCallback::new(move |image: Arc<egui::ColorImage>| {
            let bytes: Vec<u8> = image.pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
            let written = write_png(&path, image.size.map(|side| side as u32), &bytes);
            *outcome.lock().unwrap_or_else(PoisonError::into_inner) = Some(written);
        });
        context.send_viewport_cmd(egui::ViewportCommand::Screenshot(write));
    }

    fn command(&self, side: usize) -> Result<String, String> {
        if self.state.show != Show::Picture {
            return Err("a command renders a picture: show that first".to_owned());
        }
        let picture = self.board.sides.get(side).and_then(|board| board.picture.as_ref()).ok_or("there is no picture yet")?;
        Ok(save::render_command(&self.recipes[side], &self.scene, &self.options, self.seed, picture))
    }
}

/// Writes what a screen shows, code for code.
fn write_png(path: &str, size: [u32; 2], rgba: &[u8]) -> Result<String, String> {
    let color = rgba.chunks_exact(4).map(|pixel| [0, 1, 2].map(|channel| linear(f32::from(pixel[channel]) / 255.0))).collect();
    let film = Film::new(size, color).map_err(|error| error.to_string())?;
    film.write(Path::new(path)).map_err(|error| error.to_string())?;
    Ok(path.to_owned())
}
