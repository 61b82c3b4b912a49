//! Environment maps from `.exr` and `.hdr` files.

use super::{LoadError, MAX_ENVIRONMENT_TEXELS, guarded, limits::within, resolve::read_file};
use crate::Environment;
use exr::prelude::{ReadChannels, ReadLayers};
use glam::Mat3;
use image::{ImageFormat, ImageReader};
use std::{io::Cursor, path::Path};

const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

struct Pixels {
    width: usize,
    radiance: Vec<[f32; 3]>,
}

impl Environment {
    /// Reads an equirectangular map: OpenEXR (the first layer that has R, G and B) or Radiance HDR. The bytes decide which. Negative
    /// values, which resampling leaves behind, become 0.
    ///
    /// # Errors
    /// When the file cannot be read or decoded, holds NaN or infinity, or is larger than [`MAX_ENVIRONMENT_TEXELS`].
    pub fn load(path: &Path) -> Result<Environment, LoadError> {
        let bytes = read_file(path)?;
        let at = path.display().to_string();
        let mut map = guarded(|| decode(&bytes, &at))?;
        map.name = at;
        Ok(map)
    }
}

fn decode(bytes: &[u8], at: &str) -> Result<Environment, LoadError> {
    let pixels = if bytes.starts_with(&EXR_MAGIC) { decode_exr(bytes, at)? } else { decode_hdr(bytes, at)? };
    if let Some(index) = pixels.radiance.iter().position(|texel| !texel.iter().all(|value| value.is_finite())) {
        return Err(LoadError::NotFinite { pointer: format!("{at}: texel ({}, {})", index % pixels.width, index / pixels.width) });
    }
    let radiance: Vec<_> = pixels.radiance.into_iter().map(|texel| texel.map(|value| value.max(0.0))).collect();
    let (width, height) = (pixels.width as u32, (radiance.len() / pixels.width) as u32);
    Ok(Environment { name: String::new(), width, height, radiance, world_to_map: Mat3::IDENTITY })
}

fn decode_hdr(bytes: &[u8], at: &str) -> Result<Pixels, LoadError> {
    let failed = |why: String| LoadError::Image { at: at.to_owned(), why };
    let reader = || ImageReader::with_format(Cursor::new(bytes), ImageFormat::Hdr);
    if !bytes.starts_with(b"#?") {
        return Err(failed("neither OpenEXR nor Radiance HDR".to_owned()));
    }
    let (width, height) = reader().into_dimensions().map_err(|error| failed(error.to_string()))?;
    check_size(width.into(), height.into(), at)?;
    let image = reader().decode().map_err(|error| failed(error.to_string()))?.into_rgb32f();
    Ok(Pixels { width: width as usize, radiance: image.pixels().map(|pixel| pixel.0).collect() })
}

fn decode_exr(bytes: &[u8], at: &str) -> Result<Pixels, LoadError> {
    let failed = |error: exr::error::Error| LoadError::Image { at: at.to_owned(), why: error.to_string() };
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(failed)?;
    for header in &meta.headers {
        check_size(header.layer_size.width() as u64, header.layer_size.height() as u64, at)?;
    }
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| Pixels { width: size.width(), radiance: vec![[0.0; 3]; size.area()] },
            |pixels, at, (r, g, b, _): (f32, f32, f32, f32)| {
                let index = at.y() * pixels.width + at.x();
                pixels.radiance[index] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(failed)?;
    Ok(image.layer_data.channel_data.pixels)
}

fn check_size(width: u64, height: u64, at: &str) -> Result<(), LoadError> {
    if width == 0 || height == 0 {
        return Err(LoadError::Image { at: at.to_owned(), why: "has no texels".to_owned() });
    }
    within(width.saturating_mul(height), MAX_ENVIRONMENT_TEXELS, &format!("{at}: texels"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{WritableImage, write_rgb_file};

    fn texel(x: usize, y: usize) -> [f32; 3] {
        [x as f32, y as f32 * 0.5, 7e4]
    }

    #[test]
    fn exr_maps_are_read_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.exr");
        write_rgb_file(&path, 6, 3, |x, y| texel(x, y).into()).unwrap();
        let map = Environment::load(&path).unwrap();
        assert_eq!((map.width, map.height), (6, 3));
        for (index, &found) in map.radiance.iter().enumerate() {
            assert_eq!(found, texel(index % 6, index / 6));
        }
    }

    #[test]
    fn hdr_maps_are_read_to_their_precision() {
        let pixels: Vec<image::Rgb<f32>> = (0..18).map(|i| image::Rgb([i as f32, 2.0, 0.25])).collect();
        let mut bytes = Vec::new();
        image::codecs::hdr::HdrEncoder::new(&mut bytes).encode(&pixels, 6, 3).unwrap();
        let map = decode(&bytes, "").unwrap();
        assert_eq!((map.width, map.height), (6, 3));
        for (found, pixel) in map.radiance.iter().zip(&pixels) {
            let largest = pixel.0.into_iter().fold(0.0, f32::max);
            assert!(found.iter().zip(pixel.0).all(|(a, b)| (a - b).abs() <= largest / 128.0), "{found:?} {pixel:?}");
        }
    }

    #[test]
    fn negative_values_go_and_others_that_are_no_light_are_refused() {
        let exr = |value: f32| {
            let mut bytes = Cursor::new(Vec::new());
            let channels = exr::prelude::SpecificChannels::rgb(move |_: exr::prelude::Vec2<usize>| (value, 1.0_f32, 1.0_f32));
            exr::prelude::Image::from_channels((2, 2), channels).write().to_buffered(&mut bytes).unwrap();
            decode(&bytes.into_inner(), "map")
        };
        assert_eq!(exr(-1.0).unwrap().radiance, [[0.0, 1.0, 1.0]; 4]);
        assert_eq!(exr(f32::NAN).unwrap_err().to_string(), "map: texel (0, 0): not a finite 32-bit number");
        assert!(matches!(exr(f32::INFINITY), Err(LoadError::NotFinite { .. })));
    }

    #[test]
    fn broken_maps_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.exr");
        write_rgb_file(&path, 6, 3, |x, y| texel(x, y).into()).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for length in (0..whole.len()).step_by(7) {
            let result = guarded(|| decode(&whole[..length], "map"));
            assert!(result.is_err() && !matches!(result, Err(LoadError::Panicked { .. })), "{length}");
        }
        assert!(matches!(
            decode(b"#?RADIANCE\n\n-Y 9999999 +X 9999999\n", "map"),
            Err(LoadError::TooLarge { .. } | LoadError::Image { .. })
        ));
    }
}
