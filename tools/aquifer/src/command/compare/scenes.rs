//! Scenes as they are typed, under names that differ.

use super::entrants::unique;
use crate::source::SceneArgs;
use std::path::{Path, PathBuf};

/// A scene that graphs are compared on.
#[derive(Clone, Debug)]
pub struct Place {
    /// Short and unique in the whole comparison, whichever of its jobs are run. Folders and links are called so too.
    pub name: String,
    /// What was typed.
    pub source: SceneArgs,
}

/// Every scene; that two files in different folders have one name is no matter.
pub fn places(typed: &[String], environment: Option<&PathBuf>) -> Vec<Place> {
    let mut places: Vec<Place> = Vec::new();
    for scene in typed {
        let stem = Path::new(scene).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = unique(stem, '-', |name| places.iter().any(|place| place.name == name));
        places.push(Place { name, source: SceneArgs { scene: scene.clone(), environment: environment.cloned() } });
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_one_file_name_have_names_of_their_own() {
        let typed = ["sponza/scene.gltf", "cornell", "bistro/scene.gltf", "scene-2.glb", "cornell"].map(String::from);
        let names: Vec<String> = places(&typed, None).into_iter().map(|place| place.name).collect();
        assert_eq!(names, ["scene", "cornell", "scene-2", "scene-2-2", "cornell-2"]);
    }
}
