//! glTF 2.0 to a finished [`Scene`].
//!
//! The gltf crate reads the JSON; everything that a stranger's file could do with it is checked here: the container, numbers that are no
//! floats, byte ranges, strides, indices, cycles, sizes, files outside the scene's folder. Faults name the JSON pointer. What glTF
//! allows and Aquifer does not show is named in [`Scene::warnings`].
//!
//! | read | left out, with a warning |
//! |---|---|
//! | `.gltf`, `.glb`, data URIs, files in the scene's folder | anything outside that folder (an error) |
//! | triangles, strips, fans; sparse accessors | points and lines |
//! | normals, tangents, two sets of texture coordinates, `COLOR_0` | skins and morph targets: the rest pose is shown |
//! | metallic-roughness, emissive and normal textures, alpha modes, double-sided | occlusion textures (they are no light transport) |
//! | perspective cameras, animation of nodes | orthographic cameras, animation of weights |
//! | the extensions of [`SUPPORTED_EXTENSIONS`] | other extensions, unless required (an error) |

mod accessor;
mod animations;
mod container;
mod document;
mod environment;
mod error;
mod images;
mod limits;
mod materials;
mod meshes;
mod nodes;
mod resolve;

pub use document::SUPPORTED_EXTENSIONS;
pub use error::LoadError;
pub use limits::*;

use crate::Scene;
use gltf::Document;
use std::{
    any::Any,
    borrow::Cow,
    collections::HashMap,
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
};

impl Scene {
    /// Reads and finishes a `.gltf` or `.glb` file.
    ///
    /// # Errors
    /// When the file cannot be read, breaks a rule of glTF, or asks for more than the stated limits.
    pub fn load(path: &Path) -> Result<Scene, LoadError> {
        let bytes = resolve::read_file(path)?;
        let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let folder = path.parent().map(|parent| if parent.as_os_str().is_empty() { Path::new(".") } else { parent });
        Scene::from_gltf(&bytes, &name, folder)
    }

    /// Reads and finishes the bytes of a `.gltf` or `.glb` file. Files that it names are looked for in `folder`; without a folder
    /// there are none.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn from_gltf(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<Scene, LoadError> {
        guarded(|| read(bytes, name, folder))
    }
}

/// The last line of defence: a panic in a crate that reads files becomes an error.
fn guarded<T>(read: impl FnOnce() -> Result<T, LoadError>) -> Result<T, LoadError> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|panic| Err(LoadError::Panicked { why: message(&*panic) }))
}

fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}

fn read(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<Scene, LoadError> {
    let (json, bin) = container::split(bytes)?;
    let mut scene = Scene { name: name.to_owned(), ..Scene::default() };
    let (document, dom) = document::parse(json, &mut scene.warnings)?;
    let folder = folder.map(resolve::canonical).transpose()?;
    let buffers = resolve::buffers(&document, bin, folder.as_deref())?;
    let mut loader = Loader { document, dom, buffers, folder, scene, images: HashMap::new(), budget: Budget::default() };
    loader.read_materials()?;
    loader.read_meshes()?;
    loader.read_lights()?;
    let nodes = loader.read_nodes()?;
    loader.read_animations(&nodes)?;
    Ok(loader.scene.finish()?)
}

/// A file being read.
struct Loader<'a> {
    document: Document,
    /// The JSON once more, for what the gltf crate does not hand out.
    dom: serde_json::Value,
    buffers: Vec<Cow<'a, [u8]>>,
    folder: Option<PathBuf>,
    scene: Scene,
    /// (image of the file, read as sRGB) → image of the scene.
    images: HashMap<(usize, bool), u32>,
    budget: Budget,
}

impl Loader<'_> {
    fn warn(&mut self, warning: String) {
        self.scene.warnings.push(warning);
    }
}

/// `a thing without a name` or its name, for messages.
fn named(kind: &str, index: usize, name: Option<&str>) -> String {
    name.filter(|name| !name.is_empty()).map_or_else(|| format!("{kind} {index}"), |name| format!("{kind} `{name}`"))
}
