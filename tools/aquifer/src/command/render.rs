//! `aquifer render GRAPH`

mod job;
mod numbered;
mod sequence;
mod summary;
mod watch;

use crate::{
    failure::Failure,
    interrupt,
    progress::Goal,
    source::{AdapterArgs, GraphArgs, SceneArgs},
    ui::Ui,
    value::{self, Frames},
};
use aquifer_lab::atomic;
use job::{FRAMES_END, Job};
use std::{path::PathBuf, time::Instant};

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
    /// Where the camera stands and what it looks at, in place of where the scene has it; the lens stays
    #[arg(long, value_name = "X,Y,Z:X,Y,Z", value_parser = value::look, allow_hyphen_values = true)]
    look: Option<[[f32; 3]; 2]>,
    /// Seconds into the scene's animation
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    animation_time: f32,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = value::size)]
    size: [u32; 2],
    /// N: stop after so many frames [default: 64, or no end where --time is given]. A..B: write the frames A to B−1 of the animation, one image each;
    /// the name of the output then says where their numbers go, as `####` or `{frame}`
    #[arg(long, value_name = "N|A..B", value_parser = value::frames)]
    frames: Option<Frames>,
    /// Of a sequence: frames in a second of the animation
    #[arg(long, value_name = "RATE", default_value_t = 24.0, value_parser = value::rate, help_heading = "Sequences (--frames A..B)")]
    fps: f32,
    /// Of a sequence: each image is the mean of so many frames of its moment, with no history from the image before; without it each image is one
    /// frame, and history goes on from image to image
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Sequences (--frames A..B)")]
    hold: Option<u32>,
    /// Stop after so many seconds of rendering
    #[arg(long, value_name = "SECONDS", value_parser = value::seconds, allow_negative_numbers = true)]
    time: Option<f64>,
    /// Number of the first frame: other frames of one seed are other samples
    #[arg(long, value_name = "N", default_value_t = 0)]
    first_frame: u32,
    /// Seed of all random numbers: other seeds are other samples
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Where to write: .exr (radiance, its variance, what made it) or .png (the picture); repeatable
    #[arg(short, long = "output", value_name = "FILE", value_parser = value::image, required_unless_present = "json")]
    outputs: Vec<PathBuf>,
    /// Render and write again whenever the graph or a file of --shaders changes, until Ctrl-C; what is broken is told, and the last good graph stays
    #[arg(long)]
    watch: bool,
    /// Count the NaNs and infinities in what each pass writes, and tell which passes have any; the picture stays the same to the bit
    #[arg(long)]
    counters: bool,
    /// Print what was done as JSON: samples, seconds, time of each pass, memory
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let began = Instant::now();
    interrupt::listen();
    if let Some(Frames::Range(range)) = &args.frames {
        return sequence::run(&args, range.clone(), ui);
    }
    if u64::from(args.first_frame) + args.goal().frames.unwrap_or(1) > FRAMES_END {
        return Err(Failure::new("so many frames from --first-frame on cannot be numbered: they end at 2³²"));
    }
    for path in &args.outputs {
        atomic::check_writable(path)?;
    }
    let mut job = Job::new(&args, ui)?;
    if args.watch {
        return watch::run(&args, job, ui);
    }
    let spent = job.render(args.goal(), ui, || false)?;
    let summary = job.write(&args.outputs, spent, began)?;
    ui.note(&summary.sentence());
    if args.counters {
        ui.note(&summary.counted());
    }
    if args.json { ui.json(&summary) } else { Ok(()) }
}

impl Args {
    fn goal(&self) -> Goal {
        let frames = match self.frames {
            Some(Frames::Count(count)) => Some(count),
            _ => self.time.is_none().then_some(FRAMES),
        };
        Goal { frames: frames.map(u64::from), seconds: self.time }
    }
}
