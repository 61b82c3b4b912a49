//! Texts, and places in them.

use std::{borrow::Borrow, fmt, hash::Hash, ops::Range, sync::Arc};

/// One text that a graph is read from: a file, a built-in graph, an argument of the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// As shown to people, and as `extends` is resolved against: a path, or e.g. `--set`.
    pub name: String,
    /// All of it.
    pub text: String,
}

impl Source {
    /// A text under a name.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Source { name: name.into(), text: text.into() }
    }
}

/// Every text of one graph; a [`Span`] is an index into them and a byte range.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources(Vec<Arc<Source>>);

impl Sources {
    /// Takes one more in; the answer is its index.
    pub fn add(&mut self, source: Source) -> usize {
        self.0.push(Arc::new(source));
        self.0.len() - 1
    }

    /// The text with this index.
    ///
    /// # Panics
    /// When the index came from other `Sources`.
    pub fn get(&self, index: usize) -> &Source {
        &self.0[index]
    }

    /// All of them, in the order of their indices.
    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.0.iter().map(Arc::as_ref)
    }

    /// The words under a span.
    pub fn excerpt(&self, span: Span) -> &str {
        let text = &self.get(span.source).text;
        text.get(span.start..span.end).unwrap_or_default()
    }

    /// File, line and column of a span's start.
    pub fn place(&self, span: Span) -> Place {
        let source = self.get(span.source);
        let before = source.text.get(..span.start).unwrap_or(&source.text);
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Place {
            source: source.name.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].trim_start_matches('\u{feff}').chars().count() + 1,
        }
    }
}

/// A stretch of one text, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// Index into [`Sources`].
    pub source: usize,
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// A byte range of a text.
    pub fn new(source: usize, range: Range<usize>) -> Self {
        Span { source, start: range.start, end: range.end }
    }

    /// From the start of this to the end of a later one of the same text; this alone when the other is elsewhere.
    pub(crate) fn to(self, end: Span) -> Span {
        if end.source == self.source && end.end > self.start { Span { end: end.end, ..self } } else { self }
    }

    /// The byte range.
    pub fn range(self) -> Range<usize> {
        self.start..self.end
    }
}

/// Where something stands, as people say it. Lines and columns count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Place {
    /// Name of the text.
    pub source: String,
    /// Line.
    pub line: usize,
    /// Column.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.source, self.line, self.column)
    }
}

/// A value that knows where it was written. Two are equal when their values are.
#[derive(Clone, Copy, Debug)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// A value with its place.
    pub fn new(value: T, span: Span) -> Self {
        Spanned { value, span }
    }
}

impl<T: PartialEq> PartialEq for Spanned<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T: Eq> Eq for Spanned<T> {}

impl<T: Hash> Hash for Spanned<T> {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.value.hash(state);
    }
}

// Agrees with `Hash` and `Eq` above, so that maps with spanned keys are asked by plain text.
impl Borrow<str> for Spanned<String> {
    fn borrow(&self) -> &str {
        &self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_lines_and_characters() {
        let mut sources = Sources::default();
        let text = "\u{feff}a\nß = ü\n";
        let index = sources.add(Source::new("x.toml", text));
        let place = |needle: &str| {
            let start = text.find(needle).unwrap();
            sources.place(Span::new(index, start..start + needle.len())).to_string()
        };
        assert_eq!(place("a"), "x.toml:1:1");
        assert_eq!(place("ß"), "x.toml:2:1");
        assert_eq!(place("ü"), "x.toml:2:5");
        assert_eq!(sources.place(Span::new(index, text.len()..text.len())).to_string(), "x.toml:3:1");
    }
}
