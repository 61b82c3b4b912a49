//! Materials and the use of textures.

use super::{LoadError, Loader, named};
use crate::{Alpha, Material, TextureRef, Wrap};
use glam::{Mat3, Vec2, Vec3, Vec4};
use gltf::{
    material::AlphaMode,
    texture::{MagFilter, WrappingMode},
};
use serde::Deserialize;

/// textureInfo of any kind, as it stands in the JSON; the gltf crate hides the transform of normal textures.
#[derive(Deserialize)]
struct TextureInfo {
    index: usize,
    #[serde(default, rename = "texCoord")]
    uv_set: u32,
    #[serde(default)]
    extensions: TextureExtensions,
}

#[derive(Default, Deserialize)]
struct TextureExtensions {
    #[serde(rename = "KHR_texture_transform")]
    transform: Option<TextureTransform>,
}

#[derive(Deserialize)]
#[serde(default)]
struct TextureTransform {
    offset: [f32; 2],
    rotation: f32,
    scale: [f32; 2],
    #[serde(rename = "texCoord")]
    uv_set: Option<u32>,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], uv_set: None }
    }
}

impl TextureTransform {
    /// Scale, then a turn counter-clockwise as seen in the image (whose v points down), then the offset. The extension's text shows the
    /// opposite turn; its own test model and the viewers agree on this one.
    fn matrix(&self) -> Mat3 {
        Mat3::from_scale_angle_translation(Vec2::from_array(self.scale), -self.rotation, Vec2::from_array(self.offset))
    }
}

impl Loader<'_> {
    /// All materials, in the file's order.
    pub(super) fn read_materials(&mut self) -> Result<(), LoadError> {
        let document = self.document.clone();
        for (index, material) in document.materials().enumerate() {
            let read = self.read_material(index, &material)?;
            self.scene.materials.push(read);
        }
        Ok(())
    }

    fn read_material(&mut self, index: usize, material: &gltf::Material<'_>) -> Result<Material, LoadError> {
        let pbr = material.pbr_metallic_roughness();
        let specular = material.specular();
        if specular.as_ref().is_some_and(|s| s.specular_texture().is_some() || s.specular_color_texture().is_some()) {
            self.warn(format!("{}: textures of KHR_materials_specular are not read", named("material", index, material.name())));
        }
        let base = format!("/materials/{index}");
        let texture = |loader: &mut Self, place: &str, srgb: bool| loader.texture(&format!("{base}/{place}"), srgb);
        Ok(Material {
            name: material.name().unwrap_or_default().to_owned(),
            base_color: Vec4::from_array(pbr.base_color_factor()),
            base_color_texture: texture(self, "pbrMetallicRoughness/baseColorTexture", true)?,
            metallic: pbr.metallic_factor(),
            roughness: pbr.roughness_factor(),
            metallic_roughness_texture: texture(self, "pbrMetallicRoughness/metallicRoughnessTexture", false)?,
            emission: Vec3::from_array(material.emissive_factor()) * material.emissive_strength().unwrap_or(1.0),
            emission_texture: texture(self, "emissiveTexture", true)?,
            normal_texture: texture(self, "normalTexture", false)?,
            normal_scale: material.normal_texture().map_or(1.0, |texture| texture.scale()),
            // 0 stands for a surface that reflects everything: an infinite index.
            ior: match material.ior() {
                Some(0.0) => INFINITE_IOR,
                ior => ior.unwrap_or(1.5),
            },
            specular: specular.as_ref().map_or(1.0, |specular| specular.specular_factor()),
            specular_color: specular.map_or(Vec3::ONE, |specular| Vec3::from_array(specular.specular_color_factor())),
            alpha: match material.alpha_mode() {
                AlphaMode::Opaque => Alpha::Opaque,
                AlphaMode::Mask => Alpha::Mask { cutoff: material.alpha_cutoff().unwrap_or(0.5) },
                AlphaMode::Blend => Alpha::Blend,
            },
            double_sided: material.double_sided(),
            unlit: material.unlit(),
        })
    }

    /// The textureInfo at a JSON pointer, if there is one.
    fn texture(&mut self, pointer: &str, srgb: bool) -> Result<Option<TextureRef>, LoadError> {
        let Some(value) = self.dom.pointer(pointer).filter(|value| !value.is_null()) else { return Ok(None) };
        let info = TextureInfo::deserialize(value).map_err(|error| LoadError::invalid(pointer, error.to_string()))?;
        let transform = info.extensions.transform.unwrap_or_default();
        let uv_set = transform.uv_set.unwrap_or(info.uv_set);
        if uv_set > 1 {
            self.warn(format!("{pointer}: only two sets of texture coordinates are read, the texture on set {uv_set} is left out"));
            return Ok(None);
        }
        let textures = &self.document.as_json().textures;
        let count = textures.len();
        let image = textures.get(info.index).map(|texture| texture.source.value());
        let image = image.ok_or_else(|| LoadError::Index { pointer: pointer.to_owned(), index: info.index as u64, count })?;
        let image = self.image(image, srgb)?;
        let (wrap, linear) = self.sampling(info.index);
        Ok(Some(TextureRef { image, uv_set, transform: transform.matrix(), wrap, linear }))
    }

    /// Wrapping and filter of a texture. Minification filters are for rasterisers that have mipmaps.
    fn sampling(&self, texture: usize) -> ([Wrap; 2], bool) {
        let sampler = self.document.textures().nth(texture).map(|texture| texture.sampler());
        let Some(sampler) = sampler else { return ([Wrap::Repeat; 2], true) };
        ([wrap(sampler.wrap_s()), wrap(sampler.wrap_t())], sampler.mag_filter() != Some(MagFilter::Nearest))
    }
}

/// Reflects all but 10⁻⁵ of the light at normal incidence.
const INFINITE_IOR: f32 = 1e6;

fn wrap(mode: WrappingMode) -> Wrap {
    match mode {
        WrappingMode::ClampToEdge => Wrap::Clamp,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
        WrappingMode::Repeat => Wrap::Repeat,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn transforms_scale_then_turn_then_shift() {
        let transform = TextureTransform { offset: [0.5, 0.25], rotation: FRAC_PI_2, scale: [2.0, 3.0], uv_set: None };
        // (1, 0) → scaled (2, 0) → a quarter turn counter-clockwise with v down (0, −2) → shifted.
        assert!(transform.matrix().transform_point2(vec2(1.0, 0.0)).abs_diff_eq(vec2(0.5, -1.75), 1e-6));
        assert!(transform.matrix().transform_point2(vec2(0.0, 1.0)).abs_diff_eq(vec2(3.5, 0.25), 1e-6));
        assert_eq!(TextureTransform::default().matrix(), Mat3::IDENTITY);
    }
}
