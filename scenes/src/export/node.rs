//! The hierarchy and its cameras.

use super::error::{finite, index};
use super::{ExportError, mesh, named};
use aquifer_scene::{Lens, Node, Scene};
use glam::{Quat, Vec3};
use serde_json::{Value, json};
use std::collections::BTreeSet;

pub(super) fn nodes(scene: &Scene, extensions: &mut BTreeSet<&'static str>) -> Result<Vec<Value>, ExportError> {
    let mut children = vec![Vec::new(); scene.nodes.len()];
    for (child, node) in scene.nodes.iter().enumerate() {
        if let Some(parent) = node.parent {
            index(parent, child, || format!("the parent of node '{}'", node.name))?;
            children[parent as usize].push(child);
        }
    }
    let meshes = mesh::numbers(&scene.meshes);
    scene.nodes.iter().zip(children).map(|(node, children)| object(node, children, scene, &meshes, extensions)).collect()
}

fn object(
    node: &Node,
    children: Vec<usize>,
    scene: &Scene,
    meshes: &[Option<usize>],
    extensions: &mut BTreeSet<&'static str>,
) -> Result<Value, ExportError> {
    let place = [node.translation.to_array(), node.scale.to_array()];
    finite(place.as_flattened(), || format!("the place of node '{}'", node.name))?;
    finite(&node.rotation.to_array(), || format!("the rotation of node '{}'", node.name))?;
    let what = || format!("node '{}'", node.name);
    let mut object = named(&node.name);
    if !children.is_empty() {
        object.insert("children".into(), json!(children));
    }
    if node.translation != Vec3::ZERO {
        object.insert("translation".into(), json!(node.translation.to_array()));
    }
    if node.rotation != Quat::IDENTITY {
        object.insert("rotation".into(), json!(node.rotation.to_array()));
    }
    if node.scale != Vec3::ONE {
        object.insert("scale".into(), json!(node.scale.to_array()));
    }
    if let Some(mesh) = node.mesh {
        index(mesh, scene.meshes.len(), what)?;
        if let Some(number) = meshes[mesh as usize] {
            object.insert("mesh".into(), json!(number));
        }
    }
    if let Some(camera) = node.camera {
        index(camera, scene.cameras.len(), what)?;
        object.insert("camera".into(), json!(camera));
    }
    if let Some(light) = node.light {
        index(light, scene.lights.len(), what)?;
        object.insert("extensions".into(), json!({ "KHR_lights_punctual": { "light": light } }));
        extensions.insert("KHR_lights_punctual");
    }
    Ok(object.into())
}

pub(super) fn cameras(lenses: &[Lens]) -> Vec<Value> {
    let camera = |lens: &Lens| {
        let mut perspective = json!({ "yfov": lens.vertical_fov, "znear": lens.near });
        if let Some(aspect) = lens.aspect {
            perspective["aspectRatio"] = json!(aspect);
        }
        let mut object = named(&lens.name);
        object.insert("type".into(), json!("perspective"));
        object.insert("perspective".into(), perspective);
        object.into()
    };
    lenses.iter().map(camera).collect()
}
