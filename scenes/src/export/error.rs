//! What keeps a scene from being written.

/// Why a scene cannot be written as glTF.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// A number that JSON and glTF cannot hold.
    #[error("{what} holds a number that is not finite")]
    NotFinite {
        /// Where.
        what: String,
    },
    /// A number outside the range that glTF allows.
    #[error("{what} is {value}, outside of [{low}, {high}]")]
    OutOfRange {
        /// Which number.
        what: String,
        /// Its value.
        value: f32,
        /// Least value allowed.
        low: f32,
        /// Greatest value allowed.
        high: f32,
    },
    /// An index that points at nothing.
    #[error("{what} refers to number {index}, but there are only {count}")]
    DanglingIndex {
        /// What refers.
        what: String,
        /// To which.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// Arrays that should be as long as each other.
    #[error("{what} has {found} entries where {expected} are needed")]
    Length {
        /// Which array.
        what: String,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// KHR_texture_transform scales, turns and moves, but cannot shear.
    #[error("a texture of material '{material}' is sheared, which KHR_texture_transform cannot express")]
    ShearedTexture {
        /// The material's name.
        material: String,
    },
    /// The PNG encoder refused.
    #[error("image '{image}' cannot be written as PNG")]
    Png {
        /// Its name.
        image: String,
        /// The encoder's reason.
        source: image::ImageError,
    },
    /// The OpenEXR encoder refused.
    #[error("the environment cannot be written as OpenEXR")]
    Exr {
        /// The encoder's reason.
        source: exr::error::Error,
    },
    /// Binary glTF counts its bytes in 32 bits.
    #[error("the file would be {bytes} bytes long; binary glTF ends at 4 GiB")]
    TooLarge {
        /// How long.
        bytes: usize,
    },
}

/// Refuses numbers that are not finite.
pub(super) fn finite(values: &[f32], what: impl FnOnce() -> String) -> Result<(), ExportError> {
    if values.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(ExportError::NotFinite { what: what() }) }
}

/// Refuses numbers outside of a range, NaN among them.
pub(super) fn within(value: f32, [low, high]: [f32; 2], what: impl FnOnce() -> String) -> Result<(), ExportError> {
    if (low..=high).contains(&value) { Ok(()) } else { Err(ExportError::OutOfRange { what: what(), value, low, high }) }
}

/// Refuses an index that points at nothing.
pub(super) fn index(index: u32, count: usize, what: impl FnOnce() -> String) -> Result<(), ExportError> {
    if (index as usize) < count { Ok(()) } else { Err(ExportError::DanglingIndex { what: what(), index, count }) }
}

/// Refuses an array of the wrong length.
pub(super) fn length(found: usize, expected: usize, what: impl FnOnce() -> String) -> Result<(), ExportError> {
    if found == expected { Ok(()) } else { Err(ExportError::Length { what: what(), found, expected }) }
}
