//! A graph that renders, with the mean of its frames.

use super::{
    Shown,
    message::{Moment, Watch},
};
use crate::{
    record::{self, Leaf, Record},
    testimony::TESTIMONY,
};
use aquifer_graph::{Direction, Graph, NeedsAll, Transport, Value};
use aquifer_lab::{
    capture::{Capture, CaptureError},
    film::Film,
};
use aquifer_render::{PassTime, Registry, Renderer};
use std::{collections::BTreeSet, sync::Arc};

/// What one side shows.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Radiance: the mean of `frames` frames.
    pub film: Film,
    /// Number of the first frame in the mean.
    pub first: u32,
    /// How many frames are in the mean.
    pub frames: u32,
    /// Samples a pixel in all of them.
    pub samples: u64,
    /// Milliseconds spent on them.
    pub spent: f64,
    /// Where from, and when.
    pub moment: Moment,
    /// Which light paths.
    pub transport: Transport,
    /// Counts pictures of the session: another number, another picture.
    pub number: u64,
}

/// A resource as a picture.
#[derive(Clone, Debug)]
pub struct Watched {
    /// What was asked for.
    pub watch: Watch,
    /// Its element, as people read it.
    pub element: String,
    /// Numbers of its elements that can be looked at.
    pub members: Vec<String>,
    /// In the units of the resource; grey where it is a single number. `None` where it has no number a pixel.
    pub film: Option<Film>,
    /// Smallest and largest number of it.
    pub range: [f32; 2],
}

/// A graph on the device.
pub struct Live {
    shown: Arc<Shown>,
    running: Graph,
    registry: Arc<Registry>,
    capture: Capture,
    renderer: Renderer,
    /// Passes whose time counts, by name of the node: what only shows or averages does not.
    counted: BTreeSet<String>,
    sum: Vec<[f64; 3]>,
    frames: u32,
    spent: f64,
    /// Milliseconds of the latest frame whose clock was sound.
    cost: f64,
    dropped: u64,
}

impl Live {
    /// The graph as asked for, as written, and as it runs.
    pub fn new([graph, written, running]: [Graph; 3], registry: Arc<Registry>, capture: Capture, renderer: Renderer) -> Self {
        let shown = Arc::new(Shown {
            graph,
            written,
            plan: renderer.plan().clone(),
            memory: renderer.memory().clone(),
            startup: renderer.startup(),
        });
        let counted = capture.makers(&running);
        Self { shown, running, registry, capture, renderer, counted, sum: Vec::new(), frames: 0, spent: 0.0, cost: 0.0, dropped: 0 }
    }

    pub fn shown(&self) -> &Arc<Shown> {
        &self.shown
    }

    /// Renders one frame and takes it into the mean; the answer is what it cost.
    pub fn frame(&mut self, moment: &Moment) -> Result<f64, CaptureError> {
        self.renderer.set_time(moment.time, 0.0);
        self.renderer.set_camera(Some(moment.camera));
        self.renderer.frame()?;
        let film = self.capture.last_frame(&self.running, &mut self.renderer)?;
        self.sum.resize(film.color.len(), [0.0; 3]);
        for (sum, color) in self.sum.iter_mut().zip(&film.color) {
            (0..3).for_each(|channel| sum[channel] += f64::from(color[channel]));
        }
        self.frames += 1;
        let timings = self.renderer.timings();
        let counts = |pass: &&PassTime| self.counted.contains(&pass.pass);
        let ms: Option<f64> = timings.passes.iter().filter(counts).map(|pass| pass.latest_ms).sum();
        if let (Some(ms), true) = (ms, timings.dropped == self.dropped) {
            self.cost = ms;
        }
        self.dropped = timings.dropped;
        self.spent += self.cost;
        Ok(self.cost)
    }

    /// The mean begins anew; history goes on.
    pub fn forget_mean(&mut self) {
        self.sum.clear();
        (self.frames, self.spent) = (0, 0.0);
    }

    /// Takes another size, and begins anew.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), aquifer_render::Error> {
        self.forget_mean();
        self.renderer.resize(&self.registry, size)
    }

    /// Sets a live parameter; what is shown as the graph becomes `shown`.
    pub fn set(&mut self, pass: &str, name: &str, value: Value) -> Result<(), aquifer_render::Error> {
        self.renderer.set_param(pass, name, value)
    }

    /// Shows another graph that runs as this one does, but for live parameters.
    pub fn show(&mut self, graph: Graph) {
        let Shown { written, plan, memory, startup, .. } = &*self.shown;
        self.shown = Arc::new(Shown { graph, written: written.clone(), plan: plan.clone(), memory: memory.clone(), startup: *startup });
    }

    pub fn size(&self) -> [u32; 2] {
        self.renderer.options().size
    }

    /// The mean so far; `None` before the first frame.
    pub fn picture(&self, moment: &Moment, number: u64) -> Option<Picture> {
        let scale = 1.0 / f64::from(self.frames);
        let color: Vec<[f32; 3]> = self.sum.iter().map(|sum| sum.map(|sum| (sum * scale) as f32)).collect();
        let film = Film::new(self.size(), color).ok().filter(|_| self.frames > 0)?;
        let samples = u64::from(self.frames) * u64::from(Capture::samples_per_frame(&self.running));
        let first = self.renderer.next_frame().wrapping_sub(self.frames);
        let (frames, spent, transport) = (self.frames, self.spent, self.running.transport());
        Some(Picture { film, first, frames, samples, spent, moment: moment.clone(), transport, number })
    }

    pub fn times(&self) -> Vec<PassTime> {
        self.renderer.timings().passes
    }

    /// Can this be read after a frame?
    pub fn keeps(&self, resource: &str) -> bool {
        self.renderer.buffer(resource).is_ok()
    }

    /// A resource as a picture.
    pub fn watched(&mut self, watch: &Watch) -> Option<Watched> {
        let ty = self.type_of(&watch.resource)?;
        let leaves = record::leaves(&ty.layout);
        let bytes = self.renderer.read(&watch.resource).ok()?;
        let stride = ty.stride as usize;
        let chosen = |leaf: &&Leaf| watch.member.as_ref() == Some(&leaf.path);
        let one = leaves.iter().find(chosen).or_else(|| leaves.first().filter(|_| !record::is_color(&ty.layout)));
        let pixel = |element: &[u8]| match one {
            Some(leaf) => [leaf.number(element) as f32; 3],
            None => [0, 1, 2].map(|channel| leaves[channel].number(element) as f32),
        };
        let color: Vec<[f32; 3]> = if leaves.is_empty() { Vec::new() } else { bytes.chunks_exact(stride).map(pixel).collect() };
        let finite = || color.iter().flatten().copied().filter(|number| number.is_finite());
        let range = [finite().fold(f32::INFINITY, f32::min), finite().fold(f32::NEG_INFINITY, f32::max)];
        let members = if leaves.len() > 1 { leaves.iter().map(|leaf| leaf.path.clone()).collect() } else { Vec::new() };
        let film = Film::new(self.size(), color).ok();
        Some(Watched { watch: watch.clone(), element: ty.element, members, film, range })
    }

    /// What the reservoirs hold at a pixel, in the order in which they are written.
    pub fn records(&self, pixel: [u32; 2]) -> Vec<Record> {
        let index = u64::from(pixel[1]) * u64::from(self.size()[0]) + u64::from(pixel[0]);
        let record = |name: String| {
            let ty = self.type_of(&name)?;
            let (buffer, _) = self.renderer.buffer(&name).ok()?;
            let stride = u64::from(ty.stride);
            let bytes = aquifer_render::read(self.renderer.context(), &name, buffer, index * stride, stride).ok()?;
            Some(Record::new(name, &ty, &bytes))
        };
        reservoirs(&self.running).into_iter().filter_map(record).collect()
    }

    fn type_of(&self, resource: &str) -> Option<aquifer_graph::WireType> {
        let (node, port) = resource.rsplit_once('.')?;
        let node = self.running.nodes().iter().rfind(|known| known.name == node || known.pass == node)?;
        Some(node.port(node.port_index(port)?).ty.clone())
    }
}

/// Every reservoir that the output needs, and what passes tell of it, as `node.port`.
pub fn reservoirs(graph: &Graph) -> Vec<String> {
    let Ok(plan) = graph.plan(&NeedsAll, &[]) else { return Vec::new() };
    let runs = |node: &&aquifer_graph::Node| plan.steps.iter().any(|step| step.node == node.name);
    let tells = |port: &aquifer_graph::Port| port.ty.element.starts_with(record::RESERVOIR) || port.name == TESTIMONY;
    let written = |node: &aquifer_graph::Node| {
        let ports = node.contract.ports.iter().filter(|port| port.direction != Direction::In && tells(port));
        ports.map(|port| format!("{}.{}", node.name, port.name)).collect::<Vec<_>>()
    };
    graph.nodes().iter().filter(runs).flat_map(written).collect()
}
