//! The text of a module in pieces: its code without comments, its declarations, its words.

use std::ops::Range;

/// The text with spaces in place of comments: what is found in it lies where it lies in the text.
pub fn code(text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let mut at = 0;
    while let Some(start) = text[at..].find("//").into_iter().chain(text[at..].find("/*")).min().map(|found| at + found) {
        let end = start
            + if text[start..].starts_with("//") { text[start..].find('\n') } else { block(&text[start..]) }.unwrap_or(text.len() - start);
        bytes[start..end].iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
        at = end;
    }
    // Comments are blanked as a whole, so no letter is cut.
    String::from_utf8(bytes).unwrap_or_default()
}

/// The length of a `/* … */` that may hold others.
fn block(text: &str) -> Option<usize> {
    let (mut depth, mut at) = (0, 0);
    loop {
        let (opens, closes) = (text[at..].find("/*"), text[at..].find("*/")?);
        let opens = opens.filter(|opens| *opens < closes);
        depth += if opens.is_some() { 1 } else { -1 };
        at += opens.unwrap_or(closes) + 2;
        if depth == 0 {
            return Some(at);
        }
    }
}

/// Something declared at the top of a module.
#[derive(Debug)]
pub struct Declaration<'a> {
    /// Empty for imports and whatever else has no name.
    pub name: &'a str,
    /// From its first attribute to its end.
    pub range: Range<usize>,
}

/// Everything declared in code without comments.
pub fn declarations(code: &str) -> Vec<Declaration<'_>> {
    let mut found = Vec::new();
    let (mut depth, mut start) = (0_u32, 0);
    for (at, byte) in code.bytes().enumerate() {
        match byte {
            b'{' | b'(' | b'[' => depth += 1,
            b'}' | b')' | b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        let ends = depth == 0 && matches!(byte, b'}' | b';');
        if ends || at + 1 == code.len() {
            let piece = &code[start..=at];
            let from = start + piece.len() - piece.trim_start().len();
            found.push(Declaration { name: declared(piece).unwrap_or_default(), range: from..at + 1 });
            start = at + 1;
        }
    }
    found
}

fn declared(piece: &str) -> Option<&str> {
    const WORDS: [&str; 5] = ["fn", "struct", "override", "const", "alias"];
    let piece = without_attributes(piece);
    let rest = WORDS.iter().find_map(|word| piece.strip_prefix(word)?.strip_prefix(char::is_whitespace)).or_else(|| {
        let rest = piece.strip_prefix("var")?;
        if rest.trim_start().starts_with('<') { Some(rest.split_once('>')?.1) } else { rest.strip_prefix(char::is_whitespace) }
    })?;
    let rest = rest.trim_start();
    Some(&rest[..word_length(rest)])
}

/// What follows the `@attribute`s and `@attribute(arguments)` at the beginning of a text.
pub fn without_attributes(text: &str) -> &str {
    let mut text = text.trim_start();
    while let Some(rest) = text.strip_prefix('@') {
        let rest = &rest[word_length(rest)..];
        text = if rest.starts_with('(') { &rest[enclosed(rest)..] } else { rest }.trim_start();
    }
    text
}

/// The length of a text from its first `(` to the `)` that closes it, or of all of it.
fn enclosed(text: &str) -> usize {
    let mut depth = 0;
    let end = text.find(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth == 0
    });
    end.map_or(text.len(), |end| end + 1)
}

/// Names, keywords and numbers, each with its place.
pub fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let start = from + text[from..].find(is_word)?;
        from = start + word_length(&text[start..]);
        Some((start, &text[start..from]))
    })
}

/// The length of the word at the beginning of a text.
pub fn word_length(text: &str) -> usize {
    text.find(|c| !is_word(c)).unwrap_or(text.len())
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_become_spaces() {
        let text = "a // – b\n/* c /* d */\n e */ f / g // h";
        let code = code(text);
        assert_eq!(code.len(), text.len());
        assert_eq!(code.split_whitespace().collect::<Vec<_>>(), ["a", "f", "/", "g"]);
        assert_eq!(code.find('\n'), text.find('\n'));
    }

    #[test]
    fn declarations_have_names_and_ends() {
        let code = "import package::a::{b, c};\n@if((x) && y) @group(1) @binding(0) var<storage, read> d: array<u32>;\nvar e: sampler;\n\
                    @compute @workgroup_size(min(1, 2))\nfn f(x: u32) -> u32 { let y = 1; { return y; } }\nconst_assert true;\nstruct G { h: f32 }\nfn i(";
        let found = declarations(code);
        assert_eq!(found.iter().map(|one| one.name).filter(|name| !name.is_empty()).collect::<Vec<_>>(), ["d", "e", "f", "G", "i"]);
        let f = found.iter().find(|one| one.name == "f").unwrap();
        assert!(code[f.range.clone()].starts_with("@compute") && code[f.range.clone()].ends_with("} }"));
    }
}
