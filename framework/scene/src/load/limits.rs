//! What a file may ask for. Checked before memory is taken.

use super::LoadError;
use std::cell::Cell;

/// Bytes of one file, and of all the buffers of a scene together: 2 GiB.
pub const MAX_FILE_BYTES: u64 = 1 << 31;
/// Objects of one kind (nodes, meshes, materials, accessors …).
pub const MAX_OBJECTS: usize = 1 << 20;
/// Triangles of all meshes together, before instancing.
pub const MAX_TRIANGLES: u64 = 1 << 25;
/// Elements of accessors that have no bytes of their own and start as zeros.
pub const MAX_ZEROS: u64 = 1 << 22;
/// Animation values of all channels together.
pub const MAX_KEYS: u64 = 1 << 24;
/// Width and height of an image.
pub const MAX_IMAGE_SIDE: u32 = 1 << 14;
/// Texels of all images together, 4 bytes each.
pub const MAX_TEXELS: u64 = 1 << 28;
/// Texels of an environment map, 12 bytes each.
pub const MAX_ENVIRONMENT_TEXELS: u64 = 1 << 26;

/// What a file has used up.
#[derive(Default)]
pub(super) struct Budget {
    pub triangles: Cell<u64>,
    pub zeros: Cell<u64>,
    pub keys: Cell<u64>,
    pub texels: Cell<u64>,
}

/// Adds to what is used, within the limit.
pub(super) fn spend(used: &Cell<u64>, more: u64, limit: u64, what: &str) -> Result<(), LoadError> {
    used.set(used.get().saturating_add(more));
    within(used.get(), limit, what)
}

pub(super) fn within(size: u64, limit: u64, what: &str) -> Result<(), LoadError> {
    if size <= limit { Ok(()) } else { Err(LoadError::TooLarge { what: what.to_owned(), size, limit }) }
}
