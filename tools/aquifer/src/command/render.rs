//! `aquifer render GRAPH`

mod summary;

use crate::{
    failure::Failure,
    interrupt,
    progress::{Goal, Progress, State},
    source::{GraphArgs, SceneArgs, text_of},
    ui::Ui,
    value,
};
use aquifer_graph::{Graph, NeedsAll, Plan};
use aquifer_lab::{
    atomic,
    capture::Capture,
    film::{Facts, Film, Format, GraphText, Runs},
    rays::RayCounters,
};
use aquifer_render::{Context, ContextOptions, Registry, Renderer, RendererOptions, SceneGlobals, View};
use aquifer_scene::Scene;
use std::{path::PathBuf, sync::Arc, time::Instant};
use summary::Summary;

/// Frames where neither --frames nor --time says anything.
const FRAMES: u32 = 64;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    graph: GraphArgs,
    #[command(flatten)]
    scene: SceneArgs,
    /// The scene's camera of this name; without it the first
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Seconds into the scene's animation
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    animation_time: f32,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = value::size)]
    size: [u32; 2],
    /// Stop after so many frames [default: 64, or no end where --time is given]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// Stop after so many seconds of rendering
    #[arg(long, value_name = "SECONDS", value_parser = value::seconds, allow_negative_numbers = true)]
    time: Option<f64>,
    /// Number of the first frame: other frames of one seed are other samples
    #[arg(long, value_name = "N", default_value_t = 0)]
    first_frame: u32,
    /// Seed of all random numbers: other seeds are other samples
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    seed: u64,
    /// The graphics adapter whose name contains this (see `aquifer adapters`)
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Where to write: .exr (radiance, its variance, what made it) or .png (the picture); repeatable
    #[arg(short, long = "output", value_name = "FILE", value_parser = value::image, required_unless_present = "json")]
    outputs: Vec<PathBuf>,
    /// Print what was done as JSON: samples, seconds, time of each pass, memory
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let began = Instant::now();
    for path in &args.outputs {
        atomic::check_writable(path)?;
    }
    let scene = Arc::new(args.scene.load(ui)?);
    let (graph, registry) = args.graph.check(Some(&scene))?;
    let capture = Capture::of(&graph);
    let rays = RayCounters::of(&graph);
    let keep: Vec<&str> = capture.keep().into_iter().chain(rays.keep()).collect();
    let plan = graph.plan(&NeedsAll, &keep)?;
    let mut renderer = args.renderer(&scene, &registry, plan)?;
    let spent = args.render(&mut renderer, ui)?;
    let facts = args.facts(&graph, &capture, &scene, &renderer, spent)?;
    let film = Film { facts: Some(facts), ..capture.radiance(&mut renderer)? };
    args.write(&film, &capture, &mut renderer)?;
    let rays = rays.read(&mut renderer)?;
    let summary = Summary::new(&graph, &film, &renderer, rays, spent.frames, began, &args.outputs);
    ui.note(&summary.sentence());
    if args.json { ui.json(&summary) } else { Ok(()) }
}

impl Args {
    fn renderer(&self, scene: &Arc<Scene>, registry: &Registry, plan: Plan) -> Result<Renderer, Failure> {
        let context = Context::new(&ContextOptions { adapter: self.adapter.clone(), ..ContextOptions::default() })?;
        let view = View { camera: self.camera.clone(), time: self.animation_time, ..View::default() };
        let globals = SceneGlobals::new(&context, scene.clone(), view)?;
        let options = RendererOptions { size: self.size, seed: self.seed, first_frame: self.first_frame, ..RendererOptions::default() };
        Ok(Renderer::new(&context, registry, plan, Box::new(globals), options)?)
    }

    fn goal(&self) -> Goal {
        let frames = self.frames.or(self.time.is_none().then_some(FRAMES));
        Goal { frames: frames.map(u64::from), seconds: self.time }
    }

    /// Renders until the goal is reached or the user has had enough.
    fn render(&self, renderer: &mut Renderer, ui: &Ui) -> Result<State, Failure> {
        interrupt::listen();
        let mut progress = Progress::new(ui, self.goal());
        let began = Instant::now();
        let mut state = State { frames: 0, seconds: 0.0 };
        while !self.goal().is_reached(state) && !interrupt::asked() {
            renderer.frame()?;
            state = State { frames: state.frames + 1, seconds: began.elapsed().as_secs_f64() };
            progress.update(state);
        }
        renderer.finish()?;
        progress.finish();
        match state.frames {
            0 => Err(Failure::new("interrupted before the first frame: nothing was written")),
            _ if interrupt::asked() => {
                ui.warn(&format!("interrupted: writing the {} frames that are done", state.frames));
                Ok(State { seconds: began.elapsed().as_secs_f64(), ..state })
            }
            _ => Ok(State { seconds: began.elapsed().as_secs_f64(), ..state }),
        }
    }

    fn facts(&self, graph: &Graph, capture: &Capture, scene: &Scene, renderer: &Renderer, spent: State) -> Result<Facts, Failure> {
        // Without a mean over frames, the film is that of the last one.
        let frames = if capture.averages() { spent.frames } else { 1 };
        let first_frame = u64::from(self.first_frame) + spent.frames - frames;
        let camera = self.camera.clone().or_else(|| scene.camera_names().into_iter().next()).unwrap_or_default();
        Ok(Facts {
            samples_per_pixel: u32::try_from(frames).unwrap_or(u32::MAX).saturating_mul(Capture::samples_per_frame(graph)),
            render_seconds: spent.seconds,
            graph: GraphText { text: text_of(graph), hash: graph.digest() },
            scene: self.scene.identity()?,
            environment: self.scene.environment_identity()?,
            camera,
            animation_time: self.animation_time,
            transport: graph.transport().to_string(),
            runs: Runs::one(self.seed, first_frame, frames),
            adapter: renderer.context().adapter().name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        })
    }

    fn write(&self, film: &Film, capture: &Capture, renderer: &mut Renderer) -> Result<(), Failure> {
        for path in &self.outputs {
            match Format::of(path)? {
                Format::Exr => film.write(path)?,
                Format::Png => capture.display(renderer)?.write(path)?,
            }
        }
        Ok(())
    }
}
