//! The name that was probably meant.

/// The candidate most like `name`, if one is like it at all.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let scored = candidates.into_iter().map(|known| (strsim::jaro_winkler(known, name), known));
    scored.filter(|(score, _)| *score > 0.8).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, known)| known)
}

/// What to say after a wrong name: the one that was meant, or, with what they are called, all there are.
pub fn cure<'a>(name: &str, what: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    const MOST: usize = 16;
    let all: Vec<&str> = candidates.into_iter().collect();
    if let Some(near) = nearest(name, all.iter().copied()) {
        return format!("; did you mean `{near}`?");
    }
    match all.len() {
        0 => String::new(),
        1..=MOST => format!("; {what}: `{}`", all.join("`, `")),
        _ => format!("; {what}: `{}` and {} more", all[..MOST].join("`, `"), all.len() - MOST),
    }
}
