//! The JSON: parsed, and checked as far as that goes without the buffers.

use super::{LoadError, MAX_OBJECTS, limits::within};
use gltf::{Document, json};
use serde_json::Value;

/// The glTF extensions that are honoured.
pub const SUPPORTED_EXTENSIONS: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_texture_transform",
];

/// The document as the gltf crate sees it, and as plain JSON.
pub(super) fn parse(text: &[u8], warnings: &mut Vec<String>) -> Result<(Document, Value), LoadError> {
    let mut dom: Value = serde_json::from_slice(text)?;
    check_numbers(&dom)?;
    let mut root: json::Root = if fill_gaps(&mut dom) { serde_json::from_value(dom.clone())? } else { serde_json::from_slice(text)? };
    check_version(&root)?;
    check_extensions(&mut root, warnings)?;
    check_counts(&root)?;
    check_attributes(&root)?;
    Ok((Document::from_json(root).map_err(explained)?, dom))
}

/// Puts in what glTF lets out and the gltf crate insists on: a scene's list of nodes. Channels without a target node, which glTF says
/// to ignore, go. Says whether anything changed; a document that did not is parsed from its text, so that faults have a line and column.
fn fill_gaps(dom: &mut Value) -> bool {
    let mut changed = false;
    for scene in dom.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten().filter_map(Value::as_object_mut) {
        changed |= !scene.contains_key("nodes");
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    for animation in dom.get_mut("animations").and_then(Value::as_array_mut).into_iter().flatten() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let before = channels.len();
        channels.retain(|channel| channel.get("target").is_none_or(|target| !target.is_object() || target.get("node").is_some()));
        changed |= channels.len() != before;
    }
    changed
}

/// Every number fits 32-bit floats: the crate would read larger ones as infinite.
fn check_numbers(dom: &Value) -> Result<(), LoadError> {
    let mut stack = vec![(String::new(), dom)];
    while let Some((pointer, value)) = stack.pop() {
        match value {
            Value::Number(number) => {
                if !number.as_f64().is_some_and(|number| (number as f32).is_finite()) {
                    return Err(LoadError::NotFinite { pointer });
                }
            }
            Value::Array(items) => stack.extend(items.iter().enumerate().map(|(index, item)| (format!("{pointer}/{index}"), item))),
            // Extras belong to applications.
            Value::Object(members) => stack.extend(
                members.iter().filter(|(key, _)| *key != "extras").map(|(key, item)| (format!("{pointer}/{}", escaped(key)), item)),
            ),
            Value::Null | Value::Bool(_) | Value::String(_) => {}
        }
    }
    Ok(())
}

/// RFC 6901.
fn escaped(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

fn check_version(root: &json::Root) -> Result<(), LoadError> {
    let needed = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    let supported = root.asset.version.starts_with("2.") && (needed == "2.0" || root.asset.min_version.is_none());
    if supported { Ok(()) } else { Err(LoadError::Version(needed.clone())) }
}

/// Required extensions must be ours; then the crate, whose own list is shorter, need not see them.
fn check_extensions(root: &mut json::Root, warnings: &mut Vec<String>) -> Result<(), LoadError> {
    let is_unknown = |name: &&String| !SUPPORTED_EXTENSIONS.contains(&name.as_str());
    if let Some(name) = root.extensions_required.iter().find(is_unknown) {
        return Err(LoadError::Extension(name.clone()));
    }
    root.extensions_required.clear();
    let ignored = root.extensions_used.iter().filter(is_unknown);
    warnings.extend(ignored.map(|name| format!("extension `{name}` is not supported: shown without it")));
    Ok(())
}

fn check_counts(root: &json::Root) -> Result<(), LoadError> {
    let counts = [
        ("accessors", root.accessors.len()),
        ("animations", root.animations.len()),
        ("buffers", root.buffers.len()),
        ("bufferViews", root.buffer_views.len()),
        ("cameras", root.cameras.len()),
        ("images", root.images.len()),
        ("materials", root.materials.len()),
        ("meshes", root.meshes.len()),
        ("nodes", root.nodes.len()),
        ("textures", root.textures.len()),
    ];
    counts.iter().try_for_each(|&(name, count)| within(count as u64, MAX_OBJECTS as u64, name))
}

/// The crate's validation indexes accessors before it has checked these indices.
fn check_attributes(root: &json::Root) -> Result<(), LoadError> {
    let count = root.accessors.len();
    for (mesh, primitives) in root.meshes.iter().map(|mesh| &mesh.primitives).enumerate() {
        for (primitive, attributes) in primitives.iter().map(|primitive| &primitive.attributes).enumerate() {
            if let Some(accessor) = attributes.values().find(|accessor| accessor.value() >= count) {
                let pointer = format!("/meshes/{mesh}/primitives/{primitive}/attributes");
                return Err(LoadError::Index { pointer, index: accessor.value() as u64, count });
            }
        }
    }
    Ok(())
}

/// The first of the crate's complaints, with its path as a JSON pointer.
fn explained(error: gltf::Error) -> LoadError {
    match error {
        gltf::Error::Validation(faults) => match faults.into_iter().next() {
            Some((path, fault)) => LoadError::invalid(pointer(path.as_str()), fault.to_string()),
            None => LoadError::invalid("", "invalid"),
        },
        gltf::Error::Deserialize(error) => LoadError::Json(error),
        other => LoadError::invalid("", other.to_string()),
    }
}

/// `meshes[0].primitives[1].attributes["POSITION"]` → `/meshes/0/primitives/1/attributes/POSITION`
fn pointer(path: &str) -> String {
    let parts = path.split(['.', '[', ']', '"']).filter(|part| !part.is_empty());
    parts.fold(String::new(), |pointer, part| pointer + "/" + part)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        parse(text.as_bytes(), &mut Vec::new()).unwrap_err().to_string()
    }

    #[test]
    fn faults_name_their_pointer() {
        let asset = r#""asset":{"version":"2.0"}"#;
        assert_eq!(
            error(&format!(r#"{{{asset},"materials":[{{"pbrMetallicRoughness":{{"metallicFactor":1e39}}}}]}}"#)),
            "/materials/0/pbrMetallicRoughness/metallicFactor: not a finite 32-bit number"
        );
        assert_eq!(
            error(&format!(r#"{{{asset},"meshes":[{{"primitives":[{{"attributes":{{"POSITION":3}}}}]}}]}}"#)),
            "/meshes/0/primitives/0/attributes: index 3 is out of range, there are 0"
        );
        assert_eq!(error(&format!(r#"{{{asset},"nodes":[{{"mesh":0}}]}}"#)), "/nodes/0/mesh: Index out of bounds");
        assert_eq!(error(r#"{"asset":{"version":"1.0"}}"#), "/asset/version: glTF 1.0 is not supported, only 2.x");
        assert_eq!(
            error(&format!(r#"{{{asset},"extensionsRequired":["KHR_draco_mesh_compression"]}}"#)),
            "/extensionsRequired: `KHR_draco_mesh_compression` is not supported"
        );
        assert!(error("{").starts_with("not glTF JSON: EOF"));
    }

    #[test]
    fn what_gltf_lets_out_may_be_left_out() {
        let text = r#"{"asset":{"version":"2.0","extras":{"by":[1]}},"scenes":[{}],"animations":[{"samplers":[],
            "channels":[{"sampler":0,"target":{"path":"pointer"}}]}]}"#;
        let (document, _) = parse(text.as_bytes(), &mut Vec::new()).unwrap();
        assert_eq!(document.as_json().animations[0].channels.len(), 0);
        assert!(document.as_json().scenes[0].nodes.is_empty());
    }

    #[test]
    fn extensions_that_are_only_used_are_named() {
        let text = r#"{"asset":{"version":"2.0"},"extensionsUsed":["KHR_materials_clearcoat","KHR_materials_ior"],
            "extensionsRequired":["KHR_materials_specular"]}"#;
        let mut warnings = Vec::new();
        parse(text.as_bytes(), &mut warnings).unwrap();
        assert_eq!(warnings, ["extension `KHR_materials_clearcoat` is not supported: shown without it"]);
    }
}
