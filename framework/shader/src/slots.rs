//! Slots: `package::slot::NAME` becomes the path of the module that fills NAME.
//!
//! The rewriting is of text, before parsing: it works in every form of import, keeps line numbers, and leaves WESL's own diagnostics whole.

use crate::ShaderError;
use std::collections::{BTreeMap, BTreeSet};

const PREFIX: &str = "package::slot::";

/// Slot names that a text imports.
pub fn mentioned(text: &str) -> BTreeSet<&str> {
    text.split(PREFIX).skip(1).map(|rest| &rest[..name_length(rest)]).collect()
}

/// The module path of a filling: `di` in slot `domain` is `domain/di`; a filling with a `/` is a path already.
pub fn module_of(slot: &str, filling: &str) -> String {
    if filling.contains('/') { filling.to_owned() } else { format!("{slot}/{filling}") }
}

/// The text of module `by` with its slots filled.
pub fn fill(text: &str, by: &str, slots: &BTreeMap<String, String>) -> Result<String, ShaderError> {
    let mut pieces = text.split(PREFIX);
    let mut filled = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (slot, rest) = piece.split_at(name_length(piece));
        let filling = slots.get(slot).ok_or_else(|| ShaderError::UnfilledSlot { slot: slot.to_owned(), by: format!("{by}.wgsl") })?;
        filled.push_str("package::");
        filled.push_str(&module_of(slot, filling).replace('/', "::"));
        filled.push_str(rest);
    }
    Ok(filled)
}

fn name_length(text: &str) -> usize {
    text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len())
}
