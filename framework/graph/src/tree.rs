//! TOML as a tree in which every key and value knows its place: what files and edits both become before they are read.

use crate::{Cause, Fault, Literal, Span, Spanned};
use indexmap::IndexMap;
use toml::de::{DeTable, DeValue};

/// A table, its keys in the order of the text.
pub(crate) type Table = IndexMap<Spanned<String>, Spanned<Tree>>;

/// A TOML value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Tree {
    Leaf(Literal),
    Table(Table),
    /// Something that no graph file holds; the word for it.
    Other(&'static str),
}

impl Tree {
    /// What it is, as people say it.
    pub(crate) fn type_name(&self) -> &'static str {
        match self {
            Tree::Leaf(literal) => literal.type_name(),
            Tree::Table(_) => "a table",
            Tree::Other(word) => word,
        }
    }
}

/// Reads a whole file; the faults are those of TOML itself.
pub(crate) fn parse(source: usize, text: &str) -> Result<Table, Vec<Fault>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    if errors.is_empty() {
        return Ok(convert_table(source, table.get_ref()));
    }
    Err(errors.iter().map(|error| syntax_fault(source, text, error)).collect())
}

/// Reads one value, e.g. `20`; `None` when the text is none.
pub(crate) fn parse_value(source: usize, text: &str) -> Option<Tree> {
    DeValue::parse(text).ok().map(|value| convert(source, value.get_ref()))
}

fn syntax_fault(source: usize, text: &str, error: &toml::de::Error) -> Fault {
    let mut range = error.span().unwrap_or(text.len()..text.len());
    range.end = range.end.min(text.len());
    range.start = range.start.min(range.end);
    Fault::at(Span::new(source, range), "", Cause::Syntax { message: error.message().lines().collect::<Vec<_>>().join(", ") })
}

fn convert_table(source: usize, table: &DeTable<'_>) -> Table {
    let entry = |(key, value): (&toml::Spanned<_>, &toml::Spanned<_>)| {
        let name: &std::borrow::Cow<'_, str> = key.get_ref();
        let key = Spanned::new(name.to_string(), Span::new(source, key.span()));
        (key, Spanned::new(convert(source, value.get_ref()), Span::new(source, value.span())))
    };
    table.iter().map(entry).collect()
}

fn convert(source: usize, value: &DeValue<'_>) -> Tree {
    match value {
        DeValue::String(text) => Tree::Leaf(Literal::Text(text.to_string())),
        DeValue::Boolean(value) => Tree::Leaf(Literal::Bool(*value)),
        DeValue::Integer(digits) => match i64::from_str_radix(digits.as_str(), digits.radix()) {
            Ok(value) => Tree::Leaf(Literal::Integer(value)),
            Err(_) => Tree::Other("a number beyond 64 bits"),
        },
        DeValue::Float(digits) => {
            digits.as_str().parse().map_or(Tree::Other("a number beyond all bounds"), |value| Tree::Leaf(Literal::Float(value)))
        }
        DeValue::Datetime(_) => Tree::Other("a date"),
        DeValue::Array(_) => Tree::Other("a list"),
        DeValue::Table(table) => Tree::Table(convert_table(source, table)),
    }
}
