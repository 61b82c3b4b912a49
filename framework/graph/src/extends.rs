//! Files that build on files: loading the chain, and laying one document over another.

use crate::{Cause, Document, Entry, Fault, Faults, Files, Keys, Source, Sources, Span, Spanned, edit, nearest::cure, read, tree};
use indexmap::map::MutableKeys;

/// The most files that `extends` strings together.
pub const MAX_FILES: usize = 32;

impl Document {
    /// Reads a graph file and everything that it extends. Faults of all the files come at once.
    pub fn parse(source: Source, files: &dyn Files) -> Result<Document, Faults> {
        let mut chain = Chain::default();
        chain.read(source, files);
        let mut sources = chain.sources;
        let mut faults = chain.faults;
        // A file that could not be read would make every pass of it look unknown.
        let complete = faults.is_empty();
        let mut document = Document::default();
        for layer in chain.layers.into_iter().rev() {
            document = lay(document, layer, if complete { Some(&mut faults) } else { None });
        }
        Faults::unless_empty(&sources, faults)?;
        document.sources = std::mem::take(&mut sources);
        Ok(document)
    }

    /// Finds the file and [parses](Document::parse) it.
    pub fn load(path: &str, files: &dyn Files) -> Result<Document, Faults> {
        let unreadable = |error| Faults { sources: Sources::default(), list: vec![read_fault(error, None)] };
        Document::parse(files.read(path, None).map_err(unreadable)?, files)
    }

    /// Lays settings over the graph, one a source: `temporal.cap=20`, `slots.mis=pairwise`, `spatial.slots.mis=balance`,
    /// `transport=full:4`, `pass.temporal.in.history=false`. Later ones win. A source's name is what faults call it, e.g. `--set`.
    pub fn apply(&mut self, edits: impl IntoIterator<Item = Source>) -> Result<(), Faults> {
        let mut document = self.clone();
        let faults = document.lay_edits(edits);
        Faults::unless_empty(&document.sources, faults)?;
        *self = document;
        Ok(())
    }

    /// As [`Document::apply`], but those with faults are left out.
    pub(crate) fn lay_edits(&mut self, edits: impl IntoIterator<Item = Source>) -> Vec<Fault> {
        let mut faults = Vec::new();
        for edit in edits {
            let index = self.sources.add(edit);
            match self.layer(index) {
                Ok(layer) => *self = lay(std::mem::take(self), layer, None),
                Err(wrong) => faults.extend(wrong),
            }
        }
        faults
    }

    /// The setting of that source, when nothing is wrong with it.
    fn layer(&self, index: usize) -> Result<Document, Vec<Fault>> {
        let table = edit::parse(index, self.sources.get(index)).map_err(|fault| vec![fault])?;
        let (layer, mut faults) = read::read(table);
        faults.extend(layer.pass.keys().filter_map(|pass| self.unknown_pass(pass)));
        if faults.is_empty() { Ok(layer) } else { Err(faults) }
    }

    /// A fault, unless the graph has this pass.
    fn unknown_pass(&self, pass: &Spanned<String>) -> Option<Fault> {
        if self.pass.contains_key(pass) {
            return None;
        }
        let fault = Fault::at(pass.span, "", Cause::UnknownPass { pass: pass.value.clone() });
        Some(fault.help(cure(&pass.value, "passes", self.pass.keys().map(|key| key.value.as_str()))))
    }
}

/// The files read so far, the extending ones first.
#[derive(Default)]
struct Chain {
    sources: Sources,
    layers: Vec<Document>,
    faults: Vec<Fault>,
}

impl Chain {
    fn read(&mut self, first: Source, files: &dyn Files) {
        let mut next = Some(first);
        while let Some(source) = next.take() {
            let name = source.name.clone();
            let index = self.sources.add(source);
            let table = match tree::parse(index, &self.sources.get(index).text) {
                Ok(table) => table,
                Err(faults) => return self.faults.extend(faults),
            };
            let (layer, faults) = read::read(table);
            self.faults.extend(faults);
            next = layer.extends.as_ref().and_then(|path| self.follow(path, &name, files));
            self.layers.push(layer);
        }
    }

    /// The file that is extended, unless it was read before.
    fn follow(&mut self, path: &Spanned<String>, from: &str, files: &dyn Files) -> Option<Source> {
        if self.layers.len() + 1 >= MAX_FILES {
            self.faults.push(Fault::at(path.span, "", Cause::ExtendsTooDeep { most: MAX_FILES }));
            return None;
        }
        match files.read(&path.value, Some(from)) {
            Err(error) => {
                self.faults.push(read_fault(error, Some(path.span)));
                None
            }
            Ok(source) => match self.sources.iter().position(|known| known.name == source.name) {
                None => Some(source),
                Some(start) => {
                    let mut chain: Vec<String> = self.sources.iter().skip(start).map(|known| known.name.clone()).collect();
                    chain.push(source.name);
                    self.faults.push(Fault::at(path.span, "", Cause::ExtendsLoop { chain }));
                    None
                }
            },
        }
    }
}

fn read_fault(error: crate::ReadError, span: Option<Span>) -> Fault {
    let help = match &error {
        crate::ReadError::NotFound { near: Some(near), .. } => Some(format!("did you mean `{near}`?")),
        _ => None,
    };
    let cause = Cause::Read(error);
    let fault = span.map_or_else(|| Fault::placeless(cause.clone()), |span| Fault::at(span, "", cause.clone()));
    Fault { help, ..fault }
}

/// `upper` over `lower`, key by key. Faults, where wanted, are passes to be removed or replaced that are not there.
fn lay(lower: Document, upper: Document, mut faults: Option<&mut Vec<Fault>>) -> Document {
    let mut document = Document {
        sources: lower.sources,
        extends: upper.extends,
        title: upper.title.or(lower.title),
        about: upper.about.or(lower.about),
        transport: upper.transport.or(lower.transport),
        output: upper.output.or(lower.output),
        slots: lay_keys(lower.slots, upper.slots),
        knob: upper.knob.or(lower.knob),
        pass: lower.pass,
        removed: lower.removed,
    };
    for (name, entry) in upper.pass {
        let drops = [entry.remove, entry.replace].into_iter().flatten().any(|word| word.value);
        if drops && let (Some(faults), Some(fault)) = (faults.as_deref_mut(), document.unknown_pass(&name)) {
            faults.push(fault);
        }
        lay_pass(&mut document, name, entry);
    }
    document
}

fn lay_pass(document: &mut Document, name: Spanned<String>, entry: Entry) {
    let is = |word: Option<Spanned<bool>>| word.is_some_and(|word| word.value);
    if is(entry.remove) {
        document.pass.shift_remove(&name);
        document.removed.insert(name, ());
    } else if is(entry.replace) {
        put(&mut document.pass, name, entry);
    } else {
        document.removed.shift_remove(&name);
        let lower = document.pass.get_mut(&name).map(std::mem::take).unwrap_or_default();
        document.pass.insert(name, lay_entry(lower, entry));
    }
}

fn lay_entry(lower: Entry, upper: Entry) -> Entry {
    Entry {
        kind: upper.kind.or(lower.kind),
        inputs: lay_keys(lower.inputs, upper.inputs),
        set: lay_keys(lower.set, upper.set),
        slots: lay_keys(lower.slots, upper.slots),
        repeat: upper.repeat.or(lower.repeat),
        feed: lay_keys(lower.feed, upper.feed),
        remove: None,
        replace: None,
    }
}

fn lay_keys<T>(mut lower: Keys<T>, upper: Keys<T>) -> Keys<T> {
    for (key, value) in upper {
        put(&mut lower, key, value);
    }
    lower
}

/// Inserts with the new key's place, where the old key stood in the order.
fn put<T>(keys: &mut Keys<T>, key: Spanned<String>, value: T) {
    match keys.get_full_mut2(&key) {
        Some((_, old_key, old_value)) => (*old_key, *old_value) = (key, value),
        None => {
            keys.insert(key, value);
        }
    }
}
