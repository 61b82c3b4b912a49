//! Materials, with the extensions that they use and no others.

use super::error::{finite, within};
use super::texture::Textures;
use super::{ExportError, Parts, named};
use aquifer_scene::{Alpha, Material, Scene};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

pub(super) fn write(scene: &Scene, parts: &mut Parts) -> Result<(), ExportError> {
    let mut textures = Textures::new(scene.images.len());
    let materials = scene.materials.iter().map(|material| object(material, &mut textures, &mut parts.extensions));
    let materials = materials.collect::<Result<_, _>>()?;
    parts.list("materials", materials);
    textures.write(parts);
    Ok(())
}

fn object(material: &Material, textures: &mut Textures, extensions: &mut BTreeSet<&'static str>) -> Result<Value, ExportError> {
    check(material)?;
    let mut object = named(&material.name);
    object.insert("pbrMetallicRoughness".into(), metallic_roughness(material, textures, extensions)?);
    if let Some(texture) = &material.normal_texture {
        let mut info = textures.info(texture, material, extensions)?;
        info["scale"] = json!(material.normal_scale);
        object.insert("normalTexture".into(), info);
    }
    if let Some(texture) = &material.emission_texture {
        object.insert("emissiveTexture".into(), textures.info(texture, material, extensions)?);
    }
    object.insert("emissiveFactor".into(), json!((material.emission / strength(material)).to_array()));
    match material.alpha {
        Alpha::Opaque => {}
        Alpha::Blend => _ = object.insert("alphaMode".into(), json!("BLEND")),
        Alpha::Mask { cutoff } => {
            object.insert("alphaMode".into(), json!("MASK"));
            object.insert("alphaCutoff".into(), json!(cutoff));
        }
    }
    if material.double_sided {
        object.insert("doubleSided".into(), json!(true));
    }
    let own = own_extensions(material);
    if !own.is_empty() {
        extensions.extend(own.iter().map(|(name, _)| *name));
        let own: Map<String, Value> = own.into_iter().map(|(name, value)| (name.into(), value)).collect();
        object.insert("extensions".into(), own.into());
    }
    Ok(object.into())
}

fn metallic_roughness(material: &Material, textures: &mut Textures, extensions: &mut BTreeSet<&'static str>) -> Result<Value, ExportError> {
    let mut object = json!({
        "baseColorFactor": material.base_color.to_array(),
        "metallicFactor": material.metallic,
        "roughnessFactor": material.roughness,
    });
    if let Some(texture) = &material.base_color_texture {
        object["baseColorTexture"] = textures.info(texture, material, extensions)?;
    }
    if let Some(texture) = &material.metallic_roughness_texture {
        object["metallicRoughnessTexture"] = textures.info(texture, material, extensions)?;
    }
    Ok(object)
}

/// emissiveFactor ends at 1; what is brighter needs KHR_materials_emissive_strength.
fn strength(material: &Material) -> f32 {
    material.emission.max_element().max(1.0)
}

fn own_extensions(material: &Material) -> Vec<(&'static str, Value)> {
    let defaults = Material::default();
    let mut own = Vec::new();
    if strength(material) > 1.0 {
        own.push(("KHR_materials_emissive_strength", json!({ "emissiveStrength": strength(material) })));
    }
    if material.ior != defaults.ior {
        own.push(("KHR_materials_ior", json!({ "ior": material.ior })));
    }
    if material.specular != defaults.specular || material.specular_color != defaults.specular_color {
        let color = material.specular_color.to_array();
        own.push(("KHR_materials_specular", json!({ "specularFactor": material.specular, "specularColorFactor": color })));
    }
    if material.unlit {
        own.push(("KHR_materials_unlit", json!({})));
    }
    own
}

fn check(material: &Material) -> Result<(), ExportError> {
    let what = |part: &str| format!("{part} of material '{}'", material.name);
    for channel in material.base_color.to_array() {
        within(channel, [0.0, 1.0], || what("the base colour"))?;
    }
    within(material.metallic, [0.0, 1.0], || what("the metalness"))?;
    within(material.roughness, [0.0, 1.0], || what("the roughness"))?;
    within(material.specular, [0.0, 1.0], || what("the specular strength"))?;
    finite(&[material.normal_scale], || what("the scale of the normal map"))?;
    for channel in material.emission.to_array() {
        within(channel, [0.0, f32::MAX], || what("the emission"))?;
    }
    for channel in material.specular_color.to_array() {
        within(channel, [0.0, f32::MAX], || what("the specular colour"))?;
    }
    // 0 is the extension's way to say "reflects everything".
    if material.ior != 0.0 {
        within(material.ior, [1.0, f32::MAX], || what("the index of refraction"))?;
    }
    if let Alpha::Mask { cutoff } = material.alpha {
        within(cutoff, [0.0, f32::MAX], || what("the alpha cutoff"))?;
    }
    Ok(())
}
