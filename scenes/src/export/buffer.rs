//! The one buffer of the file, with its views and accessors.

use super::{ExportError, error};
use serde_json::{Value, json};

/// glTF's number for 32-bit floats.
const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;

/// What a view's bytes are for.
#[derive(Clone, Copy)]
pub(super) enum Usage {
    Vertices,
    Indices,
    Other,
}

#[derive(Default)]
pub(super) struct Buffer {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

impl Buffer {
    /// Adds bytes and returns the view's index.
    pub(super) fn view(&mut self, bytes: &[u8], usage: Usage) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        match usage {
            Usage::Vertices => view["target"] = json!(34962),
            Usage::Indices => view["target"] = json!(34963),
            Usage::Other => {}
        }
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    /// Adds vectors of N floats and returns the accessor's index.
    pub(super) fn floats<const N: usize>(
        &mut self,
        items: &[[f32; N]],
        usage: Usage,
        what: impl FnOnce() -> String,
    ) -> Result<usize, ExportError> {
        error::finite(items.as_flattened(), what)?;
        let view = self.view(&little_endian(items.as_flattened()), usage);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        Ok(self.accessor(json!({ "bufferView": view, "componentType": FLOAT, "count": items.len(), "type": kind })))
    }

    /// The same with the least and greatest values, which glTF wants for positions and key times.
    pub(super) fn bounded_floats<const N: usize>(
        &mut self,
        items: &[[f32; N]],
        usage: Usage,
        what: impl FnOnce() -> String,
    ) -> Result<usize, ExportError> {
        let accessor = self.floats(items, usage, what)?;
        let fold = |pick: fn(f32, f32) -> f32, start: f32| -> Vec<f32> {
            (0..N).map(|axis| items.iter().fold(start, |found, item| pick(found, item[axis]))).collect()
        };
        self.accessors[accessor]["min"] = json!(fold(f32::min, f32::INFINITY));
        self.accessors[accessor]["max"] = json!(fold(f32::max, f32::NEG_INFINITY));
        Ok(accessor)
    }

    /// Adds vertex indices, short where they fit (the greatest short is reserved), and returns the accessor's index.
    pub(super) fn indices(&mut self, indices: &[u32], vertex_count: usize) -> usize {
        let (component, bytes): (u32, Vec<u8>) = if vertex_count <= usize::from(u16::MAX) {
            (UNSIGNED_SHORT, indices.iter().flat_map(|i| (*i as u16).to_le_bytes()).collect())
        } else {
            (UNSIGNED_INT, indices.iter().flat_map(|i| i.to_le_bytes()).collect())
        };
        let view = self.view(&bytes, Usage::Indices);
        self.accessor(json!({ "bufferView": view, "componentType": component, "count": indices.len(), "type": "SCALAR" }))
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

fn little_endian(floats: &[f32]) -> Vec<u8> {
    floats.iter().flat_map(|value| value.to_le_bytes()).collect()
}
