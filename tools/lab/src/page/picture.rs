//! Images as the page carries them: half floats and bytes in base64.

use super::PageError;
use crate::{
    film::Film,
    metrics::{FlipMap, flip_hdr},
};
use half::f16;
use serde::Serialize;
use std::path::Path;

/// The page stays a file that mails and browsers take: beyond this many characters of base64, images stay on disk alone.
pub(super) const MOST_EMBEDDED: usize = 64 << 20;

/// Bytes in the page, by the id of their element.
#[derive(Debug, Serialize)]
pub(super) struct Payload {
    pub(super) id: String,
    pub(super) base64: String,
}

/// Payloads of the whole page.
#[derive(Debug, Default)]
pub(super) struct Store {
    pub(super) payloads: Vec<Payload>,
    used: usize,
}

impl Store {
    /// Would the radiance and the error map of one more image fit?
    pub(super) fn has_room(&self, pixels: usize) -> bool {
        self.used + 4 * (pixels * (3 * size_of::<f16>() + 1)) / 3 <= MOST_EMBEDDED
    }

    /// Keeps bytes; gives the id.
    fn keep(&mut self, bytes: &[u8]) -> String {
        let (id, base64) = (format!("px-{}", self.payloads.len()), base64(bytes));
        self.used += base64.len();
        self.payloads.push(Payload { id: id.clone(), base64 });
        id
    }

    /// Radiance as half floats, red, green and blue of every pixel.
    pub(super) fn radiance(&mut self, film: &Film) -> String {
        let bytes: Vec<u8> = film.color.iter().flatten().flat_map(|&c| to_half(c).to_le_bytes()).collect();
        self.keep(&bytes)
    }

    /// HDR-FLIP against the reference, a byte a pixel; `None` against black.
    pub(super) fn flip(&mut self, film: &Film, reference: &Film) -> Result<Option<String>, PageError> {
        let map = flip_hdr(film, reference)?;
        Ok(map.map(|FlipMap { errors, .. }| {
            let bytes: Vec<u8> = errors.iter().map(|error| (255.0 * error).round() as u8).collect();
            self.keep(&bytes)
        }))
    }
}

/// What is finite stays finite.
fn to_half(value: f32) -> f16 {
    match value.is_finite() {
        true => f16::from_f32(value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32())),
        false => f16::from_f32(value),
    }
}

/// An image of the report; `None` where the file is not there.
pub(super) fn read(folder: &Path, name: Option<&String>) -> Result<Option<Film>, PageError> {
    match name.map(|name| folder.join(name)).filter(|path| path.exists()) {
        Some(path) => Ok(Some(Film::read(&path)?)),
        None => Ok(None),
    }
}

pub(super) fn base64(bytes: &[u8]) -> String {
    base64::encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finite_stays_finite_and_broken_stays_broken() {
        assert_eq!(to_half(1e9), f16::MAX);
        assert!(to_half(f32::NAN).is_nan() && to_half(f32::INFINITY).is_infinite());
        assert_eq!(to_half(0.5).to_le_bytes(), [0x00, 0x38]);
    }

    #[test]
    fn the_page_does_not_grow_without_end() {
        let mut store = Store::default();
        let film = Film::new([2, 1], vec![[1.0, 0.5, 0.0]; 2]).unwrap();
        assert_eq!((store.radiance(&film), store.payloads[0].base64.as_str()), ("px-0".into(), "ADwAOAAAADwAOAAA"));
        assert!(store.has_room(1 << 20) && !store.has_room(8 << 20));
        assert_eq!(store.flip(&film, &film).unwrap(), Some("px-1".into()));
    }
}
