//! The keyboard.

use super::{
    Viewer,
    state::{Layout, Show, Tab, Zoom},
};
use crate::session::Message;
use eframe::egui::{self, Key, Modifiers};
use glam::Vec3;

/// Keys with what they do, as the help shows them.
pub const HELP: [(&str, &str); 16] = [
    ("Space", "flip between A and B"),
    ("1 2 3", "split, side by side, one side"),
    ("W A S D, Q E", "fly; with Shift five times as fast"),
    ("left drag", "orbit"),
    ("right drag", "look around"),
    ("middle drag", "shift"),
    ("wheel", "nearer, farther"),
    ("Ctrl wheel, Ctrl drag", "zoom into the picture, move it"),
    ("Home", "back to the scene's camera"),
    ("0", "whole picture"),
    ("P, .", "play or pause the animation; one step"),
    ("H", "hold rendering"),
    ("[ ]", "exposure down, up"),
    ("L", "loupe with values"),
    ("I, then click", "inspect the reservoirs of a pixel"),
    ("F2, F1", "panel; this help"),
];

impl Viewer {
    /// What keys ask for, unless something that takes text has them.
    pub(super) fn keys(&mut self, ui: &egui::Ui) {
        if ui.ctx().text_edit_focused() {
            return;
        }
        let pressed = |key: Key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        // A button that has the focus takes space for itself.
        let focused = ui.memory(|memory| memory.focused().is_some());
        if !focused && pressed(Key::Space) && self.recipes.len() > 1 {
            (self.state.layout, self.state.front) = (Layout::Single, 1 - self.state.front);
        }
        for (key, layout) in [(Key::Num1, Layout::Split), (Key::Num2, Layout::Beside), (Key::Num3, Layout::Single)] {
            if pressed(key) && (self.recipes.len() > 1 || layout == Layout::Single) {
                self.state.layout = layout;
            }
        }
        if pressed(Key::Num0) {
            self.state.zoom = Zoom::default();
        }
        if pressed(Key::Home) {
            self.use_camera(self.state.camera.clone());
        }
        if pressed(Key::P) {
            self.play(!self.state.plays);
        }
        if pressed(Key::Period) {
            self.session.send(Message::Step);
        }
        if pressed(Key::H) {
            self.hold(!self.state.holds);
        }
        if pressed(Key::L) {
            self.state.loupe = !self.state.loupe;
        }
        if pressed(Key::I) {
            (self.state.panel, self.state.tab) = (true, Tab::Inspector);
        }
        if pressed(Key::F2) {
            self.state.panel = !self.state.panel;
        }
        if pressed(Key::F1) {
            self.state.help = !self.state.help;
        }
        for (key, stops) in [(Key::OpenBracket, -0.5), (Key::CloseBracket, 0.5)] {
            if pressed(key) {
                let what = if self.state.show == Show::Picture { &mut self.state.developing.exposure } else { &mut self.state.amplify };
                *what += stops;
            }
        }
        self.fly(ui);
    }

    pub(super) fn play(&mut self, plays: bool) {
        self.state.plays = plays;
        self.session.send(Message::Play(plays));
    }

    pub(super) fn hold(&mut self, holds: bool) {
        self.state.holds = holds;
        self.session.send(Message::Hold(holds));
    }

    /// As long as the keys are down.
    fn fly(&mut self, ui: &egui::Ui) {
        let axis = |minus: Key, plus: Key| ui.input(|input| f32::from(input.key_down(plus)) - f32::from(input.key_down(minus)));
        let axes = Vec3::new(axis(Key::A, Key::D), axis(Key::Q, Key::E), axis(Key::W, Key::S));
        let (seconds, modifiers) = ui.input(|input| (input.stable_dt.min(0.1), input.modifiers));
        if axes == Vec3::ZERO || modifiers.ctrl || modifiers.command {
            return;
        }
        let haste = if modifiers.shift { 5.0 } else { 1.0 };
        if let Some(mover) = self.mover() {
            mover.fly(axes * haste, seconds);
            self.send_mover();
        }
        ui.ctx().request_repaint();
    }
}
