//! Films as PNG: display-referred colour in 8-bit sRGB.

use super::{Film, FilmError};
use crate::atomic;
use image::{ImageFormat, ImageReader, RgbImage};
use std::{fs::File, io, path::Path};

pub(super) fn write(film: &Film, path: &Path) -> Result<(), FilmError> {
    let bytes = bytes(film).map_err(|source| FilmError::Png { path: path.to_owned(), source })?;
    Ok(atomic::write(path, &bytes)?)
}

/// The file's content.
pub(crate) fn bytes(film: &Film) -> Result<Vec<u8>, image::ImageError> {
    let bytes = film.color.iter().flatten().map(|&linear| encode(linear)).collect();
    let [width, height] = film.size;
    let picture = RgbImage::from_raw(width, height, bytes).expect("the film's planes were checked against its size");
    let mut file = io::Cursor::new(Vec::new());
    picture.write_to(&mut file, ImageFormat::Png)?;
    Ok(file.into_inner())
}

pub(super) fn read(path: &Path) -> Result<Film, FilmError> {
    let file = File::open(path).map_err(|source| FilmError::Open { path: path.to_owned(), source })?;
    let picture = ImageReader::with_format(io::BufReader::new(file), ImageFormat::Png)
        .decode()
        .map_err(|source| FilmError::Png { path: path.to_owned(), source })?
        .into_rgb16();
    let color = picture.pixels().map(|pixel| pixel.0.map(|value| linear(f32::from(value) / f32::from(u16::MAX)))).collect();
    Film::new([picture.width(), picture.height()], color)
}

/// A linear value as a screen takes it, in 8 bits. NaN becomes 0.
pub fn encode(linear: f32) -> u8 {
    (srgb(linear) * 255.0).round() as u8
}

/// IEC 61966-2-1 transfer function; what lies outside 0 to 1 is cut off.
pub(crate) fn srgb(linear: f32) -> f32 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// What a screen makes of an encoded value, 0 to 1: the inverse of the IEC 61966-2-1 transfer function.
pub fn linear(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_survives() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let grey: Vec<[f32; 3]> = (0..=255).map(|code| [linear(code as f32 / 255.0); 3]).collect();
        let film = Film::new([16, 16], grey).unwrap();
        film.write(&path).unwrap();
        let codes = image::open(&path).unwrap().into_rgb8();
        assert!(codes.pixels().zip(0..=255).all(|(pixel, code)| pixel.0 == [code; 3]));
        let back = Film::read(&path).unwrap();
        for (a, b) in film.color.iter().flatten().zip(back.color.iter().flatten()) {
            assert!((a - b).abs() < 1e-6);
        }
    }

    #[test]
    fn known_values_and_what_is_out_of_range() {
        assert_eq!([0.0, 1.0, 0.5, 0.214_041_14].map(encode), [0, 255, 188, 128]);
        assert_eq!([-1.0, 7.0, f32::NAN, f32::INFINITY].map(encode), [0, 255, 0, 255]);
    }

    #[test]
    fn rubbish_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        std::fs::write(&path, b"no picture").unwrap();
        assert!(matches!(Film::read(&path), Err(FilmError::Png { .. })));
        assert!(matches!(Film::read(&folder.path().join("a.jpg")), Err(FilmError::UnknownFormat { .. })));
    }
}
