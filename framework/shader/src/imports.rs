//! What a module names of others: is it there?

use crate::{
    Library, ShaderError, Specialisation, locate,
    near::cure,
    slots,
    source::{declarations, without_attributes, word_length},
};

/// An item of another module, where it is named.
#[derive(Debug, PartialEq)]
struct Reference<'a> {
    /// All names, without `package`.
    path: Vec<&'a str>,
    path_at: usize,
    item_at: usize,
}

/// The first of the module's imports, used or not, and of the paths in its code that leads nowhere.
pub fn check(library: &Library, what: &Specialisation, module: &str) -> Result<(), ShaderError> {
    let code = &library.module(module)?.code;
    foreign(library, module, code)?;
    for reference in references(code) {
        let (full, fills) = match reference.path[..] {
            ["slot", slot, ref rest @ ..] => {
                // The linker tells of slots that nothing fills.
                let Some(filling) = what.slots.get(slot) else { continue };
                let parts: Vec<String> =
                    [slots::module_of(slot, filling)].into_iter().chain(rest.iter().map(|&part| part.to_owned())).collect();
                (parts.join("/"), format!(", which fills slot `{slot}`,"))
            }
            ref path => (path.join("/"), String::new()),
        };
        if library.text(&full).is_some() {
            continue;
        }
        let (target, item) = full.rsplit_once('/').unwrap_or((&full, ""));
        match library.module(target) {
            Err(missing) => return Err(locate::at(library, module, reference.path_at, missing.to_string())),
            // A module may hand on what it imports.
            Ok(found) if found.declared.contains(item) || found.code.contains("@publish") => {}
            Ok(found) => {
                let cure = cure(item, "it has", found.declared.iter().map(String::as_str));
                return Err(locate::at(library, module, reference.item_at, format!("module `{target}`{fills} has no `{item}`{cure}")));
            }
        }
    }
    Ok(())
}

/// Refuses imports that begin with a name: the linker would take it for that of another package.
fn foreign(library: &Library, module: &str, code: &str) -> Result<(), ShaderError> {
    for declaration in declarations(code) {
        let piece = without_attributes(&code[declaration.range.clone()]);
        let Some(path) = piece.strip_prefix("import").filter(|rest| rest.starts_with(char::is_whitespace)).map(str::trim_start) else {
            continue;
        };
        let first = &path[..word_length(path)];
        if !first.is_empty() && !["package", "super", "self"].contains(&first) {
            let at = declaration.range.end - path.len();
            return Err(locate::at(library, module, at, format!("imports begin with `package::`, this one with `{first}`")));
        }
    }
    Ok(())
}

/// Every `package::…` of a text without comments: one for each item in its braces.
fn references(code: &str) -> Vec<Reference<'_>> {
    const ROOT: &str = "package::";
    let mut found = Vec::new();
    for (at, _) in code.match_indices(ROOT) {
        read(code, at + ROOT.len(), at + ROOT.len(), &mut Vec::new(), &mut found);
    }
    found
}

/// Reads `a::b`, `a as b` or `{a, b::{c}}` from `at`; gives where it ends, or `None` where the text is no import: the linker says why.
fn read<'a>(code: &'a str, at: usize, path_at: usize, path: &mut Vec<&'a str>, found: &mut Vec<Reference<'a>>) -> Option<usize> {
    let at = skip(code, at);
    if code[at..].starts_with('{') {
        let mut at = at;
        loop {
            at = skip(code, at + 1);
            if !code[at..].starts_with('}') {
                let depth = path.len();
                at = skip(code, read(code, at, path_at, path, found)?);
                path.truncate(depth);
            }
            match code.as_bytes().get(at)? {
                b',' => {}
                b'}' => return Some(at + 1),
                _ => return None,
            }
        }
    }
    let word = &code[at..at + word_length(&code[at..])];
    if word.is_empty() {
        return None;
    }
    let after = skip(code, at + word.len());
    if code[after..].starts_with("::") {
        path.push(word);
        return read(code, after + 2, path_at, path, found);
    }
    found.push(Reference { path: path.iter().copied().chain([word]).collect(), path_at, item_at: at });
    match code[after..].strip_prefix("as").filter(|rest| rest.starts_with(char::is_whitespace)) {
        Some(_) => {
            let renamed = skip(code, after + 2);
            Some(renamed + word_length(&code[renamed..]))
        }
        None => Some(after),
    }
}

/// Past spaces.
fn skip(code: &str, at: usize) -> usize {
    code.len() - code[at..].trim_start().len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_of_import_is_read() {
        let code =
            "import package::a::b::{c, d as e, f::{g,\n h}};\nimport package::i;\nfn x() { package::j::k(1); }\nimport package::l::{m";
        let found: Vec<String> = references(code).iter().map(|one| one.path.join("/")).collect();
        assert_eq!(found, ["a/b/c", "a/b/d", "a/b/f/g", "a/b/f/h", "i", "j/k", "l/m"]);
    }
}
