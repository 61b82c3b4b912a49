//! Images, samplers, and the textures that join them.

use super::buffer::Usage;
use super::{ExportError, Parts, error, named};
use aquifer_scene::{Image, Material, Scene, TextureRef, Wrap};
use glam::{Mat3, Vec2};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use serde_json::{Value, json};
use std::collections::BTreeSet;

const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;

/// Wrapping and filter of one sampler.
type Sampler = ([Wrap; 2], bool);

/// The textures met so far, each pair of image and sampler once, in order of first use.
pub(super) struct Textures {
    image_count: usize,
    samplers: Vec<Sampler>,
    pairs: Vec<(u32, usize)>,
}

impl Textures {
    pub(super) fn new(image_count: usize) -> Self {
        Self { image_count, samplers: Vec::new(), pairs: Vec::new() }
    }

    /// glTF's textureInfo for one use of an image.
    pub(super) fn info(
        &mut self,
        texture: &TextureRef,
        material: &Material,
        extensions: &mut BTreeSet<&'static str>,
    ) -> Result<Value, ExportError> {
        error::index(texture.image, self.image_count, || format!("a texture of material '{}'", material.name))?;
        let sampler = find_or_push(&mut self.samplers, (texture.wrap, texture.linear));
        let index = find_or_push(&mut self.pairs, (texture.image, sampler));
        let mut info = json!({ "index": index, "texCoord": texture.uv_set });
        if texture.transform != Mat3::IDENTITY {
            let transform = transform(&texture.transform).ok_or_else(|| ExportError::ShearedTexture { material: material.name.clone() })?;
            info["extensions"] = json!({ "KHR_texture_transform": transform });
            extensions.insert("KHR_texture_transform");
        }
        Ok(info)
    }

    pub(super) fn write(self, parts: &mut Parts) {
        parts.list("samplers", self.samplers.into_iter().map(sampler).collect());
        let textures = self.pairs.into_iter().map(|(image, sampler)| json!({ "source": image, "sampler": sampler }));
        parts.list("textures", textures.collect());
    }
}

/// Embeds every image, used or not, so that indices stay.
pub(super) fn write_images(scene: &Scene, parts: &mut Parts) -> Result<(), ExportError> {
    let mut objects = Vec::with_capacity(scene.images.len());
    for image in &scene.images {
        let view = parts.buffer.view(&png(image)?, Usage::Other);
        let mut object = named(&image.name);
        object.insert("mimeType".into(), json!("image/png"));
        object.insert("bufferView".into(), json!(view));
        objects.push(object.into());
    }
    parts.list("images", objects);
    Ok(())
}

fn png(image: &Image) -> Result<Vec<u8>, ExportError> {
    let texels = image.width as usize * image.height as usize;
    error::length(image.rgba.len(), texels, || format!("image '{}'", image.name))?;
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive);
    encoder
        .write_image(image.rgba.as_flattened(), image.width, image.height, ExtendedColorType::Rgba8)
        .map_err(|source| ExportError::Png { image: image.name.clone(), source })?;
    Ok(bytes)
}

fn sampler((wrap, linear): Sampler) -> Value {
    let filter = if linear { LINEAR } else { NEAREST };
    let [s, t] = wrap.map(|wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Clamp => 33071,
        Wrap::Mirror => 33648,
    });
    json!({ "magFilter": filter, "minFilter": filter, "wrapS": s, "wrapT": t })
}

/// Takes an affine map apart into KHR_texture_transform's scale, then turn, then offset; none if it shears. The sense of the turn is that
/// of [`crate::build::transformed`].
fn transform(map: &Mat3) -> Option<Value> {
    let (across, down) = (map.x_axis.truncate(), map.y_axis.truncate());
    let rotation = if across == Vec2::ZERO { down.x.atan2(down.y) } else { (-across.y).atan2(across.x) };
    let back = Mat3::from_rotation_z(rotation);
    let scale = Vec2::new((back * map.x_axis).x, (back * map.y_axis).y);
    let offset = map.z_axis.truncate();
    let again = Mat3::from_translation(offset) * Mat3::from_rotation_z(-rotation) * Mat3::from_scale(scale);
    let tolerance = 1e-5 * (1.0 + across.length() + down.length());
    again.abs_diff_eq(*map, tolerance).then(|| json!({ "offset": offset.to_array(), "rotation": rotation, "scale": scale.to_array() }))
}

fn find_or_push<T: PartialEq>(items: &mut Vec<T>, item: T) -> usize {
    items.iter().position(|known| *known == item).unwrap_or_else(|| {
        items.push(item);
        items.len() - 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{tiled, transformed};

    #[test]
    fn transforms_come_apart_into_what_they_were_made_of() {
        for (offset, angle, scale) in [([0.3, -2.0], 0.7, [2.0, 5.0]), ([0.0, 1.0], -2.9, [0.5, -0.25]), ([0.0, 0.0], 0.0, [-1.0, 3.0])] {
            let map = transformed(tiled(0), offset, angle, scale).transform;
            let parts = transform(&map).expect("nothing is sheared");
            let number = |value: &Value| value.as_f64().expect("a number") as f32;
            let pair = |name: &str| [number(&parts[name][0]), number(&parts[name][1])];
            let again = transformed(tiled(0), pair("offset"), number(&parts["rotation"]), pair("scale")).transform;
            assert!(again.abs_diff_eq(map, 1e-5), "{map} became {again}");
        }
    }

    #[test]
    fn shear_is_refused() {
        let sheared = Mat3::from_cols_array(&[1.0, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 1.0]);
        assert!(transform(&sheared).is_none());
    }
}
