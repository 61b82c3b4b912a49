//! Rendered images with everything needed to use them as evidence: variance, sample counts, and what made them.

mod area;
mod channels;
mod exr;
mod facts;
mod merge;
mod png;

pub use area::{Area, AreaError, Region};
pub(crate) use exr::Packing;
pub use facts::{Facts, GraphText, Overlap, Run, Runs};
pub use merge::{MergeError, merge};
pub(crate) use png::{bytes as png_bytes, srgb};
pub use png::{encode, linear};

use crate::atomic::{self, WriteError};
use std::path::{Path, PathBuf};

/// A rendered image. Every plane holds one element a pixel, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Linear Rec. 709; for renders, the mean over all samples in radiance, W·m⁻²·sr⁻¹.
    pub color: Vec<[f32; 3]>,
    /// Variance of the mean held in `color`, i.e. its squared standard error.
    pub variance: Option<Vec<[f32; 3]>>,
    /// Base colour of the first surface, linear; black where there is none. For renders, this and the next two are the last frame's.
    pub albedo: Option<Vec<[f32; 3]>>,
    /// World-space unit normal of the first surface; zeros where there is none.
    pub normal: Option<Vec<[f32; 3]>>,
    /// Distance along the view axis to the first surface, metres; infinite where there is none.
    pub depth: Option<Vec<f32>>,
    /// What made it; `None` for images of other programs.
    pub facts: Option<Facts>,
}

/// Why an image file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The target cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The file cannot be opened.
    #[error("cannot read `{}`: {source}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The name ends in nothing that Aquifer reads or writes.
    #[error("`{}` is neither .exr nor .png", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The EXR coder failed.
    #[error("`{}`: {source}", path.display())]
    Exr {
        /// The file.
        path: PathBuf,
        /// What it said.
        source: ::exr::error::Error,
    },
    /// An EXR file that is too short for the image of its header.
    #[error("`{}`: {} bytes cannot hold {}×{} pixels of {} bytes", path.display(), bytes, size[0], size[1], bytes_per_pixel)]
    TooShort {
        /// The file.
        path: PathBuf,
        /// How long it is.
        bytes: u64,
        /// Pixels across and down.
        size: [usize; 2],
        /// Of all channels.
        bytes_per_pixel: usize,
    },
    /// The PNG coder failed.
    #[error("`{}`: {source}", path.display())]
    Png {
        /// The file.
        path: PathBuf,
        /// What it said.
        source: image::ImageError,
    },
    /// An EXR file without a channel that it must have.
    #[error("`{}` has no channel `{channel}`", path.display())]
    MissingChannel {
        /// The file.
        path: PathBuf,
        /// The channel.
        channel: String,
    },
    /// An attribute of Aquifer's own is missing or cannot be understood.
    #[error("`{}`: attribute `{name}` {why}", path.display())]
    Attribute {
        /// The file.
        path: PathBuf,
        /// The attribute.
        name: &'static str,
        /// In words.
        why: String,
    },
    /// A plane does not hold one element a pixel.
    #[error("{plane} holds {found} pixels, an image of {}×{} needs {}", size[0], size[1], u64::from(size[0]) * u64::from(size[1]))]
    PlaneSize {
        /// The plane.
        plane: &'static str,
        /// Pixels across and down.
        size: [u32; 2],
        /// Elements present.
        found: usize,
    },
}

/// The image formats, known by the ends of file names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR: every plane and fact.
    Exr,
    /// PNG: display-referred colour, 8 bits.
    Png,
}

impl Format {
    /// From the end of the file's name.
    pub fn of(path: &Path) -> Result<Self, FilmError> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        match extension.as_str() {
            "exr" => Ok(Self::Exr),
            "png" => Ok(Self::Png),
            _ => Err(FilmError::UnknownFormat { path: path.to_owned() }),
        }
    }
}

impl Film {
    /// An image of colour alone.
    pub fn new(size: [u32; 2], color: Vec<[f32; 3]>) -> Result<Self, FilmError> {
        let film = Self { size, color, ..Self::default() };
        film.check()?;
        Ok(film)
    }

    /// How many pixels.
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Reads `.exr` or `.png`. PNG colour is made linear.
    pub fn read(path: &Path) -> Result<Self, FilmError> {
        match Format::of(path)? {
            Format::Exr => exr::read(path),
            Format::Png => png::read(path),
        }
    }

    /// Writes `.exr` (everything) or `.png` (`color` alone, taken as display-referred). All or nothing.
    pub fn write(&self, path: &Path) -> Result<(), FilmError> {
        self.check()?;
        match Format::of(path)? {
            Format::Exr => Ok(atomic::write(path, &exr::encode(self, path, Packing::Packed)?)?),
            Format::Png => png::write(self, path),
        }
    }

    /// Writes `.exr`, and gives the hash of the file.
    pub(crate) fn write_hashed(&self, path: &Path, packing: Packing) -> Result<blake3::Hash, FilmError> {
        self.check()?;
        let bytes = exr::encode(self, path, packing)?;
        atomic::write(path, &bytes)?;
        Ok(blake3::hash(&bytes))
    }

    fn check(&self) -> Result<(), FilmError> {
        let planes = [
            ("color", Some(self.color.len())),
            ("variance", self.variance.as_ref().map(Vec::len)),
            ("albedo", self.albedo.as_ref().map(Vec::len)),
            ("normal", self.normal.as_ref().map(Vec::len)),
            ("depth", self.depth.as_ref().map(Vec::len)),
        ];
        for (plane, found) in planes {
            if let Some(found) = found.filter(|&found| found != self.pixels()) {
                return Err(FilmError::PlaneSize { plane, size: self.size, found });
            }
        }
        Ok(())
    }
}

/// Relative luminance of linear Rec. 709.
pub fn luminance(rgb: [f64; 3]) -> f64 {
    LUMINANCE[0] * rgb[0] + LUMINANCE[1] * rgb[1] + LUMINANCE[2] * rgb[2]
}

/// Rec. 709 luminance weights of red, green and blue.
pub const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];
