//! Films to merge, compare and show.

use aquifer_lab::film::{Facts, GraphText, Runs};

/// What made a film of so many frames.
pub fn facts(first_frame: u64, frames: u32) -> Facts {
    Facts {
        samples_per_pixel: frames,
        render_seconds: 1.0,
        graph: GraphText::new("graph"),
        scene: "cornell".into(),
        environment: None,
        camera: "main".into(),
        animation_time: 0.0,
        transport: "direct".into(),
        runs: Runs::one(0, first_frame, u64::from(frames)),
        adapter: "none".into(),
        version: "0".into(),
    }
}
