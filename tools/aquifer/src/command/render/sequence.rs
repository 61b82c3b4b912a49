//! `--frames A..B`: an animation as numbered images.
//!
//! Without `--hold` this is what a game would show: one frame an image, history going on, running means cut off from the frames before. With `--hold N`
//! every image is a render of its own, of one moment. Each file is complete or not there, and those that are there stay when the user has had enough.

use super::{Args, job::Job, numbered::Numbered};
use crate::{
    failure::Failure,
    interrupt,
    progress::{Goal, Progress, State},
    ui::Ui,
};
use aquifer_graph::{Graph, Source};
use aquifer_lab::{atomic, capture};
use aquifer_render::View;
use std::{ops::Range, path::PathBuf, time::Instant};

pub fn run(args: &Args, range: Range<u32>, ui: &Ui) -> Result<(), Failure> {
    for (given, option) in [(args.time.is_some(), "--time"), (args.first_frame != 0, "--first-frame"), (args.watch, "--watch")] {
        if given {
            return Err(Failure::new(format!("{option} and a range of frames do not go together")));
        }
    }
    let names = args.outputs.iter().map(|path| Numbered::of(path)).collect::<Result<Vec<_>, _>>()?;
    for name in &names {
        atomic::check_writable(&name.at(range.start))?;
    }
    let hold = args.hold.unwrap_or(1);
    range.end.checked_mul(hold).ok_or_else(|| Failure::new("so many frames cannot be numbered: they end at 2³² / hold"))?;
    let view = View { time: args.animation_time, step: args.fps.recip(), ..View::default() };
    let edits = |graph: &Graph| if args.hold.is_none() { without_means(graph) } else { Vec::new() };
    let mut job = Job::at(args, view.clone(), range.start * hold, edits, ui)?;
    let goal = Goal { frames: Some(range.len() as u64), seconds: None };
    let mut progress = Progress::new(ui, goal);
    let (began, mut summaries) = (Instant::now(), Vec::new());
    for frame in range {
        if interrupt::asked() {
            break;
        }
        let image_began = Instant::now();
        if args.hold.is_some() {
            job.restart_at(frame * hold, view.time_at(frame))?;
        }
        let spent = job.frames(hold)?;
        let paths: Vec<PathBuf> = names.iter().map(|name| name.at(frame)).collect();
        summaries.push(job.write(&paths, spent, image_began)?);
        progress.update(State { frames: summaries.len() as u64, seconds: began.elapsed().as_secs_f64() });
    }
    progress.finish();
    if interrupt::asked() {
        ui.warn(&format!("interrupted: {} of {} images are written", summaries.len(), goal.frames.unwrap_or(0)));
    }
    ui.note(&format!("{} images in {:.2} s", summaries.len(), began.elapsed().as_secs_f64()));
    if args.json { ui.json(&summaries) } else { Ok(()) }
}

/// Settings that cut running means off from the frames before: what moves must not be averaged.
fn without_means(graph: &Graph) -> Vec<Source> {
    let cut = |(pass, input): (String, String)| Source::new("--frames A..B", format!("pass.{pass}.in.{input}=false"));
    capture::running_means(graph).into_iter().map(cut).collect()
}
