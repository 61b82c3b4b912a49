//! Many frames of one run: does energy drift, do NaNs creep in, does memory grow?

use super::row::Share;
use crate::{
    capture::Capture,
    compare::error::CompareError,
    film::luminance,
    stage,
    stats::{Difference, Moments},
};
use aquifer_graph::{Document, Graph, NeedsAll};
use aquifer_render::{Context, Renderer, RendererOptions, SceneGlobals, View};
use aquifer_scene::Scene;
use serde::Serialize;
use std::sync::Arc;

/// Frames at the beginning that do not count: history fills meanwhile.
const WARM_UP: u32 = 100;
/// Batches of the rest, each longer by far than what frames share: their means are independent, nearly.
const BATCHES: u32 = 10;

/// What a long run showed.
#[derive(Clone, Debug, Serialize)]
pub struct Long {
    /// The graph.
    pub graph: String,
    /// Frames rendered.
    pub frames: u32,
    /// Mean luminance of the second half less that of the first, as a share of the first.
    pub drift: Share,
    /// Elements of all outputs of all passes over all frames.
    pub nan: u64,
    /// Likewise.
    pub infinite: u64,
    /// What the device holds after the first frames and after the last, where the backend tells.
    pub device_bytes: [Option<u64>; 2],
}

impl Long {
    /// Nothing drifts, nothing is infinite, nothing grows.
    pub fn is_good(&self) -> bool {
        self.nan + self.infinite == 0 && self.device_bytes[1] <= self.device_bytes[0] && !self.drifts()
    }

    /// The drift is shown to be real, at 1 %.
    pub fn drifts(&self) -> bool {
        self.drift.is_real(0.01)
    }

    /// For people.
    pub fn sentence(&self) -> String {
        let Long { graph, frames, drift, nan, infinite, device_bytes } = self;
        let [before, after] = device_bytes.map(|bytes| bytes.map_or("unknown".to_owned(), |bytes| bytes.to_string()));
        format!(
            "{graph}: {frames} frames, drift {}, {nan} NaN, {infinite} infinite, {before} bytes on the device, then {after}",
            drift.percent()
        )
    }
}

/// Renders `frames` frames of a graph, all of one moment; `None` for a graph without history.
///
/// # Errors
/// What the graph or the device refuses.
pub fn long(
    context: &Context,
    scene: &Arc<Scene>,
    (name, document): (&str, &Document),
    size: [u32; 2],
    frames: u32,
) -> Result<Option<Long>, CompareError> {
    let registry = stage::registry(Some(scene), &[]).map_err(|error| aquifer_render::Error::Globals(error.to_string()))?;
    let graph = Graph::check(document, &registry)?;
    let capture = Capture::of(&graph);
    if capture.independent() {
        return Ok(None);
    }
    let frame = graph.port_name(capture.frame_port(&graph));
    let plan = graph.plan(&NeedsAll, &[&frame])?;
    let globals = SceneGlobals::new(context, scene.clone(), View::default())?;
    let options = RendererOptions { size, counters: true, ..RendererOptions::default() };
    let mut renderer = Renderer::new(context, &registry, plan, Box::new(globals), options)?;
    let mut before = None;
    let mut batches = vec![Moments::default(); BATCHES as usize];
    for number in 0..frames {
        renderer.frame()?;
        if number == WARM_UP {
            renderer.finish()?;
            before = context.device_bytes();
        }
        if let Some(after) = number.checked_sub(WARM_UP) {
            let film = capture.last_frame(&graph, &mut renderer)?;
            let batch = u64::from(after) * u64::from(BATCHES) / u64::from(frames - WARM_UP);
            batches[batch as usize]
                .push(film.color.iter().map(|color| luminance(color.map(f64::from))).sum::<f64>() / film.pixels() as f64);
        }
    }
    let counts = renderer.counts()?;
    let [first, second] = [&batches[..BATCHES as usize / 2], &batches[BATCHES as usize / 2..]]
        .map(|half| half.iter().map(Moments::mean).collect::<Moments>());
    Ok(Some(Long {
        graph: name.to_owned(),
        frames,
        drift: Difference::welch(&second, &first).relative_to(first.mean()).into(),
        nan: counts.iter().map(|counts| counts.nan).sum(),
        infinite: counts.iter().map(|counts| counts.infinite).sum(),
        device_bytes: [before, context.device_bytes()],
    }))
}
