//! Faults of graph files as people like to read them: excerpts, underlined.

use aquifer_graph::{Fault, Faults, Sources};
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};
use std::fmt;

/// All faults, one after the other, then how many there are.
pub fn render(faults: &Faults, color: bool) -> String {
    let theme = if color { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let handler = GraphicalReportHandler::new_themed(theme).with_links(false);
    let mut text = String::new();
    for fault in &faults.list {
        if !text.is_empty() {
            text.push('\n');
        }
        let parts = Excerpts::of(fault, &faults.sources);
        if handler.render_report(&mut text, &parts).is_err() {
            // The handler only fails when it cannot write or a span lies outside of its text; the graph's own rendering has no such limits.
            return faults.to_string();
        }
    }
    match faults.list.len() {
        1 => text + "1 fault\n",
        count => text + &format!("{count} faults\n"),
    }
}

/// A fault whose labels are all in one text; labels in other texts hang below it.
#[derive(Debug)]
struct Excerpts {
    message: String,
    code: Option<&'static str>,
    help: Option<String>,
    source: Option<NamedSource<String>>,
    labels: Vec<LabeledSpan>,
    elsewhere: Vec<Excerpts>,
}

impl Excerpts {
    fn of(fault: &Fault, sources: &Sources) -> Self {
        let mut texts: Vec<usize> = Vec::new();
        for label in &fault.labels {
            if !texts.contains(&label.span.source) {
                texts.push(label.span.source);
            }
        }
        let mut parts = texts.into_iter().map(|text| Self::within(text, fault, sources));
        let empty = Self { message: String::new(), code: None, help: None, source: None, labels: Vec::new(), elsewhere: Vec::new() };
        let first = parts.next().unwrap_or(empty);
        Self {
            message: fault.cause.to_string(),
            code: Some(fault.cause.code()),
            help: fault.help.clone(),
            elsewhere: parts.collect(),
            ..first
        }
    }

    fn within(text: usize, fault: &Fault, sources: &Sources) -> Self {
        let source = sources.get(text);
        let labels = fault.labels.iter().filter(|label| label.span.source == text).map(|label| {
            let words = (!label.text.is_empty()).then(|| label.text.clone());
            LabeledSpan::new_with_span(words, label.span.range())
        });
        Self {
            message: format!("see also {}", source.name),
            code: None,
            help: None,
            source: Some(NamedSource::new(&source.name, source.text.clone())),
            labels: labels.collect(),
            elsewhere: Vec::new(),
        }
    }
}

impl fmt::Display for Excerpts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Excerpts {}

impl Diagnostic for Excerpts {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.code.map(|code| Box::new(code) as Box<dyn fmt::Display>)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|source| source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        if self.elsewhere.is_empty() {
            return None;
        }
        Some(Box::new(self.elsewhere.iter().map(|part| part as &dyn Diagnostic)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use aquifer_graph::{Cause, Label, Source, Span};

    #[test]
    fn every_text_and_label_is_shown() {
        let mut sources = Sources::default();
        let child = sources.add(Source::new("child.toml", "[pass.shade]\nin.color = \"nowhere.color\"\n"));
        let parent = sources.add(Source::new("parent.toml", "output = \"shade.image\"\n"));
        let fault = Fault {
            cause: Box::new(Cause::UnknownPass { pass: "nowhere".into() }),
            labels: vec![
                Label { span: Span::new(child, 24..39), text: "named here".into() },
                Label { span: Span::new(parent, 9..22), text: "wanted here".into() },
            ],
            help: Some("remove it".into()),
        };
        let placeless = Fault { cause: Box::new(Cause::MissingKey { key: "output" }), labels: Vec::new(), help: None };
        let text = render(&Faults { sources, list: vec![fault, placeless] }, false);
        let needed = [
            "unknown-pass",
            "there is no pass `nowhere`",
            "child.toml:2:12",
            "named here",
            "parent.toml:1:10",
            "wanted here",
            "remove it",
            "missing-key",
            "2 faults",
        ];
        for needed in needed {
            assert!(text.contains(needed), "{needed} is not in\n{text}");
        }
        assert!(!text.contains('\u{1b}'), "colour was not asked for");
    }
}
