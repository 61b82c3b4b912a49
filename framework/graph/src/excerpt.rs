//! Faults as plain text: message, place, the line with carets under the words, cure.

use crate::{Fault, Faults, Label, Sources};
use std::fmt;

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for fault in &self.list {
            write_fault(f, &self.sources, fault)?;
            writeln!(f)?;
        }
        match self.list.len() {
            1 => write!(f, "1 fault"),
            count => write!(f, "{count} faults"),
        }
    }
}

fn write_fault(f: &mut fmt::Formatter<'_>, sources: &Sources, fault: &Fault) -> fmt::Result {
    writeln!(f, "error[{}]: {}", fault.cause.code(), printable(&fault.cause.to_string()))?;
    let views: Vec<View> = fault.labels.iter().map(|label| View::of(sources, label)).collect();
    let margin = views.iter().map(|view| view.line.to_string().len()).max().unwrap_or(1);
    for (i, view) in views.iter().enumerate() {
        let head = if i == 0 { "-->" } else { ":::" };
        writeln!(f, "{:margin$}{head} {}:{}:{}", "", printable(view.name), view.line, view.column)?;
        writeln!(f, "{:margin$} |", "")?;
        writeln!(f, "{:>margin$} | {}", view.line, view.text)?;
        writeln!(f, "{:margin$} | {}{}", "", view.carets, if view.label.is_empty() { String::new() } else { format!(" {}", view.label) })?;
    }
    if let Some(help) = &fault.help {
        writeln!(f, "{:margin$} = help: {}", "", printable(help))?;
    }
    Ok(())
}

/// One label, laid out.
struct View<'a> {
    name: &'a str,
    line: usize,
    column: usize,
    text: String,
    carets: String,
    label: String,
}

impl<'a> View<'a> {
    fn of(sources: &'a Sources, label: &Label) -> Self {
        let source = sources.get(label.span.source);
        let place = sources.place(label.span);
        let line = source.text.split('\n').nth(place.line - 1).unwrap_or_default().trim_start_matches('\u{feff}').trim_end_matches('\r');
        let words = sources.excerpt(label.span);
        let first_line = words.split(['\r', '\n']).next().unwrap_or_default();
        let (text, skipped, shown) = window(line, place.column - 1, first_line.chars().count());
        let carets = format!("{}{}", " ".repeat(skipped), "^".repeat(shown.max(1)));
        View { name: &source.name, line: place.line, column: place.column, text, carets, label: printable(&label.text) }
    }
}

/// At most [`WIDTH`] characters of a line around the stretch `start .. start + len`: the text, how many characters stand before the
/// stretch, and how many of it are left.
fn window(line: &str, start: usize, len: usize) -> (String, usize, usize) {
    const WIDTH: usize = 110;
    let characters: Vec<char> = line.chars().map(visible).collect();
    // What is wrong may be the end of the line, which the line here is without.
    let start = start.min(characters.len());
    if characters.len() <= WIDTH {
        return (characters.iter().collect(), start, len);
    }
    let from = if start + len <= WIDTH { 0 } else { start.saturating_sub(WIDTH / 4) };
    let to = (from + WIDTH).min(characters.len());
    let (before, after) = (if from > 0 { "…" } else { "" }, if to < characters.len() { "…" } else { "" });
    let text: String = characters[from..to].iter().collect();
    let skipped = start - from + before.chars().count();
    (format!("{before}{text}{after}"), skipped, len.min(to.saturating_sub(start)))
}

/// Text without control characters, which could steer a terminal.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c == '\n' { c } else { visible(c) }).collect()
}

fn visible(c: char) -> char {
    match c {
        '\t' => ' ',
        c if c.is_control() => '\u{fffd}',
        c => c,
    }
}
