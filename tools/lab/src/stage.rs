//! Shaders and kinds of passes, with a user's folders over the built-in ones.

use aquifer_render::Registry;
use aquifer_scene::{Features, Scene};
use aquifer_shader::{Library, ShaderError};
use std::path::PathBuf;

/// Why the shaders cannot be made ready.
#[derive(Debug, thiserror::Error)]
pub enum StageError {
    /// A folder of shaders cannot be read.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The scene has no hierarchy to measure.
    #[error(transparent)]
    Render(#[from] aquifer_render::Error),
}

/// The built-in shaders with those of `folders` over them.
pub fn library(folders: &[PathBuf]) -> Result<Library, ShaderError> {
    let mut library = aquifer_passes::library();
    for folder in folders {
        library.add_folder(folder)?;
    }
    Ok(library)
}

/// [`library`] and the built-in passes; see [`aquifer_passes::registry`].
pub fn registry(scene: Option<&Scene>, folders: &[PathBuf]) -> Result<Registry, StageError> {
    Ok(aquifer_passes::registry(library(folders)?, scene)?)
}

/// As [`registry`], for shaders cut to `features`; see [`aquifer_passes::registry_keeping`].
pub fn registry_keeping(scene: &Scene, features: &Features, folders: &[PathBuf]) -> Result<Registry, StageError> {
    Ok(aquifer_passes::registry_keeping(library(folders)?, scene, features)?)
}

/// The module in which resampling tells what it does, and the one that listens.
const WITNESS: [&str; 2] = ["restir/witness", "restir/witness_on"];

/// As [`registry_keeping`], but passes that resample write down what they do: each has one more output, `testimony`.
pub fn witnessing(scene: &Scene, features: &Features, folders: &[PathBuf]) -> Result<Registry, StageError> {
    let mut library = library(folders)?;
    let [silent, listening] = WITNESS;
    let text = library.text(listening).unwrap_or_default().to_owned();
    library.insert(silent, text, format!("built-in:{listening}.wgsl"));
    Ok(aquifer_passes::registry_keeping(library, scene, features)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use aquifer_graph::Contracts as _;
    use aquifer_passes::LIMITS;

    #[test]
    fn folders_add_passes_and_the_scene_sets_limits() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("pass")).unwrap();
        let text =
            "@group(1) @binding(0) var<storage, read_write> out: array<f32>;\n@compute @workgroup_size(8, 8) fn main() { out[0] = 1.0; }\n";
        std::fs::write(folder.path().join("pass/mine.wgsl"), text).unwrap();
        let cornell = (aquifer_scenes::by_name("cornell").unwrap().make)().finish().unwrap();
        let registry = registry(Some(&cornell), &[folder.path().to_owned()]).unwrap();
        assert!(registry.kinds().contains(&"mine".to_owned()));
        assert!(registry.kinds().contains(&"path_tracer".to_owned()));
        let limits = registry.library().text(LIMITS).unwrap();
        let depth: u32 = limits.trim_start_matches("const STACK: u32 = ").trim_end_matches("u;\n").parse().unwrap();
        assert!((8..=64).contains(&depth), "{limits}");
    }

    #[test]
    fn a_missing_folder_is_named() {
        let error = registry(None, &[PathBuf::from("/no/such/folder")]).unwrap_err();
        assert!(error.to_string().contains("/no/such/folder"), "{error}");
    }
}
