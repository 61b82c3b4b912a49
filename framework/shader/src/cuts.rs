//! What a false `@if` takes out of a module.

use std::collections::BTreeSet;

/// A piece of a module that this shader does without, because its `@if` does not hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cut {
    /// Module path.
    pub module: String,
    /// Line of the `@if`, from 1.
    pub line: usize,
    /// Between the parentheses of `@if`.
    pub condition: String,
    /// What stood there.
    pub piece: Piece,
}

/// What an `@if` stands before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Piece {
    /// Names of another module.
    Import,
    /// A bound variable.
    Binding {
        /// Its group.
        group: u32,
        /// Its name.
        name: String,
    },
    /// A function, by name.
    Function(String),
    /// Statements.
    Branch,
}

impl Cut {
    /// The facts that the condition asks for.
    pub fn facts(&self) -> impl Iterator<Item = &str> {
        names(&self.condition)
    }
}

/// Every false `@if` of a text.
pub fn of<'a>(module: &'a str, text: &'a str, features: &'a BTreeSet<String>) -> impl Iterator<Item = Cut> + 'a {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
    lines.filter_map(move |(index, line)| {
        let (condition, rest) = split(line)?;
        let piece = || Cut { module: module.to_owned(), line: index + 1, condition: condition.to_owned(), piece: piece(rest) };
        (!holds(condition, features)).then(piece)
    })
}

/// The condition of a line's `@if`, and what comes after it.
fn split(line: &str) -> Option<(&str, &str)> {
    let (_, from) = line.split_once("@if(")?;
    let condition = balanced(from)?;
    Some((condition, from[condition.len() + 1..].trim_start()))
}

/// Every condition of a text without comments, with its place.
pub fn conditions(code: &str) -> impl Iterator<Item = (usize, &str)> {
    const OPENINGS: [&str; 2] = ["@if(", "@elif("];
    let openings = OPENINGS.iter().flat_map(|opening| code.match_indices(opening).map(|(at, opening)| at + opening.len()));
    openings.filter_map(|at| Some((at, balanced(&code[at..])?)))
}

/// What stands before the `)` that closes a parenthesis.
fn balanced(text: &str) -> Option<&str> {
    let mut depth = 1;
    let end = text.find(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth == 0
    })?;
    Some(&text[..end])
}

fn piece(rest: &str) -> Piece {
    let name = |text: &str| text.trim_start().split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next().unwrap_or_default().to_owned();
    if rest.starts_with("import ") {
        return Piece::Import;
    }
    if let Some(function) = rest.strip_prefix("fn ") {
        return Piece::Function(name(function));
    }
    let group = rest.strip_prefix("@group(").and_then(|rest| rest.split_once(')')?.0.trim().parse().ok());
    match (group, rest.split_once(':')) {
        (Some(group), Some((declaration, _))) => {
            Piece::Binding { group, name: declaration.rsplit([' ', '>']).next().unwrap_or_default().to_owned() }
        }
        _ => Piece::Branch,
    }
}

fn names(condition: &str) -> impl Iterator<Item = &str> {
    condition.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|name| !name.is_empty())
}

/// `a`, `!a`, `a && b`, `a || b`; `&&` binds closer, as WESL has it, and parentheses are not needed by any module.
fn holds(condition: &str, features: &BTreeSet<String>) -> bool {
    let term = |term: &str| match term.trim().strip_prefix('!') {
        Some(name) => !features.contains(name.trim()),
        None => features.contains(term.trim()),
    };
    condition.split("||").any(|all| all.split("&&").all(term))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn false_conditions_are_found_with_what_they_take_out() {
        let text = "@if(a) import package::x::{y};\n// @if(b) in a comment\n@if(b) fn f() {}\nfn main() {\n    @if(c || b) { g(); }\n}\n\
                    @if(b && a) @group(1) @binding(0) var<storage, read> motion: array<f32>;\n@if(!a) @group(0) @binding(1) var t: texture_2d<u32>;\n";
        let cuts = |features: &[&str]| -> Vec<(usize, Piece)> {
            let features = features.iter().map(|&name| name.to_owned()).collect();
            of("m", text, &features).map(|cut| (cut.line, cut.piece)).collect()
        };
        let binding = |group, name: &str| Piece::Binding { group, name: name.to_owned() };
        assert_eq!(cuts(&["a", "b"]), [(8, binding(0, "t"))]);
        assert_eq!(cuts(&["a"]), [(3, Piece::Function("f".into())), (5, Piece::Branch), (7, binding(1, "motion")), (8, binding(0, "t"))]);
        assert_eq!(cuts(&["c"]), [(1, Piece::Import), (3, Piece::Function("f".into())), (7, binding(1, "motion"))]);
    }

    #[test]
    fn a_cut_names_the_facts() {
        let cut = of("m", "@if(x && !y) fn f() {}", &BTreeSet::new()).next().unwrap();
        assert_eq!(cut.facts().collect::<Vec<_>>(), ["x", "y"]);
    }
}
