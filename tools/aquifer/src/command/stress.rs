//! `aquifer stress [GRAPH …]`

use crate::{
    cli::VERSION,
    failure::Failure,
    source::{AdapterArgs, GraphArgs, ShaderArgs, built_in, load_scene},
    ui::Ui,
};
use aquifer_graph::{Document, Transport};
use aquifer_lab::{
    atomic,
    stress::{self, Bench, Case, Effort, Pictures, Row},
};
use aquifer_render::Context;
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

/// The graph that knows the truth.
const BASELINE: &str = "path_tracer";

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Graphs: built-in ones or .toml files; without any, every built-in one that shows light
    #[arg(value_name = "GRAPH")]
    graphs: Vec<String>,
    /// Only this case; repeatable
    #[arg(long = "case", value_name = "CASE")]
    cases: Vec<String>,
    /// List the cases
    #[arg(long)]
    list: bool,
    /// Instead of cases, render so many frames of each graph with history (cornell, 32x18): does energy drift, does memory grow?
    #[arg(long, value_name = "FRAMES", value_parser = clap::value_parser!(u32).range(200..), conflicts_with_all = ["cases", "list", "output"])]
    long: Option<u32>,
    /// Most seeds of a row; fewer are taken where fewer tell enough
    #[arg(long, value_name = "N", default_value_t = Effort::default().seeds[1], value_parser = clap::value_parser!(u64).range(2..))]
    seeds: u64,
    /// Samples a pixel of the path tracer's picture
    #[arg(long, value_name = "N", default_value_t = Effort::default().truth)]
    truth_samples: u32,
    #[command(flatten)]
    shaders: ShaderArgs,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print the rows as JSON
    #[arg(long)]
    json: bool,
    /// Write stress.html, with pictures, and stress.json into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let cases = args.chosen()?;
    if args.list {
        return ui.print(&cases.iter().map(|case| format!("{:16} {}", case.name, case.about)).collect::<Vec<_>>().join("\n"));
    }
    if let Some(folder) = &args.output {
        std::fs::create_dir_all(folder).map_err(|error| Failure::new(format!("cannot make `{}`: {error}", folder.display())))?;
        atomic::check_writable(&folder.join("stress.html"))?;
    }
    let graphs = args.documents()?;
    let context = args.adapter.open()?;
    if let Some(frames) = args.long {
        return long(&graphs, frames, &context, args.json, ui);
    }
    let rows = args.rows(&cases, &graphs, &context, ui)?;
    if let Some(folder) = &args.output {
        write(&rows, &context, folder, ui)?;
    }
    let rows: Vec<Row> = rows.into_iter().map(|(row, _)| row).collect();
    if args.json {
        ui.json(&rows)?
    } else {
        ui.print(&stress::table(&rows))?
    }
    let wrong: Vec<String> = rows.iter().filter(|row| !row.is_as_known()).map(|row| format!("{} on {}", row.graph, row.case)).collect();
    match wrong.as_slice() {
        [] => Ok(()),
        _ => Err(Failure::new(format!("{} of {} rows are not as they should be: {}", wrong.len(), rows.len(), wrong.join(", ")))),
    }
}

fn long(graphs: &[(String, Document)], frames: u32, context: &Context, json: bool, ui: &Ui) -> Result<(), Failure> {
    let scene = Arc::new(load_scene("cornell", None)?);
    let mut runs = Vec::new();
    for (name, document) in graphs {
        if let Some(run) = stress::long(context, &scene, (name, document), Case::SMALL, frames)? {
            if json {
                ui.note(&run.sentence())
            } else {
                ui.print(&run.sentence())?
            }
            runs.push(run);
        }
    }
    if json {
        ui.json(&runs)?;
    }
    let wrong: Vec<&str> = runs.iter().filter(|run| !run.is_good()).map(|run| run.graph.as_str()).collect();
    if wrong.is_empty() { Ok(()) } else { Err(Failure::new(format!("not as it should be: {}", wrong.join(", ")))) }
}

fn document(name: &str) -> Result<Document, Failure> {
    let shaders = ShaderArgs::default();
    GraphArgs { graph: name.to_owned(), settings: Vec::new(), transport: None, shaders }.document()
}

fn write(rows: &[(Row, Option<Pictures>)], context: &Context, folder: &Path, ui: &Ui) -> Result<(), Failure> {
    let failed = |error: Box<dyn std::error::Error>| Failure::Failed(error);
    let html = stress::page(rows, &context.adapter().name, VERSION).map_err(|error| failed(error.into()))?;
    let list: Vec<&Row> = rows.iter().map(|(row, _)| row).collect();
    let json = serde_json::to_string_pretty(&list).map_err(|error| failed(error.into()))?;
    atomic::write(&folder.join("stress.json"), json.as_bytes())?;
    atomic::write(&folder.join("stress.html"), html.as_bytes())?;
    ui.note(&format!("wrote {}", folder.join("stress.html").display()));
    Ok(())
}

impl Args {
    fn chosen(&self) -> Result<Vec<&'static Case>, Failure> {
        let find = |name: &String| {
            let known = || stress::all().map(|case| case.name);
            stress::by_name(name).ok_or_else(|| match aquifer_graph::nearest(name, known()) {
                Some(near) => Failure::new(format!("there is no case `{name}`; did you mean `{near}`?")),
                None => Failure::new(format!("there is no case `{name}`; there are: {}", known().collect::<Vec<_>>().join(", "))),
            })
        };
        if self.cases.is_empty() { Ok(stress::all().collect()) } else { self.cases.iter().map(find).collect() }
    }

    /// Names and texts of the graphs.
    fn documents(&self) -> Result<Vec<(String, Document)>, Failure> {
        let builtin = || aquifer_graphs::files().into_iter().map(|(file, _)| file.trim_end_matches(".toml").to_owned()).collect();
        let names: Vec<String> = if self.graphs.is_empty() { builtin() } else { self.graphs.clone() };
        let mut graphs = Vec::new();
        for name in names {
            let document = document(&name)?;
            if !self.graphs.is_empty() || shows_light(&name)? {
                graphs.push((name, document));
            }
        }
        Ok(graphs)
    }

    fn rows(
        &self,
        cases: &[&'static Case],
        graphs: &[(String, Document)],
        context: &Context,
        ui: &Ui,
    ) -> Result<Vec<(Row, Option<Pictures>)>, Failure> {
        let effort = Effort { seeds: [Effort::default().seeds[0].min(self.seeds), self.seeds], truth: self.truth_samples };
        let baseline = built_in(BASELINE)?;
        let mut rows = Vec::new();
        for case in cases {
            let mut bench = Bench::new(context, case, &baseline, effort, &self.shaders.folders);
            for (name, document) in graphs {
                let found = bench.run(name, document)?;
                ui.note(&found.0.sentence());
                rows.push(found);
            }
        }
        Ok(rows)
    }
}

/// Its picture holds scattered light.
fn shows_light(name: &str) -> Result<bool, Failure> {
    let shaders = ShaderArgs::default();
    let graph = GraphArgs { graph: name.to_owned(), settings: Vec::new(), transport: None, shaders };
    Ok(graph.check(None)?.0.transport() != Transport::Emission)
}
