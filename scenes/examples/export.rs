//! Writes scenes made in code to a folder: `cargo run -p aquifer-scenes --example export -- FOLDER [NAME…]`; all scenes without a name.

use aquifer_scenes::{Generator, all, by_name, export};
use std::error::Error;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let folder = PathBuf::from(words.next().ok_or("usage: export FOLDER [NAME…]")?);
    let names: Vec<String> = words.collect();
    if names.is_empty() {
        return all().iter().try_for_each(|generator| write(generator, &folder));
    }
    names.iter().try_for_each(|name| write(by_name(name).ok_or_else(|| format!("there is no scene '{name}'"))?, &folder))
}

fn write(generator: &Generator, folder: &Path) -> Result<(), Box<dyn Error>> {
    let files = export(&(generator.make)())?;
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join(generator.name).with_extension("glb"), files.glb)?;
    if let Some(environment) = files.environment {
        std::fs::write(folder.join(generator.name).with_extension("exr"), environment)?;
    }
    Ok(())
}
