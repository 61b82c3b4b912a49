//! A comparison in pieces for batch systems: one job for every graph on every scene, each at its own frame time.
//!
//! A job's name follows from what it does, what graph, scene and shaders hold included; its result is a report of its own that appears by renaming,
//! and nothing else is shared but files.

use super::{Args, scenes::Place};
use crate::{failure::Failure, ui::Ui};
use aquifer_lab::{
    atomic,
    compare::{
        bench::Entrant,
        judge,
        report::{Explained, Report, SceneResult},
    },
};
use std::path::PathBuf;

/// Variables in which batch systems number the members of an array, from 0 (Slurm's from wherever the array begins).
const INDICES: [&str; 3] = ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "AWS_BATCH_JOB_ARRAY_INDEX"];

/// What is to be done with the jobs.
#[derive(Debug, clap::Args)]
#[group(multiple = false)]
pub struct JobArgs {
    /// Print the jobs of this comparison, one a line, instead of running it: number, name, scene, graph
    #[arg(long, help_heading = "Jobs")]
    plan: bool,
    /// Run the job of this number; without a number, that of the batch system's variable
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "", help_heading = "Jobs")]
    index: Option<String>,
    /// Run every job whose number leaves I when divided by N
    #[arg(long, value_name = "I/N", value_parser = shard, help_heading = "Jobs")]
    shard: Option<(usize, usize)>,
    /// Print which jobs are done
    #[arg(long, help_heading = "Jobs")]
    status: bool,
    /// Make one report of the jobs that are done
    #[arg(long, help_heading = "Jobs")]
    merge: bool,
}

/// One graph on one scene.
struct Job<'a> {
    id: String,
    place: &'a Place,
    entrant: &'a Entrant,
    /// Its report.
    path: PathBuf,
}

fn shard(text: &str) -> Result<(usize, usize), String> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    parts.filter(|(i, n): &(usize, usize)| i < n).ok_or_else(|| "write I/N with I from 0 to N - 1, e.g. 0/4".to_owned())
}

impl JobArgs {
    /// Does what is asked with the jobs; the report to go on with, or `None` when that was all.
    pub fn run(&self, args: &Args, entrants: &[Entrant], places: &[Place], ui: &Ui) -> Result<Option<Report>, Failure> {
        let jobs = jobs(args, entrants, places)?;
        if self.plan {
            let line = |(number, job): (usize, &Job<'_>)| format!("{number}\t{}\t{}\t{}", job.id, job.place.source.scene, job.entrant.name);
            ui.print(&jobs.iter().enumerate().map(line).collect::<Vec<_>>().join("\n"))?;
        } else if self.status {
            let word = |job: &Job<'_>| if job.path.exists() { "done" } else { "missing" };
            let line = |(number, job): (usize, &Job<'_>)| {
                format!("{number}\t{}\t{}\t{}\t{}", job.id, word(job), job.place.source.scene, job.entrant.name)
            };
            ui.print(&jobs.iter().enumerate().map(line).collect::<Vec<_>>().join("\n"))?;
        } else if self.merge {
            return merge(args, entrants, &jobs).map(Some);
        } else {
            for number in self.chosen(jobs.len())? {
                let job = &jobs[number];
                if job.path.exists() {
                    ui.note(&format!("job {number} ({}) is done", job.id));
                    continue;
                }
                let report = args.compare(std::slice::from_ref(job.entrant), std::slice::from_ref(job.place), ui)?;
                super::write_json(&job.path, &report)?;
                ui.note(&format!("job {number}: wrote {}", job.path.display()));
            }
        }
        Ok(None)
    }

    /// Nothing is asked: the comparison runs as a whole.
    pub fn is_whole(&self) -> bool {
        !(self.plan || self.status || self.merge) && self.index.is_none() && self.shard.is_none()
    }

    fn chosen(&self, count: usize) -> Result<Vec<usize>, Failure> {
        if let Some((remainder, divisor)) = self.shard {
            return Ok((0..count).filter(|number| number % divisor == remainder).collect());
        }
        let typed = self.index.clone().unwrap_or_default();
        let text = if typed.is_empty() { INDICES.iter().find_map(|name| std::env::var(name).ok()).unwrap_or_default() } else { typed };
        match text.parse::<usize>() {
            Ok(number) if number < count => Ok(vec![number]),
            Ok(number) => Err(Failure::new(format!("there is no job {number}: --plan shows 0 to {}", count - 1))),
            Err(_) if text.is_empty() => {
                Err(Failure::new(format!("--index needs a number, or one of the variables {}", INDICES.join(", "))))
            }
            Err(_) => Err(Failure::new(format!("`{text}` is no number of a job"))),
        }
    }
}

fn jobs<'a>(args: &Args, entrants: &'a [Entrant], places: &'a [Place]) -> Result<Vec<Job<'a>>, Failure> {
    let folder = args.output.join("jobs");
    let request = args.request()?;
    let view = (&args.camera, args.animation_time, args.step, args.size);
    let reference = (request.reference_share, request.reference_samples, &request.path_tracer);
    let asked = (view, args.protocol(), args.budget, args.seed, args.explain_bias, args.shaders.content()?, reference);
    let mut jobs = Vec::new();
    for place in places {
        let scene = (&place.name, place.source.content()?, place.source.environment_identity()?);
        for entrant in entrants {
            let what = format!("{scene:?} {asked:?} {:?} {:?}", entrant.name, entrant.document);
            let id = blake3::hash(what.as_bytes()).to_hex()[..12].to_owned();
            jobs.push(Job { path: folder.join(format!("{id}.json")), id, place, entrant });
        }
    }
    Ok(jobs)
}

/// One report of all jobs, in the order of the plan; what is not of one kind is refused.
fn merge(args: &Args, entrants: &[Entrant], jobs: &[Job<'_>]) -> Result<Report, Failure> {
    let mut merged = Report { schema: aquifer_lab::compare::report::SCHEMA, protocol: args.protocol(), ..Report::default() };
    let missing = jobs.iter().filter(|job| !job.path.exists()).count();
    if missing > 0 {
        return Err(Failure::new(format!("{missing} of {} jobs are missing: --status shows which", jobs.len())));
    }
    for job in jobs {
        let report = read(job)?;
        let (facts, scene) = match (report.graphs.into_iter().next(), report.scenes.into_iter().next()) {
            (Some(facts), Some(scene)) => (facts, scene),
            _ => return Err(Failure::new(format!("`{}` holds no result", job.path.display()))),
        };
        if merged.made.adapter.is_empty() {
            merged.made = report.made.clone();
        } else if (&merged.made.adapter, &merged.made.clock) != (&report.made.adapter, &report.made.clock) {
            let [a, b] = [&merged.made, &report.made].map(|made| format!("{} by {}", made.adapter, made.clock));
            return Err(Failure::new(format!(
                "`{}` was timed on {b}, others on {a}: times of different adapters are not merged",
                job.path.display()
            )));
        }
        let graph = entrants.iter().position(|entrant| entrant.name == job.entrant.name).unwrap_or(0);
        if merged.graphs.len() == graph {
            merged.graphs.push(facts);
        }
        merged.warnings.extend(report.warnings);
        add(&mut merged.scenes, scene, graph);
    }
    let names: Vec<String> = merged.graphs.iter().map(|graph| graph.name.clone()).collect();
    for scene in &mut merged.scenes {
        judge::weigh(scene, &names, merged.protocol, args.equal_error);
    }
    judge::decide(&mut merged);
    Ok(merged)
}

fn read(job: &Job<'_>) -> Result<Report, Failure> {
    let unreadable = |error: String| Failure::new(format!("`{}`: {error}", job.path.display()));
    let text = std::fs::read(&job.path).map_err(|error| unreadable(error.to_string()))?;
    serde_json::from_slice(&text).map_err(|error| unreadable(error.to_string()))
}

/// Adds one job's cells to those of its scene.
fn add(scenes: &mut Vec<SceneResult>, job: SceneResult, graph: usize) {
    let mut job = job;
    let at = scenes.iter().position(|scene| scene.name == job.name).unwrap_or_else(|| {
        scenes.push(SceneResult { cells: vec![], references: vec![], pairs: vec![], explained: vec![], ..job.clone() });
        scenes.len() - 1
    });
    let first = scenes[at].references.len();
    scenes[at].references.append(&mut job.references);
    scenes[at].explained.extend(job.explained.into_iter().map(|explained| Explained { graph, ..explained }));
    scenes[at].cells.extend(job.cells.into_iter().map(|mut cell| {
        cell.graph = graph;
        cell.reference += first;
        cell
    }));
}

/// Makes the folder of results.
pub fn make_folder(args: &Args) -> Result<(), Failure> {
    let folder = args.output.join("jobs");
    std::fs::create_dir_all(&folder).map_err(|error| Failure::new(format!("cannot make `{}`: {error}", folder.display())))?;
    Ok(atomic::check_writable(&folder.join("0.json"))?)
}
