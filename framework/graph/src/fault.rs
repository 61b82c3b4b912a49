//! What is wrong with a graph file, all of it at once.

use crate::{Cause, Sources, Span};

/// Everything that is wrong; `Display` prints it with excerpts and carets, and tools can lay the data out themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults {
    /// The texts that labels point into.
    pub sources: Sources,
    /// In order of place.
    pub list: Vec<Fault>,
}

impl std::error::Error for Faults {}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// What. Its `Display` is the message, [`Cause::code`] a stable name for machines.
    pub cause: Box<Cause>,
    /// Where: the first label is the place itself, the others show what it clashes with. Empty when no text was read.
    pub labels: Vec<Label>,
    /// How to cure it.
    pub help: Option<String>,
}

/// A remark on a stretch of text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The stretch.
    pub span: Span,
    /// The remark; may be empty.
    pub text: String,
}

impl Fault {
    /// A fault at a place, with a remark to put beside the carets.
    pub(crate) fn at(span: Span, label: impl Into<String>, cause: Cause) -> Self {
        Fault { cause: Box::new(cause), labels: vec![Label { span, text: label.into() }], help: None }
    }

    /// A fault that no text shows.
    pub(crate) fn placeless(cause: Cause) -> Self {
        Fault { cause: Box::new(cause), labels: Vec::new(), help: None }
    }

    pub(crate) fn and(mut self, span: Span, label: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: label.into() });
        self
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl Faults {
    /// `Err` when something is wrong. Faults are put in the order of their places.
    pub(crate) fn unless_empty(sources: &Sources, mut list: Vec<Fault>) -> Result<(), Faults> {
        if list.is_empty() {
            return Ok(());
        }
        list.sort_by_key(|fault| fault.labels.first().map(|label| label.span));
        Err(Faults { sources: sources.clone(), list })
    }
}
