//! Rays that passes trace, as they count them themselves: an output called `rays`, one u32 a pixel.

use aquifer_graph::{Direction, Graph, PortId};
use aquifer_render::{Error, Renderer};
use serde::Serialize;

/// Name of the outputs that count rays.
pub const RAYS: &str = "rays";

/// Which passes count their rays.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RayCounters(Vec<String>);

/// What one pass traced in the last frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassRays {
    /// The pass.
    pub pass: String,
    /// Rays in the last frame.
    pub rays: u64,
    /// Over the pass's median time; `None` before it was timed.
    pub mrays_per_second: Option<f64>,
}

impl RayCounters {
    /// All counters of a graph.
    pub fn of(graph: &Graph) -> Self {
        let counters = graph.nodes().iter().enumerate().filter_map(|(node, it)| {
            let is_counter = |port: &aquifer_graph::Port| port.name == RAYS && port.ty.element == "u32" && port.direction == Direction::Out;
            Some(PortId { node, port: it.contract.ports.iter().position(is_counter)? })
        });
        Self(counters.map(|port| graph.port_name(port)).collect())
    }

    /// Resources that the plan must keep.
    pub fn keep(&self) -> Vec<&str> {
        self.0.iter().map(String::as_str).collect()
    }

    /// Reads the counters after a frame.
    ///
    /// # Errors
    /// As [`Renderer::read`].
    pub fn read(&self, renderer: &mut Renderer) -> Result<Vec<PassRays>, Error> {
        let timings = renderer.timings();
        let read = |name: &String| {
            let bytes = renderer.read(name)?;
            let rays = bytes.chunks_exact(4).map(|word| u64::from(u32::from_le_bytes([word[0], word[1], word[2], word[3]]))).sum();
            let pass = name.trim_end_matches(RAYS).trim_end_matches('.').to_owned();
            let time = timings.passes.iter().find(|time| time.pass == pass).and_then(|time| time.median_ms);
            Ok(PassRays { pass, rays, mrays_per_second: time.filter(|ms| *ms > 0.0).map(|ms| rays as f64 / ms / 1e3) })
        };
        self.0.iter().map(read).collect()
    }
}
