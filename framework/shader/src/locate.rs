//! Faults with their places: those of a module's own text, and those of the linked text, whose source is found again.

use crate::{
    Library, ShaderError,
    compose::unmangle,
    source::{declarations, words},
};
use std::error::Error as _;

/// A fault at an offset of a module's text.
pub fn at(library: &Library, module: &str, offset: usize, message: String) -> ShaderError {
    within(library, module, offset, "", message)
}

/// A fault of a module as a whole.
pub fn file(library: &Library, module: &str, message: String) -> ShaderError {
    ShaderError::Invalid { place: origin(library, module), message, excerpt: String::new() }
}

/// A fault at the declaration of that name.
pub fn declaration(library: &Library, module: &str, name: &str, message: String) -> ShaderError {
    let found = library.module(module).ok().and_then(|module| declarations(&module.code).into_iter().find(|one| one.name == name));
    match found {
        Some(found) => at(library, module, found.range.start, message),
        None => file(library, module, message),
    }
}

/// A fault at an offset of a module's text whose slots are filled, which moves columns, but no lines.
pub fn filled(library: &Library, module: &str, text: &str, offset: usize, message: String) -> ShaderError {
    let before = text.get(..offset).unwrap_or(text);
    let number = before.matches('\n').count();
    let line = text.lines().nth(number).unwrap_or_default();
    let column = before.len() - before.rfind('\n').map_or(0, |end| end + 1);
    let own = library.text(module).unwrap_or_default();
    let start = own.split_inclusive('\n').take(number).map(str::len).sum::<usize>();
    let own = own[start..].lines().next().unwrap_or_default();
    // Before a slot's path columns agree, and after it their distances from the line's end.
    let agree = own.bytes().zip(line.bytes()).take_while(|(a, b)| a == b).count();
    let column = if column <= agree { column } else { own.len().saturating_sub(line.len().saturating_sub(column)) };
    at(library, module, start + column, message)
}

/// A fault at an offset of the linked text of `entry`.
pub fn linked(library: &Library, entry: &str, text: &str, offset: Option<usize>, message: &str) -> ShaderError {
    let message = readable(library, message);
    match offset.and_then(|offset| source_of(library, entry, text, offset)) {
        Some(source) => within(library, &source.module, source.offset, &source.name, message),
        None => file(library, entry, message),
    }
}

/// naga's validation error, with its causes.
pub fn invalid(library: &Library, entry: &str, text: &str, error: &naga::WithSpan<naga::valid::ValidationError>) -> ShaderError {
    let mut message = error.as_inner().to_string();
    let mut cause = error.as_inner().source();
    while let Some(inner) = cause {
        message = format!("{message}: {inner}");
        cause = inner.source();
    }
    // The last span is the innermost.
    let span = error.spans().last().and_then(|(span, _)| span.to_range()).map(|range| range.start);
    let offset = span.or_else(|| declarations(text).into_iter().find(|one| Some(one.name) == blamed(error)).map(|one| one.range.start));
    linked(library, entry, text, offset, &message)
}

/// The declaration that naga names where it gives no span.
fn blamed(error: &naga::WithSpan<naga::valid::ValidationError>) -> Option<&str> {
    use naga::valid::ValidationError as Error;
    match error.as_inner() {
        Error::Type { name, .. }
        | Error::Constant { name, .. }
        | Error::Override { name, .. }
        | Error::GlobalVariable { name, .. }
        | Error::Function { name, .. }
        | Error::EntryPoint { name, .. } => Some(name),
        _ => None,
    }
}

fn within(library: &Library, module: &str, offset: usize, name: &str, message: String) -> ShaderError {
    let text = library.text(module).unwrap_or_default();
    let before = text.get(..offset).unwrap_or(text);
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    let line = text[start..].lines().next().unwrap_or_default();
    let column = before[start..].chars().count();
    let name = if name.is_empty() { String::new() } else { format!(" in {name}") };
    let place = format!("{}:{}:{}{name}", origin(library, module), before.matches('\n').count() + 1, column + 1);
    ShaderError::Invalid { place, message, excerpt: format!("\n  | {line}\n  | {}^", " ".repeat(column)) }
}

fn origin(library: &Library, module: &str) -> String {
    library.module(module).map_or_else(|_| format!("{module}.wgsl"), |module| module.origin.clone())
}

/// Where something of the linked text came from.
struct Source {
    module: String,
    /// Of the declaration.
    name: String,
    offset: usize,
}

fn source_of(library: &Library, entry: &str, text: &str, offset: usize) -> Option<Source> {
    let declaration = declarations(text).into_iter().find(|one| one.range.contains(&offset) && !one.name.is_empty())?;
    let (module, name) = item(library, declaration.name).unwrap_or_else(|| (entry.to_owned(), declaration.name.to_owned()));
    let piece = &text[declaration.range.clone()];
    let here = offset - declaration.range.start;
    let linked: Vec<String> = words(piece).map(|(_, word)| item(library, word).map_or_else(|| word.to_owned(), |(_, item)| item)).collect();
    let wanted = words(piece).position(|(start, word)| here < start + word.len()).unwrap_or(linked.len().saturating_sub(1));

    let code = &library.module(&module).ok()?.code;
    let candidates = declarations(code).into_iter().filter(|one| one.name == name);
    let aligned = candidates.map(|one| {
        let own: Vec<(usize, &str)> = words(&code[one.range.clone()]).collect();
        (one.range.start, align(&linked, &own), own)
    });
    // One name may be declared under several conditions.
    let (start, partners, own) = aligned.max_by_key(|(_, partners, _)| partners.iter().flatten().count())?;
    // Words that the linker wrote anew have none: the nearest before then says the line.
    let nearest = partners[..=wanted].iter().rev().chain(&partners[wanted..]).flatten().next();
    Some(Source { module, name, offset: start + nearest.map_or(0, |partner| own[*partner].0) })
}

/// Module and item of a linked name that is not the entry module's own.
fn item(library: &Library, name: &str) -> Option<(String, String)> {
    unmangle(name).filter(|(module, _)| library.text(module).is_some())
}

/// Linked names as the modules write them.
fn readable(library: &Library, message: &str) -> String {
    let (mut said, mut from) = (String::new(), 0);
    for (at, word) in words(message) {
        if let Some((_, item)) = item(library, word) {
            said = said + &message[from..at] + &item;
            from = at + word.len();
        }
    }
    said + &message[from..]
}

/// For each linked word the place of the source's word that it came from. Conditions take words out, and the linker prints lines and brackets
/// its own way, so the most words in order are paired; among equals, those that stay together.
fn align(linked: &[String], source: &[(usize, &str)]) -> Vec<Option<usize>> {
    const PAIR: u32 = 2;
    const TOGETHER: u32 = 1;
    let width = source.len() + 1;
    // The best score from a pair of words on: any, and with these two paired.
    let mut best = vec![0_u32; (linked.len() + 1) * width];
    let mut paired = best.clone();
    for i in (0..linked.len()).rev() {
        for j in (0..source.len()).rev() {
            let (here, next) = (i * width + j, (i + 1) * width + j + 1);
            if linked[i] == source[j].1 {
                let together = if paired[next] > 0 { paired[next] + TOGETHER } else { 0 };
                paired[here] = PAIR + best[next].max(together);
            }
            best[here] = paired[here].max(best[here + 1]).max(best[here + width]);
        }
    }
    let mut partners = vec![None; linked.len()];
    let (mut i, mut j, mut bonus) = (0, 0, 0);
    while i < linked.len() && j < source.len() {
        let here = i * width + j;
        if paired[here] > 0 && paired[here] + bonus >= best[here] {
            partners[i] = Some(j);
            (i, j, bonus) = (i + 1, j + 1, TOGETHER);
        } else {
            (i, j) = if best[here + 1] == best[here] { (i, j + 1) } else { (i + 1, j) };
            bonus = 0;
        }
    }
    partners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_find_their_source_past_what_conditions_took_out() {
        let linked: Vec<String> = words("met = x ; met = y").map(|(_, word)| word.to_owned()).collect();
        let text = "@if(alpha) { met *= p; } met = x;\n met = (y);";
        let own: Vec<(usize, &str)> = words(text).collect();
        let places: Vec<usize> = align(&linked, &own).into_iter().map(|partner| own[partner.unwrap()].0).collect();
        assert_eq!(places, [25, 31, 35, 42]);
    }

    #[test]
    fn names_are_shown_as_they_are_written() {
        let mut library = Library::new();
        library.insert("base/math", "const PI = 3.0;", "math.wgsl");
        assert_eq!(readable(&library, "no `base__math__PI` in `my__own`"), "no `PI` in `my__own`");
    }
}
