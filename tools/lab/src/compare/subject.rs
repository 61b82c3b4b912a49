//! A graph on a scene, ready to be measured.

use super::error::CompareError;
use crate::{capture::Capture, film::Film};
use aquifer_graph::{Document, Graph, Source, Value};
use aquifer_render::{Clock, Context, Registry, Renderer, RendererOptions, SceneGlobals, View};
use aquifer_scene::Scene;
use std::{sync::Arc, time::Instant};

/// Where graphs are measured.
pub struct Stage {
    /// The device.
    pub context: Context,
    /// Passes, cut to the scene.
    pub registry: Registry,
    /// Finished.
    pub scene: Arc<Scene>,
    /// Name of the camera; `None` is the first.
    pub camera: Option<String>,
    /// Seconds into the animation at the frame that is measured.
    pub time: f32,
    /// Seconds from one frame to the next of a graph with history.
    pub step: f32,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// All films sample the middle of the pixel.
    pub centred: bool,
}

/// Frames of one run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// Frames before those that count.
    pub warm_up: u32,
    /// Frames that count.
    pub frames: u32,
}

/// One frame that counts.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Radiance of this frame alone.
    pub film: Film,
    /// Milliseconds of each pass, in order of execution; `None` where the clock ran backwards.
    pub passes: Vec<Option<f64>>,
    /// Milliseconds by the wall, until the device was done.
    pub wall_ms: f64,
}

/// A graph on a device.
pub struct Subject {
    graph: Graph,
    renderer: Renderer,
    capture: Capture,
    counted: Vec<bool>,
}

impl Stage {
    /// Camera and time such that frame number `frame` is at the stage's time.
    fn view(&self, step: f32, frame: u32) -> View {
        let time = (f64::from(self.time) - f64::from(step) * f64::from(frame)) as f32;
        View { camera: self.camera.clone(), free: None, time, step, centred: self.centred }
    }

    /// Checks a graph, its knob at `knob` or as written.
    ///
    /// # Errors
    /// [`CompareError::Graph`].
    pub fn graph(&self, document: &Document, knob: Option<f64>) -> Result<Graph, CompareError> {
        let graph = Graph::check(document, &self.registry)?;
        let (Some(setting), Some(value)) = (graph.knob(), knob) else { return Ok(graph) };
        let mut turned = document.clone();
        turned.apply([Source::new("budget", format!("{}.{}={value}", setting.pass, setting.param))])?;
        Ok(Graph::check(&turned, &self.registry)?)
    }

    /// Compiles a graph and renders two frames, so that whatever drivers do late is done. `warm_up` is that of the runs to come.
    ///
    /// # Errors
    /// What the graph, the plan or the device refuses.
    pub fn subject(&self, document: &Document, knob: Option<f64>, warm_up: u32) -> Result<Subject, CompareError> {
        let graph = self.graph(document, knob)?;
        let capture = Capture::of(&graph);
        let frame = graph.port_name(capture.frame_port(&graph));
        let plan = graph.plan(&self.registry, &[&frame])?;
        let needed = capture.makers(&graph);
        let counted = plan.steps.iter().map(|step| needed.contains(&step.node)).collect();
        let view = if capture.independent() { self.view(0.0, 0) } else { self.view(self.step, warm_up) };
        let globals = SceneGlobals::new(&self.context, self.scene.clone(), view)?;
        let options = RendererOptions { size: self.size, ..RendererOptions::default() };
        let mut renderer = Renderer::new(&self.context, &self.registry, plan, Box::new(globals), options)?;
        for _ in 0..2 {
            renderer.frame()?;
        }
        renderer.finish()?;
        Ok(Subject { graph, renderer, capture, counted })
    }
}

impl Subject {
    /// The graph.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Frames do not depend on frames before.
    pub fn independent(&self) -> bool {
        self.capture.independent()
    }

    /// Who holds the watch.
    pub fn clock(&self) -> Clock {
        self.renderer.timings().clock
    }

    /// Names of the passes in order of execution, and whether the image needs them. What only shows or averages the image does not count.
    pub fn passes(&self) -> Vec<(String, bool)> {
        let names = self.renderer.plan().steps.iter().map(|step| step.node.clone());
        names.zip(self.counted.iter().copied()).collect()
    }

    /// Stands still at another time of the animation.
    pub fn set_time(&mut self, time: f32) {
        self.renderer.set_time(time, 0.0);
    }

    /// Milliseconds of a shot's passes that count.
    pub fn time_of(&self, shot: &Shot) -> Option<f64> {
        let counted = shot.passes.iter().zip(&self.counted).filter(|(_, counted)| **counted);
        counted.map(|(ms, _)| *ms).sum()
    }

    /// Begins anew with `seed`, renders, and shows each frame that counts; the seconds of rendering, without what was read back and shown.
    ///
    /// # Errors
    /// What the device refuses, and what `show` returns.
    pub fn run(
        &mut self,
        seed: u64,
        schedule: Schedule,
        mut show: impl FnMut(u32, &Self, Shot) -> Result<(), CompareError>,
    ) -> Result<f64, CompareError> {
        let began = Instant::now();
        self.begin(seed)?;
        for _ in 0..schedule.warm_up {
            self.renderer.frame()?;
        }
        self.renderer.finish()?;
        let mut rendering = began.elapsed();
        for frame in 0..schedule.frames {
            let dropped = self.renderer.timings().dropped;
            let began = Instant::now();
            self.renderer.frame()?;
            self.renderer.finish()?;
            let wall = began.elapsed();
            rendering += wall;
            let film = self.capture.last_frame(&self.graph, &mut self.renderer)?;
            let timings = self.renderer.timings();
            let sound = timings.dropped == dropped;
            let passes = timings.passes.iter().map(|pass| pass.latest_ms.filter(|_| sound)).collect();
            show(frame, self, Shot { film, passes, wall_ms: 1e3 * wall.as_secs_f64() })?;
        }
        Ok(rendering.as_secs_f64())
    }

    /// Begins anew with `seed`, and waits until all memory is cleared: that is no frame's work.
    fn begin(&mut self, seed: u64) -> Result<(), CompareError> {
        self.renderer.reseed(seed)?;
        let context = self.renderer.context();
        let cleared = context.queue().submit([]);
        Ok(context.wait(&cleared, "restart")?)
    }

    /// The smallest and largest value of the knob, from its parameter's range and type; `None` without a knob.
    pub fn knob_range(&self) -> Option<KnobRange> {
        let knob = self.graph.knob()?;
        let node = self.graph.nodes().iter().find(|node| node.pass == knob.pass)?;
        let param = node.contract.params.iter().find(|param| param.name == knob.param)?;
        let (least, most) = param.range.unwrap_or((1.0, f64::from(u16::MAX)));
        let now = node.params.get(&knob.param)?.as_f64()?;
        Some(KnobRange { least, most, now, whole: !matches!(param.default, Value::F32(_)) })
    }
}

/// What a knob can be turned to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnobRange {
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
    /// As the file has it.
    pub now: f64,
    /// Only whole numbers.
    pub whole: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stage;
    use aquifer_graph::Shelf;
    use aquifer_render::ContextOptions;
    use std::sync::atomic::{AtomicBool, Ordering};

    #[test]
    fn a_run_begins_with_an_idle_device() {
        if aquifer_render::adapters().is_empty() {
            assert!(std::env::var_os("AQUIFER_REQUIRE_ADAPTER").is_none(), "no adapter was found, and AQUIFER_REQUIRE_ADAPTER is set");
            return;
        }
        let scene = Arc::new((aquifer_scenes::by_name("cornell").unwrap().make)().finish().unwrap());
        let stage = Stage {
            context: Context::new(&ContextOptions::default()).unwrap(),
            registry: stage::registry(Some(&scene), &[]).unwrap(),
            scene,
            camera: None,
            time: 0.0,
            step: 0.0,
            size: [1280, 720],
            centred: true,
        };
        let text = "title = 'depth'\ntransport = 'emission'\noutput = 'debug_view.color'\n\
                    [pass.gbuffer_traced]\n[pass.debug_view]\nin.surface = 'gbuffer_traced.surface'\nin.motion = 'gbuffer_traced.motion'\n";
        let document = Document::parse(Source::new("depth.toml", text), &Shelf::default()).unwrap();
        let mut subject = stage.subject(&document, None, 0).unwrap();
        subject.begin(1).unwrap();
        // What is still under way now is waited for by this; asking for nothing more shows whether there was anything.
        let idle = Arc::new(AtomicBool::new(false));
        let seen = idle.clone();
        stage.context.queue().on_submitted_work_done(move || seen.store(true, Ordering::SeqCst));
        stage.context.queue().submit([]);
        assert!(idle.load(Ordering::SeqCst), "memory is still being cleared");
    }
}
