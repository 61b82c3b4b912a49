//! A graph that renders a scene, with what is taken off it.

use super::{Args, summary::Summary};
use crate::{
    cli::VERSION,
    failure::Failure,
    interrupt,
    progress::{Goal, Progress, State},
    source::{GraphArgs, text_of},
    ui::Ui,
};
use aquifer_graph::{Graph, Plan, Source};
use aquifer_lab::{
    capture::Capture,
    film::{Facts, Film, Format, GraphText, Runs},
    first_surface::FirstSurface,
    rays::RayCounters,
};
use aquifer_render::{Registry, Renderer, RendererOptions, SceneGlobals, View};
use aquifer_scene::{Camera, Scene};
use std::{
    path::PathBuf,
    sync::Arc,
    time::{Duration, Instant},
};

/// The number after that of the last frame there can be.
pub const FRAMES_END: u64 = 1 << 32;

/// The scene, the graph, and the renderer that holds both.
pub struct Job<'a> {
    args: &'a Args,
    source: GraphArgs,
    scene: Arc<Scene>,
    /// The scene as it was read, and the environment over it, as films name them.
    identity: (String, Option<String>),
    view: View,
    graph: Graph,
    taken: Taken,
    renderer: Renderer,
}

/// What is taken off a graph.
struct Taken {
    capture: Capture,
    surface: FirstSurface,
    rays: RayCounters,
}

impl<'a> Job<'a> {
    /// What the arguments ask for, at one moment.
    pub fn new(args: &'a Args, ui: &Ui) -> Result<Self, Failure> {
        let view = View { time: args.animation_time, ..View::default() };
        Self::at(args, view, args.first_frame, |_| Vec::new(), ui)
    }

    /// What the arguments ask for, as time goes by; `edits` have the last word on the graph.
    pub fn at(args: &'a Args, view: View, first_frame: u32, edits: impl FnOnce(&Graph) -> Vec<Source>, ui: &Ui) -> Result<Self, Failure> {
        let scene = Arc::new(args.scene.load(ui)?);
        let identity = (args.scene.identity()?, args.scene.environment_identity()?);
        let (mut graph, mut registry) = args.graph.check(Some(&scene))?;
        let edits = edits(&graph);
        let context = args.adapter.open()?;
        let source = args.graph.choosing(&context, &scene)?;
        if !edits.is_empty() || source.settings != args.graph.settings {
            (graph, registry) = source.check_with(Some(&scene), edits)?;
        }
        let (taken, plan) = planned(&graph, &registry)?;
        let view = View { camera: args.camera.clone(), free: looking(args, &scene)?, ..view };
        let globals = SceneGlobals::keeping(&context, scene.clone(), view.clone(), &args.graph.shaders.features(&scene))?;
        let options =
            RendererOptions { size: args.size, seed: args.seed, first_frame, counters: args.counters, ..RendererOptions::default() };
        let renderer = Renderer::new(&context, &registry, plan, Box::new(globals), options)?;
        Ok(Self { args, source, scene, identity, view, graph, taken, renderer })
    }

    /// Reads graph and shaders anew. When something is wrong with them, everything stays as it was.
    pub fn reload(&mut self) -> Result<(), Failure> {
        let (graph, registry) = self.source.check(Some(&self.scene))?;
        let (taken, plan) = planned(&graph, &registry)?;
        self.renderer.replace_plan(&registry, plan)?;
        (self.graph, self.taken) = (graph, taken);
        Ok(())
    }

    /// The graph that renders.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Begins anew at that frame, with all frames at one time.
    pub fn restart_at(&mut self, first_frame: u32, time: f32) -> Result<(), Failure> {
        self.view = View { time, step: 0.0, ..self.view.clone() };
        self.renderer.set_time(time, 0.0);
        Ok(self.renderer.restart_at(first_frame)?)
    }

    /// Renders until the goal is reached, the user has had enough, or `stop` says so.
    pub fn render(&mut self, goal: Goal, ui: &Ui, stop: impl Fn() -> bool) -> Result<State, Failure> {
        let mut progress = Progress::new(ui, goal);
        let began = Instant::now();
        let mut state = State { frames: 0, seconds: 0.0 };
        let most = FRAMES_END - u64::from(self.renderer.options().first_frame);
        while !goal.is_reached(state) && state.frames < most && !interrupt::asked() && !stop() {
            self.renderer.frame()?;
            state = State { frames: state.frames + 1, seconds: began.elapsed().as_secs_f64() };
            progress.update(state);
        }
        self.renderer.finish()?;
        progress.finish();
        if state.frames == most && !goal.is_reached(state) {
            ui.warn("the numbers of frames end at 2³²: the render ends before its time");
        }
        match state.frames {
            0 if interrupt::asked() => Err(Failure::new("interrupted before the first frame: nothing was written")),
            _ if interrupt::asked() => {
                ui.warn(&format!("interrupted: writing the {} frames that are done", state.frames));
                Ok(State { seconds: began.elapsed().as_secs_f64(), ..state })
            }
            _ => Ok(State { seconds: began.elapsed().as_secs_f64(), ..state }),
        }
    }

    /// Renders so many frames, in silence.
    pub fn frames(&mut self, count: u32) -> Result<State, Failure> {
        let began = Instant::now();
        for _ in 0..count {
            self.renderer.frame()?;
        }
        self.renderer.finish()?;
        Ok(State { frames: count.into(), seconds: began.elapsed().as_secs_f64() })
    }

    /// Writes what the last frames gave to files; `began` is when the way to them did.
    pub fn write(&mut self, paths: &[PathBuf], spent: State, began: Instant) -> Result<Summary, Failure> {
        let facts = self.facts(spent);
        let set_up = began.elapsed().saturating_sub(Duration::from_secs_f64(spent.seconds));
        let named = self.scene.at(facts.animation_time, self.view.camera.as_deref())?.camera;
        let camera = self.view.free.unwrap_or(named);
        let Taken { capture, surface, rays } = &self.taken;
        let film = Film { facts: Some(facts), ..capture.radiance(&mut self.renderer)? };
        let film = surface.add_to(film, &mut self.renderer, &camera)?;
        for path in paths {
            match Format::of(path)? {
                Format::Exr => film.write(path)?,
                Format::Png => capture.display(&mut self.renderer)?.write(path)?,
            }
        }
        let rays = rays.read(&mut self.renderer)?;
        let counts = self.renderer.counts()?;
        Ok(Summary::new(&self.graph, &film, &self.renderer, (rays, counts), spent.frames, set_up, paths))
    }

    fn facts(&self, spent: State) -> Facts {
        // Without a mean over frames, the film is that of the last one.
        let frames = if self.taken.capture.averages() { spent.frames } else { 1 };
        let last = self.renderer.next_frame().wrapping_sub(1);
        let name = self.view.camera.clone().or_else(|| self.scene.camera_names().into_iter().next()).unwrap_or_default();
        let camera = self.args.look.map_or(name, |[from, at]| format!("{from:?} looking at {at:?}"));
        Facts {
            samples_per_pixel: u32::try_from(frames).unwrap_or(u32::MAX).saturating_mul(Capture::samples_per_frame(&self.graph)),
            render_seconds: spent.seconds,
            graph: GraphText { text: text_of(&self.graph), hash: self.graph.digest() },
            scene: self.identity.0.clone(),
            environment: self.identity.1.clone(),
            camera,
            animation_time: self.view.time_at(last),
            transport: self.graph.transport().to_string(),
            runs: Runs::one(self.args.seed, u64::from(last) + 1 - frames, frames),
            adapter: self.renderer.context().adapter().name.clone(),
            version: VERSION.to_owned(),
        }
    }
}

/// The camera that `--look` puts up. What is typed are points of the world, which moments count from their origin.
fn looking(args: &Args, scene: &Scene) -> Result<Option<Camera>, Failure> {
    let Some(points) = args.look else { return Ok(None) };
    let moment = scene.at(args.animation_time, args.camera.as_deref())?;
    let origin = moment.origin.to_array();
    let near = |point: [f32; 3]| std::array::from_fn::<f32, 3, _>(|axis| (f64::from(point[axis]) - origin[axis]) as f32);
    let [from, at] = points.map(near);
    let camera = moment.camera.looking(from.into(), at.into());
    camera.map(Some).ok_or_else(|| Failure::new("--look needs two points, one not straight above the other"))
}

/// What is taken off a graph, and the plan that keeps it.
fn planned(graph: &Graph, registry: &Registry) -> Result<(Taken, Plan), Failure> {
    let taken = Taken { capture: Capture::of(graph), surface: FirstSurface::of(graph), rays: RayCounters::of(graph) };
    let keep: Vec<&str> = taken.capture.keep().into_iter().chain(taken.surface.keep()).chain(taken.rays.keep()).collect();
    let plan = graph.plan(registry, &keep)?;
    Ok((taken, plan))
}
