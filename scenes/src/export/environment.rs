//! The environment as OpenEXR.

use super::{ExportError, error};
use aquifer_scene::Environment;
use exr::prelude::{Encoding, Image, SpecificChannels, WritableImage};
use std::io::Cursor;

/// 32-bit float RGB, ZIP16 compressed: the same map gives the same bytes.
pub(super) fn exr(environment: &Environment) -> Result<Vec<u8>, ExportError> {
    let (width, height) = (environment.width as usize, environment.height as usize);
    error::length(environment.radiance.len(), width * height, || "the environment".into())?;
    error::finite(environment.radiance.as_flattened(), || "the environment".into())?;
    let channels = SpecificChannels::rgb(|at: exr::math::Vec2<usize>| {
        let [r, g, b] = environment.radiance[at.y() * width + at.x()];
        (r, g, b)
    });
    let image = Image::from_encoded_channels((width, height), Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).map_err(|source| ExportError::Exr { source })?;
    Ok(bytes.into_inner())
}
