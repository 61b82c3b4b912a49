//! The grammar of a wire: `pass.port`, or `pass.port@prev` for last frame's.

use crate::When;

/// The text of a wire, taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WireText<'a> {
    pub pass: &'a str,
    pub port: &'a str,
    pub when: When,
}

/// What a wire should have looked like.
pub(crate) const GRAMMAR: &str = "a wire is written `pass.port`, or `pass.port@prev` for last frame's";

impl<'a> WireText<'a> {
    /// `None` when the text does not follow the grammar.
    pub(crate) fn parse(text: &'a str) -> Option<Self> {
        let (name, when) = match text.split_once('@') {
            None => (text, When::This),
            Some((name, "prev")) => (name, When::Previous),
            Some(_) => return None,
        };
        let (pass, port) = name.split_once('.')?;
        let is_word = |word: &str| !word.is_empty() && !word.contains(|c: char| c == '.' || c.is_whitespace());
        (is_word(pass) && is_word(port)).then_some(WireText { pass, port, when })
    }
}
