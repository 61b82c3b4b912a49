//! `aquifer scenes list | show | export`

mod describe;

use crate::{failure::Failure, source::load_scene, ui::Ui};
use aquifer_lab::atomic;
use clap::Subcommand;
use describe::Description;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// List the built-in scenes
    List,
    /// Say what a scene holds; needs no graphics adapter
    Show {
        /// A built-in scene or a .glb or .gltf file
        scene: String,
        /// Print as JSON
        #[arg(long)]
        json: bool,
    },
    /// Write a built-in scene as binary glTF; its environment, if any, goes beside it as .exr
    Export {
        /// A built-in scene
        name: String,
        /// The .glb file
        #[arg(value_name = "OUT.glb")]
        output: PathBuf,
    },
}

pub fn run(args: Args, ui: &Ui) -> Result<(), Failure> {
    match args.action {
        Action::List => {
            let line = |scene: &aquifer_scenes::Generator| format!("{:16} {}", scene.name, scene.about);
            ui.print(&aquifer_scenes::all().iter().map(line).collect::<Vec<_>>().join("\n"))
        }
        Action::Show { scene, json } => {
            let description = Description::of(&load_scene(&scene, None)?)?;
            if json { ui.json(&description) } else { ui.print(&description.to_string()) }
        }
        Action::Export { name, output } => export(&name, &output, ui),
    }
}

fn export(name: &str, output: &std::path::Path, ui: &Ui) -> Result<(), Failure> {
    let generator = crate::source::generator(name)?;
    atomic::check_writable(output)?;
    let exported = aquifer_scenes::export(&(generator.make)())?;
    atomic::write(output, &exported.glb)?;
    ui.note(&format!("wrote {} ({} bytes)", output.display(), exported.glb.len()));
    if let Some(environment) = exported.environment {
        let beside = output.with_extension("exr");
        atomic::write(&beside, &environment)?;
        ui.note(&format!("wrote {}, for --environment: glTF has no place for it", beside.display()));
    }
    Ok(())
}
