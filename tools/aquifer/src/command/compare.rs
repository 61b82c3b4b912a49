//! `aquifer compare A [B …] --scene S [S2 …]`

mod entrants;
mod jobs;
mod scenes;
mod words;

use crate::{
    cli::VERSION,
    failure::Failure,
    source::{AdapterArgs, ShaderArgs, built_in, cache_folder, text_of},
    ui::Ui,
    value,
    watch::Watch,
};
use aquifer_graph::{Graph, Transport};
use aquifer_lab::{
    atomic,
    bench::auto,
    compare::{
        bench::Entrant,
        judge,
        report::{GraphFacts, Made, Protocol, Report, SCHEMA},
        scene::{Compared, Request, SceneFacts, compare_scene},
        subject::Stage,
    },
    page,
};
use aquifer_render::{Clock, Context};
use scenes::Place;
use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::{Instant, SystemTime, UNIX_EPOCH},
};

/// Which error is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum ProtocolName {
    /// One frame, after a warm-up
    Frame,
    /// The mean of more and more frames
    Accumulate,
    /// Each frame of an animation
    Trace,
}

/// Where in its pixel the film takes its sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum FilmChoice {
    /// The middle: antialiasing is nobody's error
    Centred,
    /// Anywhere, another place each frame: a single frame's jagged edges count as its error
    Jittered,
}

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Graphs, the baseline first: built-in ones or .toml files, with settings after commas (restir_di,spatial.taps=3)
    #[arg(required = true, value_name = "GRAPH")]
    graphs: Vec<String>,
    /// Scenes: built-in ones or .glb and .gltf files
    #[arg(long = "scene", required = true, num_args = 1.., value_name = "SCENE")]
    scenes: Vec<String>,
    /// Light from an equirectangular .exr or .hdr file, in place of the scenes' own environments
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// The scenes' camera of this name; without it the first
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Seconds into the animation: at the frame that is measured, or at the first of a trace
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    animation_time: f32,
    /// Seconds of animation from one frame to the next
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    step: f32,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "128x72", value_parser = value::size)]
    size: [u32; 2],
    /// Which light paths, for all graphs: emission, direct, indirect:N or full:N (N bounces)
    #[arg(long, value_name = "PATHS", value_parser = value::transport)]
    transport: Option<Transport>,
    /// Set a value of all graphs; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = value::setting)]
    settings: Vec<String>,
    /// Every graph with each of these values; repeatable, for every combination
    #[arg(long = "sweep", value_name = "KEY=VALUE,VALUE,…")]
    sweeps: Vec<String>,
    #[command(flatten)]
    shaders: ShaderArgs,
    #[command(flatten)]
    jobs: jobs::JobArgs,
    /// What is measured
    #[arg(long, value_enum, default_value = "frame", help_heading = "Protocol")]
    protocol: ProtocolName,
    /// Frames before the one that counts, for graphs with history (not in a trace)
    #[arg(long, value_name = "N", default_value_t = 32, help_heading = "Protocol")]
    warm_up: u32,
    /// Frames of a trace, or of the slowest graph's largest budget
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Protocol")]
    frames: u32,
    /// Independent repetitions
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Protocol")]
    seeds: u32,
    /// Milliseconds for every graph whose time can be chosen; without it, the frame time of those whose time cannot
    #[arg(long, value_name = "MS", value_parser = value::milliseconds, allow_negative_numbers = true, help_heading = "Protocol")]
    budget: Option<f64>,
    /// The mean square error to be reached, for the times of equal error [default: what every graph reaches]; only with growing budgets
    #[arg(long, value_name = "MSE", value_parser = value::error, allow_negative_numbers = true, help_heading = "Protocol")]
    equal_error: Option<f64>,
    /// Turn each biased switch of each graph on alone and off alone, for its share of the bias; only of one frame
    #[arg(long, help_heading = "Protocol")]
    explain_bias: bool,
    /// Where in its pixel the film takes its sample
    #[arg(long, value_enum, default_value = "centred", help_heading = "Protocol")]
    film: FilmChoice,
    /// Seed of all random numbers
    #[arg(long, value_name = "SEED", default_value_t = 0, help_heading = "Protocol")]
    seed: u64,
    /// Compare graphs of different light paths, each against its own reference; the report says so
    #[arg(long, help_heading = "Protocol")]
    force: bool,
    /// Largest share of the smallest error that the reference's own variance may be
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, value_parser = value::share, allow_negative_numbers = true, help_heading = "References")]
    reference_share: f64,
    /// Most samples of a reference
    #[arg(long, value_name = "N", default_value_t = 65_536, value_parser = clap::value_parser!(u64).range(1..), help_heading = "References")]
    reference_samples: u64,
    /// Folder where references are kept [default: aquifer in the user's cache folder]
    #[arg(long, value_name = "DIR", help_heading = "References")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Folder of the report; what it holds of the same comparison is gone on with
    #[arg(short, long, value_name = "DIR", default_value = "out/compare")]
    output: PathBuf,
    /// Print the report as JSON instead of words
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    args.refuse_unsuited()?;
    jobs::make_folder(&args)?;
    let entrants = entrants::swept(entrants::entrants(&args.graphs, &args.settings, args.transport)?, &args.sweeps)?;
    let places = scenes::places(&args.scenes, args.environment.as_ref());
    let report = match args.jobs.is_whole() {
        true => Some(args.compare(&entrants, &places, ui)?),
        false => args.jobs.run(&args, &entrants, &places, ui)?,
    };
    let Some(report) = report else { return Ok(()) };
    let began = Instant::now();
    page::write(&report, &args.output)?;
    let page_seconds = began.elapsed().as_secs_f64();
    report.warnings.iter().for_each(|warning| ui.warn(warning));
    ui.note(&format!("wrote {}", args.output.join("report.html").display()));
    ui.note(&words::overhead(&report.made, page_seconds));
    if args.json { ui.json(&report) } else { ui.print(&words::report(&report)) }
}

fn write_json(path: &Path, report: &Report) -> Result<(), Failure> {
    let text = serde_json::to_vec_pretty(report).map_err(|error| Failure::Failed(error.into()))?;
    Ok(atomic::write(path, &text)?)
}

impl Args {
    /// Measures these graphs on these scenes.
    fn compare(&self, entrants: &[Entrant], places: &[Place], ui: &Ui) -> Result<Report, Failure> {
        let context = self.adapter.open()?;
        let mut watch = Watch::new(ui);
        let mut report = Report { schema: SCHEMA, protocol: self.protocol(), ..Report::default() };
        let mut clock = Clock::Wall;
        for (index, place) in places.iter().enumerate() {
            let (stage, facts) = self.stage(place, &context, ui)?;
            let entrants = &self.choosing(entrants, &stage)?[..];
            if index == 0 {
                report.graphs = entrants.iter().map(|entrant| graph_facts(entrant, &stage)).collect::<Result<_, Failure>>()?;
                report.warnings.extend(self.refuse_unlike(&report.graphs)?);
            }
            let Compared { result, warnings, seconds, lab_seconds, clock: found } =
                compare_scene(&stage, entrants, &facts, &self.request()?, &mut watch)?;
            report.scenes.push(result);
            report.warnings.extend(warnings);
            report.made.measured_seconds += seconds;
            report.made.lab_seconds += lab_seconds;
            clock = found;
        }
        judge::decide(&mut report);
        report.warnings.extend(watch.finish());
        report.made = Made { clock: words::clock(clock).to_owned(), ..made(&context, report.made) };
        Ok(report)
    }

    /// Graphs that leave the choice of their tracer get the one that is faster on this scene.
    fn choosing(&self, entrants: &[Entrant], stage: &Stage) -> Result<Vec<Entrant>, Failure> {
        let mut entrants = entrants.to_vec();
        for entrant in entrants.iter_mut().filter(|entrant| auto::asked(&entrant.document)) {
            let tracer = auto::fastest(&stage.context, &stage.scene, &self.shaders.folders, &cache_folder())?;
            entrant.document.apply([auto::choice(&tracer)])?;
        }
        Ok(entrants)
    }

    /// What is asked for belongs to what is measured.
    fn refuse_unsuited(&self) -> Result<(), Failure> {
        if self.equal_error.is_some() && self.protocol != ProtocolName::Accumulate {
            return Err(Failure::new("--equal-error is of growing budgets: it needs --protocol accumulate"));
        }
        if self.explain_bias && self.protocol != ProtocolName::Frame {
            return Err(Failure::new("--explain-bias is of one frame: it needs --protocol frame"));
        }
        Ok(())
    }

    fn protocol(&self) -> Protocol {
        let (warm_up, frames, seeds, centred) = (self.warm_up, self.frames, self.seeds, self.film == FilmChoice::Centred);
        match self.protocol {
            ProtocolName::Frame => Protocol::Frame { warm_up, seeds, centred },
            ProtocolName::Accumulate => Protocol::Accumulate { warm_up, frames, seeds, centred },
            ProtocolName::Trace => Protocol::Trace { frames, step: self.step, seeds, centred },
        }
    }

    fn stage(&self, place: &Place, context: &Context, ui: &Ui) -> Result<(Stage, SceneFacts), Failure> {
        let source = &place.source;
        let scene = Arc::new(source.load(ui)?);
        let registry = self.shaders.registry(Some(&scene))?;
        let camera = self.camera.clone().or_else(|| scene.camera_names().into_iter().next()).unwrap_or_default();
        let facts = SceneFacts {
            name: place.name.clone(),
            identity: source.identity()?,
            content: source.content()?,
            environment: source.environment_identity()?,
            camera,
        };
        let stage = Stage {
            context: context.clone(),
            registry,
            scene,
            camera: self.camera.clone(),
            time: self.animation_time,
            step: self.step,
            size: self.size,
            centred: self.film == FilmChoice::Centred,
        };
        Ok((stage, facts))
    }

    fn request(&self) -> Result<Request, Failure> {
        Ok(Request {
            protocol: self.protocol(),
            budget_ms: self.budget,
            seed: self.seed,
            reference_share: self.reference_share,
            reference_samples: self.reference_samples,
            path_tracer: built_in("path_tracer")?,
            cache: self.cache.clone().unwrap_or_else(cache_folder),
            folder: self.output.clone(),
            explain_bias: self.explain_bias,
            equal_error: self.equal_error,
            version: VERSION.to_owned(),
        })
    }

    /// Only like is compared with like, unless forced; then the report says so.
    fn refuse_unlike(&self, graphs: &[GraphFacts]) -> Result<Option<String>, Failure> {
        let Some(other) = graphs.iter().find(|graph| graph.transport != graphs[0].transport) else { return Ok(None) };
        let first = &graphs[0];
        let unlike = format!("`{}` holds {} light and `{}` holds {}", first.name, first.transport, other.name, other.transport);
        if self.force {
            return Ok(Some(format!("compared by force: {unlike}; each is measured against its own reference")));
        }
        Err(Failure::new(format!(
            "{unlike}: only like is compared with like; --transport sets it for all, --force compares them all the same"
        )))
    }
}

fn graph_facts(entrant: &Entrant, stage: &Stage) -> Result<GraphFacts, Failure> {
    let graph = Graph::check(&entrant.document, &stage.registry)?;
    let line =
        |finding: aquifer_graph::BiasFinding| format!("{}: pass `{}`, {}: {}", finding.place, finding.pass, finding.what, finding.why);
    Ok(GraphFacts {
        name: entrant.name.clone(),
        title: graph.title().to_owned(),
        text: text_of(&graph),
        hash: graph.digest(),
        settings: entrant.settings.clone(),
        transport: graph.transport().to_string(),
        history: !aquifer_lab::capture::Capture::of(&graph).independent(),
        knob: graph.knob().map(|knob| format!("{}.{}", knob.pass, knob.param)),
        bias: graph.bias().into_iter().map(line).collect(),
    })
}

fn made(context: &Context, spent: Made) -> Made {
    let adapter = context.adapter();
    Made {
        version: VERSION.to_owned(),
        unix_time: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
        command: std::env::args().collect(),
        adapter: adapter.name.clone(),
        backend: adapter.backend.clone(),
        driver: adapter.driver.clone(),
        ..spent
    }
}
