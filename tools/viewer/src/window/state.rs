//! What the user has chosen in the window.

use crate::{camera::Mover, develop::Developing, session::Choice};
use eframe::egui::{Color32, Vec2, vec2};

/// Colours of the sides: orange and sky blue, which most colour-blind people tell apart (Okabe and Ito 2008).
pub const SIDE_COLORS: [Color32; 2] = [Color32::from_rgb(230, 159, 0), Color32::from_rgb(86, 180, 233)];
/// Names of the sides.
pub const SIDE_NAMES: [&str; 2] = ["A", "B"];

/// How two sides share the stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// One picture, a slider between the sides.
    Split,
    /// Two pictures.
    Beside,
    /// One side; space flips.
    Single,
}

/// What is shown of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// The picture.
    Picture,
    /// |A − B|.
    Apart,
    /// |picture − reference|.
    Difference,
    /// Relative difference from the reference: too dark in blue, too bright in red.
    Relative,
    /// HDR-FLIP against the reference.
    Flip,
}

impl Show {
    /// With what to call them, and what they are.
    pub const ALL: [(Self, &'static str, &'static str); 5] = [
        (Self::Picture, "Picture", "What the graph renders"),
        (Self::Apart, "A − B", "Absolute difference of the two sides, amplified"),
        (Self::Difference, "Difference", "Absolute difference from the reference, amplified"),
        (Self::Relative, "Relative error", "Relative difference of luminance from the reference: blue too dark, red too bright"),
        (Self::Flip, "FLIP", "HDR-FLIP against the reference"),
    ];

    /// Needs a reference.
    pub fn wants_truth(self) -> bool {
        matches!(self, Self::Difference | Self::Relative | Self::Flip)
    }

    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }
}

/// Pages of the panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tab {
    /// Parameters and slots.
    Parameters,
    /// The graph as a picture.
    Graph,
    /// Errors against time.
    Errors,
    /// The reservoirs of a pixel.
    Inspector,
}

/// What part of the picture fills the stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zoom {
    /// 1: the whole picture.
    pub factor: f32,
    /// Of the stage's middle, as shares of the picture.
    pub centre: Vec2,
}

impl Default for Zoom {
    fn default() -> Self {
        Self { factor: 1.0, centre: vec2(0.5, 0.5) }
    }
}

/// What the user has chosen.
#[derive(Clone, Debug)]
pub struct State {
    /// The display's settings were taken from the graph.
    pub begun: bool,
    pub layout: Layout,
    /// The side in front, where one is shown; that of the panel.
    pub front: usize,
    pub show: Show,
    /// In stops.
    pub amplify: f32,
    pub developing: Developing,
    /// Share of the picture that is A's.
    pub split: f32,
    pub zoom: Zoom,
    pub loupe: bool,
    pub panel: bool,
    pub tab: Tab,
    pub help: bool,
    /// Name of the scene's camera; `None` is the first.
    pub camera: Option<String>,
    pub mover: Option<Mover>,
    pub plays: bool,
    pub holds: bool,
    pub averages: bool,
    pub scale: Choice,
    /// Samples of the reference that was asked for; `None`: none was.
    pub truth: Option<u64>,
    /// The pixel that is inspected, as shares of the picture.
    pub inspected: Option<[f32; 2]>,
    pub files: super::files::Files,
}

impl State {
    /// For so many graphs.
    pub fn new(graphs: usize) -> Self {
        Self {
            begun: false,
            layout: if graphs > 1 { Layout::Split } else { Layout::Single },
            front: 0,
            show: Show::Picture,
            amplify: 2.0,
            developing: Developing::default(),
            split: 0.5,
            zoom: Zoom::default(),
            loupe: false,
            panel: true,
            tab: Tab::Parameters,
            help: false,
            camera: None,
            mover: None,
            plays: false,
            holds: false,
            averages: true,
            scale: Choice::Automatic,
            truth: None,
            inspected: None,
            files: super::files::Files::default(),
        }
    }
}
