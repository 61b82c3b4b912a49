//! From a place in the linked text back to the source line that it came from.

use crate::{Library, ShaderError, compose::unmangle};
use std::error::Error as _;

/// A fault at an offset of the linked text.
pub fn fault(library: &Library, text: &str, offset: Option<usize>, message: String) -> ShaderError {
    let Some(offset) = offset.filter(|offset| *offset < text.len()) else {
        return ShaderError::Invalid { place: "linked shader".into(), message, excerpt: String::new() };
    };
    let start = text[..offset].rfind('\n').map_or(0, |at| at + 1);
    let line = text[start..].lines().next().unwrap_or_default();
    let (name, module) = declaration(&text[..start + line.len()]);
    let place = module.and_then(|module| source_place(library, &module, line)).unwrap_or_else(|| "linked shader".into());
    let within = name.map(|name| format!(" in {name}")).unwrap_or_default();
    let caret = " ".repeat(text[start..offset].chars().count()) + "^";
    ShaderError::Invalid { place: format!("{place}{within}"), message, excerpt: format!("  | {line}\n  | {caret}") }
}

/// naga's validation error, with its causes.
pub fn invalid(library: &Library, text: &str, error: &naga::WithSpan<naga::valid::ValidationError>) -> ShaderError {
    let mut message = error.as_inner().to_string();
    let mut cause = error.as_inner().source();
    while let Some(inner) = cause {
        message = format!("{message}: {inner}");
        cause = inner.source();
    }
    // The last span is the innermost.
    let offset = error.spans().last().and_then(|(span, _)| span.to_range()).map(|range| range.start);
    fault(library, text, offset, message)
}

/// Name and module of the last declaration that begins in `text`.
fn declaration(text: &str) -> (Option<String>, Option<String>) {
    const WORDS: [&str; 5] = ["fn ", "struct ", "override ", "const ", "alias "];
    for line in text.lines().rev() {
        let line = line.trim_start_matches('@');
        let at = WORDS.iter().filter_map(|word| line.find(word).map(|at| at + word.len())).min();
        let Some(at) = at.filter(|_| !line.starts_with(' ')) else { continue };
        let name: String = line[at..].chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
        return match unmangle(&name) {
            Some((module, item)) => (Some(item), Some(module)),
            None => (Some(name), None),
        };
    }
    (None, None)
}

/// `origin:line` of the source line that reads like `line` once names are unmangled and spaces dropped.
fn source_place(library: &Library, module: &str, line: &str) -> Option<String> {
    let origin = &library.module(module).ok()?.origin;
    let wanted = squeeze(line);
    let found = library.text(module)?.lines().position(|source| squeeze(source) == wanted);
    Some(found.map_or_else(|| origin.clone(), |at| format!("{origin}:{}", at + 1)))
}

/// Letters and digits only, module prefixes dropped: the printer moves spaces and brackets, and the linker mangles names.
fn squeeze(line: &str) -> String {
    let words = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty());
    words.map(|word| unmangle(word).map_or_else(|| word.to_owned(), |(_, item)| item)).collect::<Vec<_>>().join(" ")
}
