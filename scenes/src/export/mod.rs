//! Scenes as binary glTF 2.0.
//!
//! The file holds what [`Scene`] holds: hierarchy, meshes with one primitive a material, materials with the KHR extensions they use, images
//! as PNG, cameras, punctual lights, animation. Indices of materials, images, cameras, lights and nodes are kept, and those of meshes
//! unless one is empty, which glTF does not allow and which is left out. Warnings are not written, and glTF has no place for an
//! environment, which therefore comes beside the file, as OpenEXR.

mod animation;
mod buffer;
mod container;
mod environment;
mod error;
mod light;
mod material;
mod mesh;
mod node;
mod texture;

pub use error::ExportError;

use crate::Scene;
use buffer::Buffer;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// A scene in files.
#[derive(Clone, Debug)]
pub struct Exported {
    /// Binary glTF; the same scene gives the same bytes.
    pub glb: Vec<u8>,
    /// The environment's radiance as an equirectangular OpenEXR image, by the convention of [`aquifer_scene::Environment`]. Its rotation
    /// `world_to_map` has no place in that format.
    pub environment: Option<Vec<u8>>,
}

/// Writes a scene as binary glTF.
pub fn export(scene: &Scene) -> Result<Exported, ExportError> {
    let environment = scene.environment.as_ref().map(environment::exr).transpose()?;
    let mut parts = Parts::default();
    let nodes = node::nodes(scene, &mut parts.extensions)?;
    parts.list("nodes", nodes);
    parts.list("cameras", node::cameras(&scene.cameras));
    let solid = scene.meshes.iter().filter(|mesh| !mesh.triangles.is_empty());
    let meshes = solid.map(|mesh| mesh::mesh(mesh, scene.materials.len(), &mut parts.buffer));
    let meshes = meshes.collect::<Result<_, _>>()?;
    parts.list("meshes", meshes);
    material::write(scene, &mut parts)?;
    texture::write_images(scene, &mut parts)?;
    let animations = animation::animations(scene, &mut parts.buffer)?;
    parts.list("animations", animations);
    light::write(scene, &mut parts)?;
    let roots: Vec<usize> = (0..scene.nodes.len()).filter(|i| scene.nodes[*i].parent.is_none()).collect();
    parts
        .list("scenes", vec![if roots.is_empty() { json!({ "name": scene.name }) } else { json!({ "name": scene.name, "nodes": roots }) }]);
    let glb = parts.into_glb()?;
    Ok(Exported { glb, environment })
}

/// The top level of the document in the making.
#[derive(Default)]
struct Parts {
    root: Map<String, Value>,
    buffer: Buffer,
    extensions: BTreeSet<&'static str>,
}

impl Parts {
    /// Adds a top-level array; glTF forbids empty ones.
    fn list(&mut self, key: &str, items: Vec<Value>) {
        if !items.is_empty() {
            self.root.insert(key.into(), items.into());
        }
    }

    fn into_glb(mut self) -> Result<Vec<u8>, ExportError> {
        let generator = concat!("Aquifer ", env!("CARGO_PKG_VERSION"));
        self.root.insert("asset".into(), json!({ "version": "2.0", "generator": generator }));
        self.root.insert("scene".into(), json!(0));
        let used: Vec<Value> = self.extensions.iter().map(|name| json!(name)).collect();
        self.list("extensionsUsed", used);
        let Buffer { bytes, views, accessors } = std::mem::take(&mut self.buffer);
        self.list("bufferViews", views);
        self.list("accessors", accessors);
        if !bytes.is_empty() {
            self.list("buffers", vec![json!({ "byteLength": bytes.len() })]);
        }
        container::glb(&Value::Object(self.root), bytes)
    }
}

/// A name where there is one.
fn named(name: &str) -> Map<String, Value> {
    let mut object = Map::new();
    if !name.is_empty() {
        object.insert("name".into(), name.into());
    }
    object
}
