//! `aquifer regress [GRAPH …]`

use crate::{
    failure::Failure,
    source::{GraphArgs, SceneArgs, ShaderArgs},
    ui::Ui,
    value,
};
use aquifer_graph::Transport;
use aquifer_lab::{
    atomic,
    compare::subject::Stage,
    film::Film,
    regress::{compare, difference, picture},
};
use aquifer_render::{Context, ContextOptions};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Graphs: built-in ones or .toml files; without any, those whose pictures are in the folder
    #[arg(value_name = "GRAPH")]
    graphs: Vec<String>,
    /// Folder of the pictures that are wanted, one a graph
    #[arg(long, value_name = "DIR", default_value = "tests/golden")]
    golden: PathBuf,
    /// Keep today's pictures as those that are wanted
    #[arg(long)]
    bless: bool,
    /// The scene, by name or file
    #[arg(long, value_name = "SCENE", default_value = "cornell")]
    scene: String,
    /// Which light paths
    #[arg(long, value_name = "PATHS", value_parser = value::transport)]
    transport: Option<Transport>,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "32x18", value_parser = value::size)]
    size: [u32; 2],
    #[command(flatten)]
    shaders: ShaderArgs,
    /// The graphics adapter whose name contains this (see `aquifer adapters`)
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Where got, want and their difference go when they differ
    #[arg(short, long, value_name = "DIR", default_value = "out/regress")]
    output: PathBuf,
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let graphs = if args.graphs.is_empty() { kept(&args.golden)? } else { args.graphs.clone() };
    let stage = args.stage(ui)?;
    let mut changed = Vec::new();
    for graph in &graphs {
        if !args.check(graph, &stage, ui)? {
            changed.push(graph.as_str());
        }
    }
    match changed.as_slice() {
        [] => Ok(()),
        _ => Err(Failure::new(format!(
            "{} of {} pictures changed: {}; if that is meant, --bless keeps the new ones",
            changed.len(),
            graphs.len(),
            changed.join(", ")
        ))),
    }
}

/// Graphs that have a picture.
fn kept(folder: &Path) -> Result<Vec<String>, Failure> {
    let unreadable = |error: std::io::Error| Failure::new(format!("cannot read `{}`: {error}", folder.display()));
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|end| end == "exr") {
            names.push(stem(&path));
        }
    }
    names.sort();
    if names.is_empty() {
        Err(Failure::new(format!("`{}` holds no pictures: name graphs and --bless", folder.display())))
    } else {
        Ok(names)
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

impl Args {
    fn stage(&self, ui: &Ui) -> Result<Stage, Failure> {
        let context = Context::new(&ContextOptions { adapter: self.adapter.clone(), ..ContextOptions::default() })?;
        let scene = Arc::new(SceneArgs { scene: self.scene.clone(), environment: None }.load(ui)?);
        let registry = self.shaders.registry(Some(&scene))?;
        Ok(Stage { context, registry, scene, camera: None, time: 0.0, step: 0.0, size: self.size, centred: false })
    }

    /// Is the picture still the one that is wanted?
    fn check(&self, graph: &str, stage: &Stage, ui: &Ui) -> Result<bool, Failure> {
        let shaders = ShaderArgs { folders: Vec::new() };
        let source = GraphArgs { graph: graph.to_owned(), settings: Vec::new(), transport: self.transport, shaders };
        let got = picture(stage, &source.document()?, &self.scene)?;
        let name = stem(Path::new(graph));
        let golden = self.golden.join(format!("{name}.exr"));
        if self.bless {
            std::fs::create_dir_all(&self.golden)
                .map_err(|error| Failure::new(format!("cannot make `{}`: {error}", self.golden.display())))?;
            got.write(&golden)?;
            ui.note(&format!("kept {}", golden.display()));
            return Ok(true);
        }
        let want = Film::read(&golden)?;
        let found = compare(&got, &want).map_err(|error| Failure::Failed(error.into()))?;
        if found.passed {
            ui.print(&format!("{name}: unchanged ({} of {} pixels fail)", found.failed, found.p.len()))?;
        } else {
            ui.print(&format!("{name}: changed, {} of {} pixels", found.failed, found.p.len()))?;
            self.write(&name, &got, &want, ui)?;
        }
        Ok(found.passed)
    }

    fn write(&self, name: &str, got: &Film, want: &Film, ui: &Ui) -> Result<(), Failure> {
        std::fs::create_dir_all(&self.output).map_err(|error| Failure::new(format!("cannot make `{}`: {error}", self.output.display())))?;
        let path = |what: &str| self.output.join(format!("{name}.{what}.exr"));
        atomic::check_writable(&path("got"))?;
        got.write(&path("got"))?;
        want.write(&path("want"))?;
        difference(got, want).write(&path("difference"))?;
        ui.note(&format!("wrote {name}.got.exr, .want.exr and .difference.exr to {}", self.output.display()));
        Ok(())
    }
}
