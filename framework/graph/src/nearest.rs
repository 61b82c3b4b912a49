//! The name that was probably meant.

/// The candidate most like `name`, if one is like it at all: at most a third of the letters differ, or one is a part of the other.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = name.to_lowercase();
    let distance = |candidate: &str| strsim::damerau_levenshtein(&wanted, &candidate.to_lowercase());
    candidates
        .into_iter()
        .map(|candidate| (distance(candidate), candidate))
        .filter(|&(distance, candidate)| is_like(&wanted, candidate, distance))
        .min()
        .map(|(_, candidate)| candidate)
}

fn is_like(wanted: &str, candidate: &str, distance: usize) -> bool {
    let letters = wanted.chars().count().max(candidate.chars().count());
    let part = wanted.len() >= 3 && candidate.len() >= 3 && (candidate.contains(wanted) || wanted.contains(candidate));
    distance <= (letters / 3).max(1) && distance < letters || part
}

/// A cure for a wrong name: the nearest of `candidates`, else all of them. `what` names them, e.g. "inputs of `shade`".
pub(crate) fn cure<'a>(name: &str, what: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let all: Vec<&str> = candidates.into_iter().collect();
    if let Some(near) = nearest(name, all.iter().copied()) {
        return format!("did you mean `{near}`?");
    }
    if all.is_empty() { format!("there are no {what}") } else { format!("{what}: {}", list(&all)) }
}

/// Names in backticks with commas, cut where a line would overflow.
pub(crate) fn list<S: AsRef<str>>(names: &[S]) -> String {
    const MOST: usize = 12;
    let shown: Vec<String> = names.iter().take(MOST).map(|name| format!("`{}`", name.as_ref())).collect();
    match names.len().checked_sub(MOST) {
        None | Some(0) => shown.join(", "),
        Some(more) => format!("{} and {more} more", shown.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_hand_are_found() {
        let ports = ["surface", "previous_surface", "motion", "current", "history"];
        assert_eq!(nearest("histroy", ports), Some("history"));
        assert_eq!(nearest("Surface", ports), Some("surface"));
        assert_eq!(nearest("hist", ports), Some("history"));
        assert_eq!(nearest("reservoir", ports), None);
        assert_eq!(nearest("x", ["y"]), None, "one letter is like no other letter");
    }
}
