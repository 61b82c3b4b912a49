//! What the comments of a module say: the manual page above it, `///` texts and `@tags` of its declarations, `//! bias:` lines.

use crate::source::without_attributes;
use std::{collections::HashMap, fmt};

/// Text and tags above one declaration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Doc {
    /// Lines without `@`, joined.
    pub text: String,
    /// `@name value` lines.
    pub tags: Vec<(String, String)>,
    /// The declaration's line, from 0.
    pub line: usize,
    /// The lines of the tags.
    pub tag_lines: Vec<usize>,
}

/// `bias (condition) [slot = filling]: why`. The condition is a fact of the scene, or `slot = filling`; in brackets stands what has not this bias.
/// Both may be left out.
#[derive(Debug, Default, PartialEq)]
pub struct BiasLine {
    /// Under which it biases; `None`: always.
    pub condition: Option<String>,
    /// A slot and the filling that is without it.
    pub without: Option<(String, String)>,
    /// The reason.
    pub why: String,
}

impl BiasLine {
    /// Reads what follows `//!`.
    pub fn read(line: &str) -> Option<Self> {
        let rest = line.strip_prefix("bias")?;
        let (condition, rest) = enclosed(rest, " (", ')').map_or((None, rest), |(text, rest)| (Some(text.to_owned()), rest));
        let (without, rest) = enclosed(rest, " [", ']').map_or((None, rest), |(text, rest)| (Some(text), rest));
        let without = match without {
            Some(text) => text.split_once('=').map(|(slot, filling)| Some((slot.trim().to_owned(), filling.trim().to_owned())))?,
            None => None,
        };
        Some(BiasLine { condition, without, why: rest.strip_prefix(':')?.trim().to_owned() })
    }
}

/// "Biased with `visibility = at_shading`: why. Not with `visibility = in_target`."
impl fmt::Display for BiasLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Biased")?;
        match &self.condition {
            Some(condition) if condition.contains('=') => write!(f, " with `{condition}`")?,
            Some(fact) => write!(f, " on scenes with `{fact}`")?,
            None => {}
        }
        write!(f, ": {}.", self.why)?;
        self.without.iter().try_for_each(|(slot, filling)| write!(f, " Not with `{slot} = {filling}`."))
    }
}

/// What stands between `open` and `close` at the beginning of a text, and what follows.
fn enclosed<'a>(text: &'a str, open: &str, close: char) -> Option<(&'a str, &'a str)> {
    let (inner, rest) = text.strip_prefix(open)?.split_once(close)?;
    Some((inner.trim(), rest))
}

/// All comments of one module that mean something to the host.
#[derive(Debug, Default)]
pub struct Comments {
    /// The `//!` lines at the head, less `bias:` and `@tag` ones.
    pub manual: String,
    /// Names of the line `//! @needs …`.
    pub needs: Vec<String>,
    /// What the line `//! @paths …` says.
    pub paths: Option<String>,
    /// `//! bias:` lines.
    pub bias: Vec<BiasLine>,
    docs: HashMap<String, Doc>,
}

impl Comments {
    /// Reads one module's text.
    pub fn read(text: &str) -> Self {
        let mut found = Comments::default();
        let mut pending = Doc::default();
        let mut structure: Option<String> = None;
        for (number, line) in text.lines().map(str::trim).enumerate() {
            if let Some(head) = line.strip_prefix("//!") {
                found.head(head.strip_prefix(' ').unwrap_or(head));
            } else if let Some(doc) = line.strip_prefix("///") {
                pending.line(doc.trim(), number);
            } else if !line.is_empty() && !line.starts_with("//") {
                if let Some(name) = declared(line, structure.is_some()) {
                    let key = structure.as_ref().map_or_else(|| name.to_owned(), |outer| format!("{outer}.{name}"));
                    found.docs.insert(key, Doc { line: number, ..std::mem::take(&mut pending) });
                }
                if !line.starts_with('@') || line.contains(';') || line.contains(',') {
                    pending = Doc::default();
                }
                structure = next_structure(line, structure);
            }
        }
        found
    }

    /// Of a declaration (`radius`) or a member (`Params.exposure`).
    pub fn of(&self, name: &str) -> Doc {
        self.docs.get(name).cloned().unwrap_or_default()
    }

    /// The line, from 0, of a tag of a declaration, or of the declaration itself.
    pub fn line_of(&self, name: &str, tag: Option<&str>) -> Option<usize> {
        let doc = self.docs.get(name)?;
        let tagged = doc.tags.iter().zip(&doc.tag_lines).find(|((name, _), _)| Some(name.as_str()) == tag);
        Some(tagged.map_or(doc.line, |(_, line)| *line))
    }

    fn head(&mut self, line: &str) {
        match BiasLine::read(line) {
            Some(bias) => self.bias.push(bias),
            None if line.trim_start().starts_with('@') => {
                let mut words = line.split_whitespace();
                match words.next() {
                    Some("@needs") => self.needs.extend(words.map(str::to_owned)),
                    Some("@paths") => self.paths = words.next().map(str::to_owned),
                    _ => {}
                }
            }
            None => {
                self.manual.push_str(line);
                self.manual.push('\n');
            }
        }
    }
}

impl Doc {
    fn line(&mut self, line: &str, number: usize) {
        match line.strip_prefix('@') {
            Some(tag) => {
                let (name, value) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
                self.tags.push((name.to_owned(), value.trim().to_owned()));
                self.tag_lines.push(number);
            }
            None if self.text.is_empty() => self.text = line.to_owned(),
            None => self.text = format!("{} {line}", self.text),
        }
    }
}

/// The name that a line declares: `var<storage> name`, `override name`, or `name:` within a struct.
fn declared(line: &str, in_structure: bool) -> Option<&str> {
    let line = without_attributes(line);
    let rest = if in_structure {
        line
    } else if let Some(rest) = line.strip_prefix("override ") {
        rest
    } else if let Some(rest) = line.strip_prefix("var<") {
        rest.split_once('>')?.1
    } else {
        line.strip_prefix("var ")?
    };
    let rest = rest.trim_start();
    let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
    (end > 0 && rest[end..].trim_start().starts_with(':')).then(|| &rest[..end])
}

fn next_structure(line: &str, current: Option<String>) -> Option<String> {
    let line = without_attributes(line);
    if let Some(rest) = line.strip_prefix("struct ") {
        let name = rest.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next().unwrap_or_default();
        return (!line.contains('}')).then(|| name.to_owned());
    }
    if line.contains('}') { None } else { current }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_found_where_they_belong() {
        let text = "//! Tone mapping.\n//!\n//! bias: none of this is linear\n//! bias (metals) [curve = agx]: they are dull\n//! bias [x]: no line\nimport package::base::math::{PI};\n\
            struct Params {\n    /// Stops.\n    /// @default 0\n    /// @range -16 16\n    exposure: f32,\n    plain: u32,\n}\n\
            @group(1) @binding(0) var<uniform> params: Params;\n/// What comes in.\n/// @optional\n\
            @group(1) @binding(1) var<storage, read> color: array<vec4<f32>>;\n/// Taps.\n@id(3) override taps: u32 = 5u;\n";
        let comments = Comments::read(text);
        assert_eq!(comments.manual, "Tone mapping.\n\nbias [x]: no line\n");
        let always = BiasLine { why: "none of this is linear".into(), ..BiasLine::default() };
        let metals =
            BiasLine { condition: Some("metals".into()), without: Some(("curve".into(), "agx".into())), why: "they are dull".into() };
        assert_eq!(comments.bias, [always, metals]);
        assert_eq!(comments.of("Params.exposure").tags, [("default".into(), "0".into()), ("range".into(), "-16 16".into())]);
        assert_eq!(comments.of("Params.plain"), Doc { line: 11, ..Doc::default() });
        let tags = vec![("optional".into(), String::new())];
        assert_eq!(comments.of("color"), Doc { text: "What comes in.".into(), tags, line: 16, tag_lines: vec![15] });
        assert_eq!(comments.of("taps").text, "Taps.");
        assert_eq!(comments.of("params"), Doc { line: 13, ..Doc::default() });
        assert_eq!(comments.line_of("Params.exposure", Some("range")), Some(9));
        assert_eq!([comments.line_of("taps", Some("range")), comments.line_of("nobody", None)], [Some(18), None]);
    }
}
