//! The built-in passes: shaders of the tree, and the explicit list of those that have host code of their own.
//!
//! [`library`] holds the WGSL tree; [`registry`] cuts it to what a scene holds, [`registry_keeping`] to no less than that.

mod gbuffer;

use aquifer_render::{Error, PassKind, Registry, SceneGlobals};
use aquifer_scene::{Features, Scene};
use aquifer_shader::Library;
use std::sync::Arc;

/// Passes with host code, one file each. All others are files of `shaders/pass` and need no word here.
pub const KINDS: &[PassKind] = &[gbuffer::KIND];

/// The module of sizes that come from the scene.
pub const LIMITS: &str = "scene/limits";

/// The built-in shaders.
pub fn library() -> Library {
    let mut library = Library::new();
    library.know_facts(Features::NAMES);
    for (path, text) in aquifer_shaders::modules() {
        let origin = format!("built-in:{path}.wgsl");
        library.insert(path, text, origin);
    }
    library
}

/// Every kind of pass. With a finished scene, shaders are cut to what it holds; without one (for checking and listing) nothing is cut.
///
/// # Errors
/// [`Error::Globals`] for a scene that was not finished.
pub fn registry(library: Library, scene: Option<&Scene>) -> Result<Registry, Error> {
    match scene {
        Some(scene) => registry_keeping(library, scene, &Features::of(scene)),
        None => Ok(Registry::new(Arc::new(library), KINDS, Default::default()).keeping(&Features::ALL)),
    }
}

/// Every kind of pass for a finished scene, its shaders cut to `features` instead of its facts. [`SceneGlobals::keeping`] has what they ask for.
///
/// # Errors
/// As [`registry`].
pub fn registry_keeping(mut library: Library, scene: &Scene, features: &Features) -> Result<Registry, Error> {
    let stack = SceneGlobals::stack_depth(scene, features)?;
    library.insert(LIMITS, format!("const STACK: u32 = {stack}u;\n"), "the scene's limits");
    let facts = Features::of(scene).names().into_iter().map(str::to_owned).collect();
    Ok(Registry::new(Arc::new(library), KINDS, facts).keeping(features))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_that_no_scene_has_are_refused() {
        let mut library = library();
        let text = "//! @needs glosy\n@group(1) @binding(0) var<storage, read_write> image: array<f32>;\n\
                    @compute @workgroup_size(8, 8) fn main() { image[0] = 1.0; }\n";
        library.insert("pass/mine", text, "mine.wgsl");
        let refused = registry(library, None).unwrap().known("mine", &Default::default()).unwrap_err().to_string();
        assert!(refused.starts_with("mine.wgsl:1:12: there is no fact `glosy` of scenes; did you mean `glossy`?"), "{refused}");
    }
}
