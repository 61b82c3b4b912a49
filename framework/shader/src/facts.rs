//! Words in comments and conditions that nothing would ever read.

use crate::{
    Library, ShaderError,
    comments::BiasLine,
    cuts, locate,
    near::cure,
    source::{word_length, words},
};

/// Tags at the head of a module.
const TAGS: [&str; 3] = ["@default", "@needs", "@paths"];

/// The first tag at the module's head, and the first fact in `@needs`, `bias (fact)` or `@if`, that does not exist.
pub fn check(library: &Library, module: &str) -> Result<(), ShaderError> {
    let found = library.module(module)?;
    let mut start = 0;
    for line in found.text.split_inclusive('\n') {
        if let Some(head) = line.trim_start().strip_prefix("//!") {
            let trimmed = head.trim();
            let at = start + line.len() - head.trim_start().len();
            match (trimmed.starts_with('@'), BiasLine::read(trimmed).and_then(|bias| bias.condition)) {
                (true, _) => check_tag(library, module, at, trimmed)?,
                (false, Some(fact)) if !fact.contains('=') => check_fact(library, module, at + trimmed.find(&fact).unwrap_or(0), &fact)?,
                _ => {}
            }
        }
        start += line.len();
    }
    for (at, condition) in cuts::conditions(&found.code) {
        for (within, name) in words(condition).filter(|(_, name)| !["true", "false"].contains(name)) {
            check_fact(library, module, at + within, name)?;
        }
    }
    Ok(())
}

fn check_tag(library: &Library, module: &str, at: usize, tag: &str) -> Result<(), ShaderError> {
    let name = &tag[..1 + word_length(&tag[1..])];
    if !TAGS.contains(&name) {
        let cure = cure(name, "tags of `//!` lines", TAGS);
        return Err(locate::at(library, module, at, format!("there is no tag `{name}`{cure}")));
    }
    let mut facts = words(tag).skip(1).filter(|_| name == "@needs");
    facts.try_for_each(|(within, fact)| check_fact(library, module, at + within, fact))
}

fn check_fact(library: &Library, module: &str, at: usize, name: &str) -> Result<(), ShaderError> {
    match library.facts() {
        Some(facts) if !facts.contains(name) => {
            let cure = cure(name, "facts", facts.iter().map(String::as_str));
            Err(locate::at(library, module, at, format!("there is no fact `{name}` of scenes{cure}")))
        }
        _ => Ok(()),
    }
}
