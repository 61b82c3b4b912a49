//! What a render did, in a sentence and in numbers.

use aquifer_graph::{Graph, LeftOut};
use aquifer_lab::{
    film::{Film, luminance},
    rays::PassRays,
};
use aquifer_render::{MemoryReport, PortCounts, Renderer, Startup, Timings};
use serde::Serialize;
use std::{
    path::{Path, PathBuf},
    time::Duration,
};

/// What a render did.
#[derive(Debug, Serialize)]
pub struct Summary {
    title: String,
    graph: String,
    transport: String,
    scene: String,
    environment: Option<String>,
    camera: String,
    size: [u32; 2],
    /// All that were rendered.
    frames: u64,
    /// In the film.
    samples_per_pixel: u32,
    /// Of rendering, without set-up.
    seconds: f64,
    /// From the start of the program to the end of the first frame.
    seconds_to_first_frame: Option<f64>,
    adapter: String,
    version: String,
    mean_luminance: f64,
    /// Mean over pixels of the standard error of luminance, relative to `mean_luminance`; an upper bound.
    relative_error: Option<f64>,
    passes: Timings,
    /// Of the last frame, where passes count them.
    rays: Vec<PassRays>,
    /// NaNs and infinities by pass and output, over all frames; empty without --counters.
    counters: Vec<PortCounts>,
    startup_seconds: Setup,
    memory: MemoryReport,
    /// Of this process, where the system tells.
    peak_memory_bytes: Option<u64>,
    left_out: Vec<LeftOut>,
    reports: Vec<(String, String)>,
    outputs: Vec<PathBuf>,
}

/// Where the time before the second frame went, in seconds.
#[derive(Debug, Serialize)]
struct Setup {
    /// Linking, validating and reflecting shaders.
    compose: f64,
    /// Making pipelines.
    pipelines: f64,
    /// Allocating and clearing memory.
    memory: f64,
    /// The first frame, with what the driver compiles late.
    first_frame: Option<f64>,
}

impl Setup {
    fn of(startup: Startup) -> Self {
        Self {
            compose: startup.compose.as_secs_f64(),
            pipelines: startup.pipelines.as_secs_f64(),
            memory: startup.memory.as_secs_f64(),
            first_frame: startup.first_frame.map(|time| time.as_secs_f64()),
        }
    }
}

impl Summary {
    /// Collects it; `set_up` is what came before rendering.
    pub fn new(
        graph: &Graph,
        film: &Film,
        renderer: &Renderer,
        (rays, counters): (Vec<PassRays>, Vec<PortCounts>),
        frames: u64,
        set_up: Duration,
        outputs: &[PathBuf],
    ) -> Self {
        let facts = film.facts.clone().expect("the film of a render has its facts");
        let startup = renderer.startup();
        Self {
            title: graph.title().to_owned(),
            graph: facts.graph.hash,
            transport: facts.transport,
            scene: facts.scene,
            environment: facts.environment,
            camera: facts.camera,
            size: film.size,
            frames,
            samples_per_pixel: facts.samples_per_pixel,
            seconds: facts.render_seconds,
            seconds_to_first_frame: startup.first_frame.map(|first| (set_up + first).as_secs_f64()),
            adapter: facts.adapter,
            version: facts.version,
            mean_luminance: mean_luminance(film),
            relative_error: relative_error(film),
            passes: renderer.timings(),
            rays,
            counters,
            startup_seconds: Setup::of(startup),
            memory: renderer.memory().clone(),
            peak_memory_bytes: peak_memory(),
            left_out: renderer.plan().left_out.clone(),
            reports: renderer.reports(),
            outputs: outputs.to_vec(),
        }
    }

    /// For people.
    pub fn sentence(&self) -> String {
        let rate = self.frames as f64 / self.seconds;
        let error = self.relative_error.map(|error| format!(", {:.1} % noise", 100.0 * error)).unwrap_or_default();
        let mut text = format!(
            "{} of {}: {} frames in {:.2} s ({rate:.2} frames/s){error}, on {}",
            self.title, self.scene, self.frames, self.seconds, self.adapter
        );
        for path in &self.outputs {
            text += &format!("\n  wrote {}", path.display());
        }
        text
    }

    /// Which outputs held what no picture should, in order of execution.
    pub fn counted(&self) -> String {
        let bad: Vec<&PortCounts> = self.counters.iter().filter(|counts| counts.nan + counts.infinite > 0).collect();
        let mut text = match bad.first() {
            None => format!("no NaN and no infinity in {} outputs", self.counters.len()),
            Some(first) => {
                format!("NaNs or infinities in {} of {} outputs, first in pass `{}`:", bad.len(), self.counters.len(), first.pass)
            }
        };
        for PortCounts { pass, port, nan, infinite } in bad {
            text += &format!("\n  {pass}.{port}: {nan} NaN, {infinite} infinite");
        }
        text
    }
}

fn mean_luminance(film: &Film) -> f64 {
    film.color.iter().map(|color| luminance(color.map(f64::from))).sum::<f64>() / film.pixels() as f64
}

fn relative_error(film: &Film) -> Option<f64> {
    let variance = film.variance.as_ref()?;
    let error = variance.iter().map(|variance| luminance(variance.map(|v| f64::from(v).sqrt()))).sum::<f64>() / film.pixels() as f64;
    Some(error / mean_luminance(film)).filter(|error| error.is_finite())
}

/// High-water mark of resident memory, from Linux.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string(Path::new("/proc/self/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
