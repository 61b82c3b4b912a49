//! A document as one graph file: what it extends and every edit written in.

use crate::{Document, Entry, Keys, Literal, Spanned};
use std::fmt::{Display, Write};

impl Document {
    /// The text of a file that needs no other and gives the same graph. Comments are not kept.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        let first = self.sources.iter().next().map(|first| first.name.as_str());
        let title = self.title.as_ref().map(|title| title.value.as_str()).or(first);
        let others = [("about", &self.about), ("transport", &self.transport), ("output", &self.output)];
        let others = others.into_iter().filter_map(|(key, value)| Some((key, value.as_ref()?.value.as_str())));
        for (key, value) in title.map(|title| ("title", title)).into_iter().chain(others) {
            line(&mut text, key, quoted(value));
        }
        if self.slots.values().any(|filling| filling.value.is_some()) {
            text.push_str("\n[slots]\n");
            texts(&mut text, "", &self.slots);
        }
        if let Some(Spanned { value: Some(knob), .. }) = &self.knob {
            text.push_str("\n[budget]\n");
            line(&mut text, "knob", quoted(knob));
        }
        for (name, entry) in &self.pass {
            let _ = write!(text, "\n[pass.{}]\n", key(&name.value));
            write_entry(&mut text, entry);
        }
        text
    }
}

fn write_entry(text: &mut String, entry: &Entry) {
    if let Some(kind) = &entry.kind {
        line(text, "kind", quoted(&kind.value));
    }
    texts(text, "in.", &entry.inputs);
    for (name, value) in &entry.set {
        line(text, &format!("set.{}", key(&name.value)), &value.value);
    }
    texts(text, "slots.", &entry.slots);
    if let Some(rounds) = entry.repeat {
        line(text, "repeat", rounds.value);
    }
    texts(text, "feed.", &entry.feed);
}

/// Lines of a table, but for those that take something away: there is nothing under them any more.
fn texts(text: &mut String, prefix: &str, keys: &Keys<Spanned<Option<String>>>) {
    for (name, value) in keys {
        if let Some(value) = &value.value {
            line(text, &format!("{prefix}{}", key(&name.value)), quoted(value));
        }
    }
}

fn line(text: &mut String, key: &str, value: impl Display) {
    let _ = writeln!(text, "{key} = {value}");
}

fn key(name: &str) -> String {
    let is_bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_bare { name.to_owned() } else { quoted(name) }
}

fn quoted(text: &str) -> String {
    Literal::Text(text.to_owned()).to_string()
}
