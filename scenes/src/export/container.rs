//! The GLB container: a header, a JSON chunk, a binary chunk (glTF 2.0, section 4).

use super::ExportError;
use serde_json::Value;

const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

pub(super) fn glb(document: &Value, mut binary: Vec<u8>) -> Result<Vec<u8>, ExportError> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let bytes = HEADER + 2 * CHUNK_HEADER + json.len() + binary.len();
    let total = u32::try_from(bytes).map_err(|_| ExportError::TooLarge { bytes })?;

    let mut file = Vec::with_capacity(bytes);
    file.extend_from_slice(b"glTF");
    file.extend_from_slice(&2_u32.to_le_bytes());
    file.extend_from_slice(&total.to_le_bytes());
    chunk(&mut file, b"JSON", &json);
    chunk(&mut file, b"BIN\0", &binary);
    Ok(file)
}

/// Lengths fit: the caller has checked the total.
fn chunk(file: &mut Vec<u8>, kind: &[u8; 4], content: &[u8]) {
    file.extend_from_slice(&(content.len() as u32).to_le_bytes());
    file.extend_from_slice(kind);
    file.extend_from_slice(content);
}
