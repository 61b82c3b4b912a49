//! `--watch`: renders and writes again whenever graph or shaders change. What is broken leaves the last good graph as it was.

use super::{Args, job::Job};
use crate::{failure::Failure, interrupt, source::file_of, ui::Ui};
use aquifer_graph::Source;
use aquifer_lab::watch::{Watch, Watched};
use std::{
    cell::Cell,
    time::{Duration, Instant},
};

/// How often Ctrl-C is looked for while nothing changes.
const LOOK: Duration = Duration::from_millis(200);

pub fn run(args: &Args, mut job: Job<'_>, ui: &Ui) -> Result<(), Failure> {
    let mut watch = Watch::new()?;
    watch.follow(&watched(args, job.graph().sources().iter()))?;
    let mut changed = render(args, &mut job, &watch, ui)?;
    while changed || wait(&watch) {
        changed = match job.reload() {
            Ok(()) => {
                watch.follow(&watched(args, job.graph().sources().iter()))?;
                render(args, &mut job, &watch, ui)?
            }
            Err(failure) => {
                failure.report(ui);
                ui.note("the last good graph stays");
                if let Failure::Graph(faults) = &failure {
                    // The cure may lie in a file that only the faulty graph names.
                    watch.follow(&watched(args, job.graph().sources().iter().chain(faults.sources.iter())))?;
                }
                false
            }
        };
    }
    Ok(())
}

/// Waits for a change; false when the user has had enough.
fn wait(watch: &Watch) -> bool {
    while !interrupt::asked() {
        if watch.wait(LOOK) {
            return true;
        }
    }
    false
}

/// Renders and writes; true when a change came before the end.
fn render(args: &Args, job: &mut Job<'_>, watch: &Watch, ui: &Ui) -> Result<bool, Failure> {
    let (began, changed) = (Instant::now(), Cell::new(false));
    let spent = job.render(args.goal(), ui, || {
        changed.set(watch.changed());
        changed.get()
    })?;
    if changed.get() {
        return Ok(true);
    }
    let summary = job.write(&args.outputs, spent, began)?;
    ui.note(&summary.sentence());
    if args.json {
        ui.json(&summary)?;
    }
    Ok(false)
}

/// The files of a graph, and the folders of shaders.
fn watched<'a>(args: &Args, sources: impl Iterator<Item = &'a Source>) -> Watched {
    Watched { files: sources.filter_map(file_of).collect(), folders: args.graph.shaders.folders.clone() }
}
