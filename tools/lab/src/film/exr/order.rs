//! Attributes in a fixed order.
//!
//! The EXR coder keeps attributes in a hash map and so writes them in another order every time. Sorting them afterwards makes equal films
//! equal bytes: attributes are self-contained (`name\0 type\0 size bytes`), and the offsets that follow the header do not change.

/// Magic number and version of every EXR file.
const PREFIX: usize = 8;

/// Sorts the attributes of a freshly written single-part file by name.
pub(super) fn sort_attributes(file: &mut [u8]) {
    let mut attributes = Vec::new();
    let mut at = PREFIX;
    while let Some(length) = file.get(at..).and_then(attribute_length) {
        attributes.push(file[at..at + length].to_vec());
        at += length;
    }
    attributes.sort();
    file[PREFIX..at].copy_from_slice(&attributes.concat());
}

/// Length of the attribute that `bytes` begins with; `None` at the header's end.
fn attribute_length(bytes: &[u8]) -> Option<usize> {
    let name = text_length(bytes)?;
    if name == 1 {
        return None;
    }
    let kind = text_length(bytes.get(name..)?)?;
    let size_at = name + kind;
    let size: [u8; 4] = bytes.get(size_at..size_at + 4)?.try_into().ok()?;
    let length = size_at + 4 + u32::from_le_bytes(size) as usize;
    (length <= bytes.len()).then_some(length)
}

/// With the closing zero.
fn text_length(bytes: &[u8]) -> Option<usize> {
    bytes.iter().position(|&byte| byte == 0).map(|end| end + 1)
}
