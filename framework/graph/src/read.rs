//! From a TOML tree to a [`Document`]: every key is known, every value has the right type.

use crate::{
    Cause, Document, Entry, Fault, Keys, Literal, MAX_ROUNDS, Span, Spanned, nearest,
    nearest::cure,
    tree::{Table, Tree},
};

const GRAPH_KEYS: [&str; 8] = ["extends", "title", "about", "transport", "output", "slots", "budget", "pass"];
const PASS_KEYS: [&str; 8] = ["kind", "in", "set", "slots", "repeat", "feed", "remove", "replace"];

/// What one text says, without its sources, and what is wrong with it.
pub(crate) fn read(table: Table) -> (Document, Vec<Fault>) {
    let mut reader = Reader::default();
    let document = reader.document(table);
    (document, reader.faults)
}

#[derive(Default)]
struct Reader {
    faults: Vec<Fault>,
}

impl Reader {
    fn document(&mut self, table: Table) -> Document {
        let mut document = Document::default();
        for (key, value) in table {
            match key.value.as_str() {
                "extends" => document.extends = self.text("`extends`", value),
                "title" => document.title = self.text("`title`", value),
                "about" => document.about = self.text("`about`", value),
                "transport" => document.transport = self.text("`transport`", value),
                "output" => document.output = self.text("`output`", value),
                "slots" => document.slots = self.slots(value),
                "budget" => document.knob = self.budget(value),
                "pass" => document.pass = self.passes(value),
                _ => self.unknown_key(&key, "a graph file", &GRAPH_KEYS),
            }
        }
        document
    }

    fn slots(&mut self, value: Spanned<Tree>) -> Keys<Spanned<Option<String>>> {
        self.keys("`slots`", value, |reader, key, value| reader.text_or_false(&format!("the filling of slot `{key}`"), value))
    }

    fn budget(&mut self, value: Spanned<Tree>) -> Option<Spanned<Option<String>>> {
        let mut knob = None;
        for (key, value) in self.table("`budget`", value) {
            match key.value.as_str() {
                "knob" => knob = self.text_or_false("`knob`", value),
                _ => self.unknown_key(&key, "`[budget]`", &["knob"]),
            }
        }
        knob
    }

    fn passes(&mut self, value: Spanned<Tree>) -> Keys<Entry> {
        let mut passes = Keys::default();
        for (name, value) in self.table("`pass`", value) {
            if !is_name(&name.value) {
                self.bad_name(&name);
            }
            let entry = self.entry(&name, value);
            passes.insert(name, entry);
        }
        passes
    }

    fn entry(&mut self, name: &Spanned<String>, value: Spanned<Tree>) -> Entry {
        let mut entry = Entry::default();
        let place = format!("pass `{}`", name.value);
        let mut said = 0;
        for (key, value) in self.table(&place, value) {
            said += 1;
            match key.value.as_str() {
                "kind" => entry.kind = self.text("`kind`", value),
                "in" => {
                    entry.inputs =
                        self.keys("`in`", value, |reader, key, value| reader.text_or_false(&format!("the wire of input `{key}`"), value))
                }
                "set" => entry.set = self.keys("`set`", value, |reader, key, value| reader.literal(&format!("parameter `{key}`"), value)),
                "slots" => entry.slots = self.slots(value),
                "repeat" => entry.repeat = self.rounds(value),
                "feed" => {
                    entry.feed =
                        self.keys("`feed`", value, |reader, key, value| reader.text_or_false(&format!("the feed of input `{key}`"), value))
                }
                "remove" => entry.remove = self.truth("`remove`", value),
                "replace" => entry.replace = self.truth("`replace`", value),
                _ => self.unknown_pass_key(&key, &value.value, &place),
            }
        }
        if let Some(remove) = entry.remove.filter(|remove| remove.value && said > 1) {
            let fault = Fault::at(remove.span, "removed", Cause::RemovedAndSet { pass: name.value.clone() });
            self.faults.push(fault.help("to describe it anew, write `replace = true` instead"));
        }
        entry
    }

    fn rounds(&mut self, value: Spanned<Tree>) -> Option<Spanned<u32>> {
        let span = value.span;
        let Tree::Leaf(Literal::Integer(count)) = value.value else {
            return self.wrong_type("`repeat`", "a whole number", &value.value, span);
        };
        match u32::try_from(count).ok().filter(|count| (1..=MAX_ROUNDS).contains(count)) {
            Some(count) => Some(Spanned::new(count, span)),
            None => {
                let (least, most) = ("1".to_owned(), MAX_ROUNDS.to_string());
                let cause = Cause::OutOfRange { what: "`repeat`".to_owned(), least, most, found: count.to_string() };
                self.faults.push(Fault::at(span, "", cause));
                None
            }
        }
    }

    fn text(&mut self, what: &str, value: Spanned<Tree>) -> Option<Spanned<String>> {
        match value.value {
            Tree::Leaf(Literal::Text(text)) => Some(Spanned::new(text, value.span)),
            other => self.wrong_type(what, "a quoted text", &other, value.span),
        }
    }

    fn text_or_false(&mut self, what: &str, value: Spanned<Tree>) -> Option<Spanned<Option<String>>> {
        match value.value {
            Tree::Leaf(Literal::Text(text)) => Some(Spanned::new(Some(text), value.span)),
            Tree::Leaf(Literal::Bool(false)) => Some(Spanned::new(None, value.span)),
            other => self.wrong_type(what, "a quoted text, or false for nothing", &other, value.span),
        }
    }

    fn truth(&mut self, what: &str, value: Spanned<Tree>) -> Option<Spanned<bool>> {
        match value.value {
            Tree::Leaf(Literal::Bool(truth)) => Some(Spanned::new(truth, value.span)),
            other => self.wrong_type(what, "true or false", &other, value.span),
        }
    }

    fn literal(&mut self, what: &str, value: Spanned<Tree>) -> Option<Spanned<Literal>> {
        match value.value {
            Tree::Leaf(literal) => Some(Spanned::new(literal, value.span)),
            other => self.wrong_type(what, "a number, a truth value or a quoted name", &other, value.span),
        }
    }

    fn table(&mut self, what: &str, value: Spanned<Tree>) -> Table {
        match value.value {
            Tree::Table(table) => table,
            other => self.wrong_type(what, "a table", &other, value.span).unwrap_or_default(),
        }
    }

    fn keys<T>(&mut self, what: &str, value: Spanned<Tree>, mut read: impl FnMut(&mut Self, &str, Spanned<Tree>) -> Option<T>) -> Keys<T> {
        let table = self.table(what, value);
        table.into_iter().filter_map(|(key, value)| read(self, &key.value, value).map(|value| (key, value))).collect()
    }

    fn wrong_type<T>(&mut self, what: &str, expected: &str, found: &Tree, span: Span) -> Option<T> {
        let cause = Cause::WrongType { what: what.to_owned(), expected: expected.to_owned(), found: found.type_name().to_owned() };
        self.faults.push(Fault::at(span, "", cause));
        None
    }

    fn unknown_key(&mut self, key: &Spanned<String>, place: &str, known: &[&str]) {
        let cause = Cause::UnknownKey { key: key.value.clone(), place: place.to_owned() };
        let help = cure(&key.value, &format!("keys of {place}"), known.iter().copied());
        self.faults.push(Fault::at(key.span, "", cause).help(help));
    }

    /// Parameters and wires written without their `set.` or `in.` are the usual slip.
    fn unknown_pass_key(&mut self, key: &Spanned<String>, value: &Tree, place: &str) {
        let cause = Cause::UnknownKey { key: key.value.clone(), place: place.to_owned() };
        let help = match (nearest(&key.value, PASS_KEYS), value) {
            (None, Tree::Leaf(Literal::Text(_))) => {
                format!("a wire is written `in.{0} = \"pass.port\"`, a parameter `set.{0} = …`", key.value)
            }
            (None, Tree::Leaf(_)) => format!("a parameter is written `set.{} = …`", key.value),
            _ => cure(&key.value, "keys of a pass", PASS_KEYS),
        };
        self.faults.push(Fault::at(key.span, "", cause).help(help));
    }

    fn bad_name(&mut self, name: &Spanned<String>) {
        let fault = Fault::at(name.span, "", Cause::BadName { name: name.value.clone() });
        self.faults.push(fault.help("letters, digits, `_` and `-`, beginning with a letter or `_`"));
    }
}

/// Can stand before the dot of a wire.
fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}
