//! `aquifer regress [GRAPH[@SCENE] …]`

mod folder;

use crate::{
    failure::Failure,
    source::{AdapterArgs, GraphArgs, SceneArgs, ShaderArgs},
    ui::Ui,
    value,
};
use aquifer_graph::Transport;
use aquifer_lab::{
    compare::subject::Stage,
    regress::{Picture, Shown, Verdict, compare, picture, write},
};
use aquifer_render::Context;
use folder::{Folder, stem};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

/// Seconds from one frame to the next where things move.
const STEP: f32 = 0.05;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Graphs, built-in ones or .toml files, each with the scene that follows its `@`; without any, those whose pictures are in the folder
    #[arg(value_name = "GRAPH[@SCENE]")]
    graphs: Vec<String>,
    /// Folder of the pictures that are wanted
    #[arg(long, value_name = "DIR", default_value = "tests/golden")]
    golden: PathBuf,
    /// Show the differences, then keep today's pictures as those that are wanted
    #[arg(long)]
    bless: bool,
    /// The scene of graphs that name none
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
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Where got, want, their difference and a page of them go when they differ
    #[arg(short, long, value_name = "DIR", default_value = "out/regress")]
    output: PathBuf,
}

/// One picture, today's and the one kept.
struct Case {
    name: String,
    got: Picture,
    want: Option<(aquifer_lab::film::Film, Verdict)>,
}

impl Case {
    fn changed(&self) -> bool {
        self.want.as_ref().is_some_and(|(_, verdict)| !verdict.passed())
    }
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    let mut folder = Folder::open(&args.golden)?;
    let names = if args.graphs.is_empty() { folder.names()? } else { args.graphs.clone() };
    let context = args.adapter.open()?;
    let mut cases = Vec::new();
    for name in &names {
        let case = args.case(name, &context, &folder, ui)?;
        ui.print(&told(&case))?;
        cases.push(case);
    }
    args.write(&cases, ui)?;
    if args.bless {
        return args.keep(&cases, &context, &mut folder, ui);
    }
    let changed: Vec<&str> = cases.iter().filter(|case| case.changed()).map(|case| case.name.as_str()).collect();
    match changed.as_slice() {
        [] => Ok(()),
        _ => Err(Failure::new(format!(
            "{} of {} pictures changed: {}; if that is meant, --bless keeps the new ones",
            changed.len(),
            cases.len(),
            changed.join(", ")
        ))),
    }
}

fn told(case: &Case) -> String {
    match &case.want {
        Some((_, verdict)) => format!("{}: {verdict}", case.name),
        None => format!("{}: no picture is kept", case.name),
    }
}

impl Args {
    fn stage(&self, context: &Context, scene: &str, ui: &Ui) -> Result<Stage, Failure> {
        let scene = Arc::new(SceneArgs { scene: scene.to_owned(), environment: None }.load(ui)?);
        let registry = self.shaders.registry(Some(&scene))?;
        let context = context.clone();
        Ok(Stage { context, registry, scene, camera: None, time: 0.0, step: STEP, size: self.size, centred: false })
    }

    fn case(&self, name: &str, context: &Context, folder: &Folder, ui: &Ui) -> Result<Case, Failure> {
        let (graph, scene) = name.split_once('@').unwrap_or((name, &self.scene));
        let stage = self.stage(context, scene, ui)?;
        let shaders = ShaderArgs::default();
        let source = GraphArgs { graph: graph.to_owned(), settings: Vec::new(), transport: self.transport, shaders };
        let got = picture(&stage, &source.document()?, scene)?;
        let name = match name.split_once('@') {
            Some((_, scene)) => format!("{}@{scene}", stem(Path::new(graph))),
            None => stem(Path::new(graph)),
        };
        let want = match folder.picture(&name, self.bless)? {
            None => None,
            Some((want, kept)) => {
                let bits = folder.store.bits(&context.adapter().name, &name);
                let verdict = compare(&got, &want, &kept, bits).map_err(|error| Failure::Failed(error.into()))?;
                Some((want, verdict))
            }
        };
        Ok(Case { name, got, want })
    }

    /// What differs, for people to look at.
    fn write(&self, cases: &[Case], ui: &Ui) -> Result<(), Failure> {
        let shown = cases.iter().filter(|case| case.changed()).filter_map(|Case { name, got, want }| {
            let (want, verdict) = want.as_ref()?;
            Some(Shown { name, got, want, verdict })
        });
        let shown: Vec<Shown<'_>> = shown.collect();
        if shown.is_empty() {
            return Ok(());
        }
        folder::write_images(&shown, &self.output)?;
        write(&shown, &self.output).map_err(|error| Failure::Failed(error.into()))?;
        ui.note(&format!("wrote changed.html and {} pictures to {}", 3 * shown.len(), self.output.display()));
        Ok(())
    }

    fn keep(&self, cases: &[Case], context: &Context, folder: &mut Folder, ui: &Ui) -> Result<(), Failure> {
        for Case { name, got, .. } in cases {
            folder.keep(&context.adapter().name, name, got)?;
            ui.note(&format!("kept {name}"));
        }
        folder.write()
    }
}
