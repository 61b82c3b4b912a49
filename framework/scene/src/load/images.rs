//! Images: found, sized up, decoded to 8 bits a channel.

use super::{LoadError, Loader, MAX_IMAGE_SIDE, MAX_TEXELS, limits::spend, resolve};
use crate::Image;
use image::{ImageFormat, ImageReader, Limits};
use std::{borrow::Cow, io::Cursor};

impl Loader<'_> {
    /// The scene's image for image `index` of the file. One that is read both as sRGB and as linear becomes two.
    pub(super) fn image(&mut self, index: usize, srgb: bool) -> Result<u32, LoadError> {
        if let Some(&known) = self.images.get(&(index, srgb)) {
            return Ok(known);
        }
        let other = self.images.get(&(index, !srgb)).map(|&other| self.scene.images[other as usize].clone());
        let image = match other {
            Some(image) => {
                spend(&self.budget.texels, image.rgba.len() as u64, MAX_TEXELS, "texels of all images")?;
                Image { srgb, ..image }
            }
            None => self.decode_image(index, srgb)?,
        };
        let new = self.scene.images.len() as u32;
        self.scene.images.push(image);
        self.images.insert((index, srgb), new);
        Ok(new)
    }

    fn decode_image(&self, index: usize, srgb: bool) -> Result<Image, LoadError> {
        let pointer = format!("/images/{index}");
        let images = &self.document.as_json().images;
        let image = images.get(index).ok_or(LoadError::Index { pointer: pointer.clone(), index: index as u64, count: images.len() })?;
        let bytes: Cow<'_, [u8]> = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => Cow::Owned(resolve::resolve(uri, self.folder.as_deref(), &format!("{pointer}/uri"))?),
            (None, Some(view)) => Cow::Borrowed(self.view_bytes(view)?),
            (None, None) => return Err(LoadError::invalid(pointer, "has neither a URI nor a buffer view")),
        };
        let failed = |why: String| LoadError::Image { at: pointer.clone(), why };
        let size = dimensions(&bytes).map_err(failed)?;
        spend(&self.budget.texels, u64::from(size[0]) * u64::from(size[1]), MAX_TEXELS, "texels of all images")?;
        let decoded = reader(&bytes).and_then(|reader| reader.decode().map_err(|error| error.to_string())).map_err(failed)?;
        let rgba = decoded.into_rgba8();
        let (width, height) = rgba.dimensions();
        let name = image.name.clone().or_else(|| image.uri.clone().filter(|uri| !uri.starts_with("data:")));
        Ok(Image { name: name.unwrap_or(pointer), width, height, rgba: rgba.pixels().map(|pixel| pixel.0).collect(), srgb })
    }
}

fn dimensions(bytes: &[u8]) -> Result<[u32; 2], String> {
    let (width, height) = reader(bytes)?.into_dimensions().map_err(|error| error.to_string())?;
    if width > MAX_IMAGE_SIDE || height > MAX_IMAGE_SIDE {
        return Err(format!("{width} × {height} is more than {MAX_IMAGE_SIDE} a side"));
    }
    if width == 0 || height == 0 { Err("has no texels".to_owned()) } else { Ok([width, height]) }
}

/// glTF knows PNG and JPEG; the bytes decide which, not the file's word.
fn reader(bytes: &[u8]) -> Result<ImageReader<Cursor<&[u8]>>, String> {
    let format = image::guess_format(bytes).ok().filter(|format| matches!(format, ImageFormat::Png | ImageFormat::Jpeg));
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format.ok_or("neither PNG nor JPEG")?);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_IMAGE_SIDE);
    limits.max_image_height = Some(MAX_IMAGE_SIDE);
    limits.max_alloc = Some(MAX_TEXELS * 8);
    reader.limits(limits);
    Ok(reader)
}
