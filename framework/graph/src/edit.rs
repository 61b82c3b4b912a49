//! One setting as the command line gives it, turned into the tree that a file with the same meaning would give.
//!
//! | text | the same in a file |
//! |---|---|
//! | `transport=full:4` | `transport = "full:4"` |
//! | `slots.mis=pairwise` | `[slots] mis = "pairwise"` |
//! | `temporal.cap=30` | `[pass.temporal] set.cap = 30` |
//! | `spatial.slots.mis=balance` | `[pass.spatial] slots.mis = "balance"` |
//! | `pass.temporal.in.history=false` | `[pass.temporal] in.history = false` |

use crate::{
    Cause, Fault, Literal, Source, Span, Spanned,
    tree::{Table, Tree, parse_value},
};
use indexmap::IndexMap;

/// First words that are not the name of a pass.
const TABLES: [&str; 3] = ["pass", "slots", "budget"];

/// The tree of one edit; `index` is that of its source.
pub(crate) fn parse(index: usize, source: &Source) -> Result<Table, Fault> {
    let text = source.text.as_str();
    let whole = Span::new(index, 0..text.len());
    let bad = |span, label: &str| {
        Fault::at(span, label, Cause::BadEdit { text: text.to_owned() })
            .help("write `pass.parameter=value`, `slots.slot=module` or `transport=…`")
    };
    let equals = text.find('=').ok_or_else(|| bad(whole, "there is no `=`"))?;
    let path = segments(index, &text[..equals]);
    if let Some(empty) = path.iter().find(|segment| segment.value.is_empty()) {
        return Err(bad(empty.span, "a name is missing"));
    }
    if path[0].value == "extends" {
        return Err(bad(path[0].span, "only a file can extend another"));
    }
    let value = value(index, text, equals + 1).ok_or_else(|| bad(Span::new(index, text.len()..text.len()), "the value is missing"))?;
    Ok(nest(expand(path), value))
}

/// The names between the dots, without blanks.
fn segments(index: usize, path: &str) -> Vec<Spanned<String>> {
    let mut start = 0;
    path.split('.')
        .map(|segment| {
            let from = start + segment.len() - segment.trim_start().len();
            start += segment.len() + 1;
            let name = segment.trim();
            Spanned::new(name.to_owned(), Span::new(index, from..from + name.len()))
        })
        .collect()
}

/// A TOML value, or else bare text.
fn value(index: usize, text: &str, from: usize) -> Option<Spanned<Tree>> {
    let words = text[from..].trim();
    if words.is_empty() {
        return None;
    }
    let start = from + text[from..].find(words)?;
    let tree = parse_value(index, words).unwrap_or_else(|| Tree::Leaf(Literal::Text(words.to_owned())));
    Some(Spanned::new(tree, Span::new(index, start..start + words.len())))
}

/// Puts in the `pass` and `set` that a short path leaves out.
fn expand(mut path: Vec<Spanned<String>>) -> Vec<Spanned<String>> {
    if path.len() > 1 && !TABLES.contains(&path[0].value.as_str()) {
        let span = path[0].span;
        if path.len() == 2 {
            path.insert(1, Spanned::new("set".to_owned(), path[1].span));
        }
        path.insert(0, Spanned::new("pass".to_owned(), span));
    }
    path
}

fn nest(path: Vec<Spanned<String>>, value: Spanned<Tree>) -> Table {
    let mut inner = value;
    let mut keys = path.into_iter().rev().peekable();
    while let Some(key) = keys.next() {
        let span = key.span;
        let table: Table = IndexMap::from([(key, inner)]);
        if keys.peek().is_none() {
            return table;
        }
        inner = Spanned::new(Tree::Table(table), span);
    }
    Table::default()
}
