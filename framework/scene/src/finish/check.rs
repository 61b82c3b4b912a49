//! Every index is in range, every array as long as its partner, every number finite.

use crate::{Alpha, Channel, Environment, Image, Lens, Material, Mesh, Node, PunctualLight, PunctualShape, Scene, SceneError, Track, unit};
use glam::{Mat3, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// Emissive triangles of all instances together.
const MAX_LIGHTS: u64 = 1 << 24;

/// The first fault.
pub(super) fn check(scene: &Scene) -> Result<(), SceneError> {
    each(&scene.meshes, "meshes", |at, mesh| check_mesh(at, mesh, scene.materials.len()))?;
    each(&scene.materials, "materials", |at, material| check_material(at, material, scene.images.len()))?;
    each(&scene.images, "images", check_image)?;
    for (index, node) in scene.nodes.iter().enumerate() {
        check_node(index, node, scene)?;
    }
    each(&scene.cameras, "cameras", check_lens)?;
    each(&scene.lights, "lights", check_light)?;
    scene.environment.as_ref().map_or(Ok(()), check_environment)?;
    each(&scene.animation, "animation", |at, channel| check_channel(at, channel, scene.nodes.len()))
}

/// Lights are listed one by one, instances and all.
pub(super) fn check_lights(scene: &Scene) -> Result<(), SceneError> {
    let emits: Vec<bool> = scene.materials.iter().map(Material::emits).collect();
    let emissive = |mesh: &Mesh| mesh.materials.iter().filter(|&&material| emits[material as usize]).count() as u64;
    let emissive: Vec<u64> = scene.meshes.iter().map(emissive).collect();
    let count = scene.nodes.iter().filter_map(|node| node.mesh).map(|mesh| emissive[mesh as usize]).sum();
    if count <= MAX_LIGHTS {
        return Ok(());
    }
    Err(SceneError::TooMany { at: "emissive triangles of all instances".to_owned(), count, limit: MAX_LIGHTS })
}

/// Clamps factors to their ranges and makes quaternions unit.
pub(super) fn normalise(scene: &mut Scene) {
    for (index, material) in scene.materials.iter_mut().enumerate() {
        if clamp_factors(material) {
            scene.warnings.push(format!("materials[{index}] `{}`: factors clamped to their ranges", material.name));
        }
    }
    for node in &mut scene.nodes {
        node.rotation = unit::rotation(node.rotation).unwrap_or_default();
    }
    for channel in &mut scene.animation {
        let values_a_key = Channel::values_a_key(channel.interpolation);
        let Track::Rotation(values) = &mut channel.track else { continue };
        // The tangents of splines are no rotations.
        for value in values.iter_mut().skip(values_a_key / 2).step_by(values_a_key) {
            *value = unit::rotation(*value).unwrap_or_default();
        }
    }
}

fn clamp_factors(material: &mut Material) -> bool {
    let before = material.clone();
    material.base_color = material.base_color.max(glam::Vec4::ZERO);
    material.base_color.w = material.base_color.w.min(1.0);
    material.metallic = material.metallic.clamp(0.0, 1.0);
    material.roughness = material.roughness.clamp(0.0, 1.0);
    material.emission = material.emission.max(Vec3::ZERO);
    material.ior = material.ior.max(1.0);
    material.specular = material.specular.clamp(0.0, 1.0);
    material.specular_color = material.specular_color.max(Vec3::ZERO);
    let key = |m: &Material| (m.base_color, m.metallic, m.roughness, m.emission, m.ior, m.specular, m.specular_color);
    key(&before) != key(material)
}

fn each<T>(items: &[T], name: &str, check: impl Fn(&str, &T) -> Result<(), SceneError>) -> Result<(), SceneError> {
    items.iter().enumerate().try_for_each(|(index, item)| check(&format!("{name}[{index}]"), item))
}

fn in_range(at: impl Fn() -> String, index: u32, count: usize) -> Result<(), SceneError> {
    if (index as usize) < count { Ok(()) } else { Err(SceneError::Index { at: at(), index: index.into(), count }) }
}

fn finite(at: &str, field: &str, good: bool) -> Result<(), SceneError> {
    if good { Ok(()) } else { Err(SceneError::NotFinite { at: format!("{at}.{field}") }) }
}

fn within(at: &str, field: &str, value: f32, good: bool, allowed: &'static str) -> Result<(), SceneError> {
    if good { Ok(()) } else { Err(SceneError::OutOfRange { at: format!("{at}.{field}"), value, allowed }) }
}

fn length(at: &str, field: &str, found: usize, expected: usize) -> Result<(), SceneError> {
    if found == expected { Ok(()) } else { Err(SceneError::Length { at: format!("{at}.{field}"), found, expected }) }
}

fn check_mesh(at: &str, mesh: &Mesh, materials: usize) -> Result<(), SceneError> {
    let vertices = mesh.positions.len();
    // Flat normals and tangents may give every corner a vertex of its own.
    for (field, count) in [("positions", vertices), ("triangles", mesh.triangles.len().saturating_mul(3))] {
        let (count, limit) = (count as u64, u32::MAX.into());
        if count > limit {
            return Err(SceneError::TooMany { at: format!("{at}.{field}"), count, limit });
        }
    }
    let [uv0, uv1] = &mesh.uvs;
    let optional = [
        ("normals", mesh.normals.len()),
        ("tangents", mesh.tangents.len()),
        ("uvs[0]", uv0.len()),
        ("uvs[1]", uv1.len()),
        ("colors", mesh.colors.len()),
    ];
    for (field, found) in optional {
        if found > 0 {
            length(at, field, found, vertices)?;
        }
    }
    finite(at, "uvs", mesh.uvs.iter().flatten().all(|uv| uv.is_finite()))?;
    finite(at, "colors", mesh.colors.iter().all(|color| color.is_finite()))?;
    length(at, "materials", mesh.materials.len(), mesh.triangles.len())?;
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        triangle.iter().try_for_each(|&corner| in_range(|| format!("{at}.triangles[{index}]"), corner, vertices))?;
        in_range(|| format!("{at}.materials[{index}]"), mesh.materials[index], materials)?;
    }
    Ok(())
}

fn check_material(at: &str, material: &Material, images: usize) -> Result<(), SceneError> {
    for texture in material.textures() {
        in_range(|| format!("{at}.texture.image"), texture.image, images)?;
        in_range(|| format!("{at}.texture.uv_set"), texture.uv_set, 2)?;
        finite(at, "texture.transform", texture.transform.is_finite())?;
    }
    finite(at, "base_color", material.base_color.is_finite())?;
    finite(at, "emission", material.emission.is_finite())?;
    finite(at, "specular_color", material.specular_color.is_finite())?;
    let scalars = [
        ("metallic", material.metallic),
        ("roughness", material.roughness),
        ("normal_scale", material.normal_scale),
        ("ior", material.ior),
        ("specular", material.specular),
    ];
    scalars.iter().try_for_each(|&(field, value)| finite(at, field, value.is_finite()))?;
    match material.alpha {
        Alpha::Mask { cutoff } => finite(at, "alpha", cutoff.is_finite()),
        Alpha::Opaque | Alpha::Blend => Ok(()),
    }
}

fn check_image(at: &str, image: &Image) -> Result<(), SceneError> {
    length(at, "rgba", image.rgba.len(), image.width as usize * image.height as usize)?;
    if image.rgba.is_empty() { Err(SceneError::Length { at: format!("{at}.rgba"), found: 0, expected: 1 }) } else { Ok(()) }
}

fn check_node(index: usize, node: &Node, scene: &Scene) -> Result<(), SceneError> {
    let at = format!("nodes[{index}]");
    if let Some(parent) = node.parent.filter(|&parent| parent as usize >= index) {
        return Err(SceneError::ParentOrder { node: index, parent });
    }
    finite(&at, "translation", node.translation.is_finite())?;
    finite(&at, "scale", node.scale.is_finite())?;
    finite(&at, "rotation", unit::rotation(node.rotation).is_some())?;
    let references =
        [("mesh", node.mesh, scene.meshes.len()), ("camera", node.camera, scene.cameras.len()), ("light", node.light, scene.lights.len())];
    for (field, reference, count) in references {
        reference.map_or(Ok(()), |reference| in_range(|| format!("{at}.{field}"), reference, count))?;
    }
    Ok(())
}

fn check_lens(at: &str, lens: &Lens) -> Result<(), SceneError> {
    within(at, "vertical_fov", lens.vertical_fov, lens.vertical_fov > 0.0 && lens.vertical_fov < PI, "between 0 and π, both excluded")?;
    finite(at, "near", lens.near.is_finite())
}

fn check_light(at: &str, light: &PunctualLight) -> Result<(), SceneError> {
    finite(at, "intensity", light.intensity.is_finite())?;
    within(at, "intensity", light.intensity.min_element(), light.intensity.min_element() >= 0.0, "0 or more")?;
    if let Some(range) = light.range {
        within(at, "range", range, range > 0.0 && range.is_finite(), "more than 0")?;
    }
    if let PunctualShape::Spot { inner, outer } = light.shape {
        within(at, "shape.outer", outer, outer > 0.0 && outer <= FRAC_PI_2, "more than 0, at most π/2")?;
        within(at, "shape.inner", inner, inner >= 0.0 && inner < outer, "0 or more, less than the outer angle")?;
    }
    Ok(())
}

fn check_environment(environment: &Environment) -> Result<(), SceneError> {
    let texels = environment.width as usize * environment.height as usize;
    length("environment", "radiance", environment.radiance.len(), texels.max(1))?;
    let turn = environment.world_to_map;
    finite("environment", "world_to_map", turn.is_finite())?;
    let is_rotation = (turn.transpose() * turn).abs_diff_eq(Mat3::IDENTITY, 1e-3);
    within("environment", "world_to_map", turn.determinant(), is_rotation, "a rotation, or one mirrored")?;
    let good = |texel: &[f32; 3]| texel.iter().all(|value| value.is_finite() && *value >= 0.0);
    match environment.radiance.iter().position(|texel| !good(texel)) {
        None => Ok(()),
        Some(index) => {
            let value = environment.radiance[index].into_iter().find(|value| !(value.is_finite() && *value >= 0.0)).unwrap_or(f32::NAN);
            within("environment", &format!("radiance[{index}]"), value, false, "finite, 0 or more")
        }
    }
}

fn check_channel(at: &str, channel: &Channel, nodes: usize) -> Result<(), SceneError> {
    in_range(|| format!("{at}.node"), channel.node, nodes)?;
    finite(at, "times", channel.times.iter().all(|time| time.is_finite()))?;
    if channel.times.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(SceneError::KeyTimes { at: format!("{at}.times") });
    }
    let values_a_key = Channel::values_a_key(channel.interpolation);
    length(at, "track", channel.track.len(), channel.times.len() * values_a_key)?;
    let good = match &channel.track {
        Track::Translation(values) | Track::Scale(values) => values.iter().all(|value| value.is_finite()),
        Track::Rotation(values) => {
            let keys = values.iter().skip(values_a_key / 2).step_by(values_a_key);
            values.iter().all(|value| value.is_finite()) && keys.into_iter().all(|&value| unit::rotation(value).is_some())
        }
    };
    finite(at, "track", good)
}
