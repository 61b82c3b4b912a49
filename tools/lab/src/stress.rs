//! Scenes and settings at the ends of what numbers can bear, with verdicts by statistics: `aquifer stress`.
//!
//! A [`Case`] is data: a scene in code, what it must look like, which frames are looked at, and which graphs are known not to pass, with the
//! reason. [`Bench`] runs graphs on it, over independent seeds, against the path tracer; a [`Row`] is what came of one graph on one case.

mod bench;
mod case;
mod extreme;
mod long;
mod page;
mod row;
mod stiff;

pub use bench::{Bench, Effort};
pub use case::{Case, Known, Looks, Turned};
pub use long::{Long, long};
pub use page::page;
pub use row::{Outcome, Pictures, Row, Share, table};

/// Every case, the extreme ones first.
pub fn all() -> impl Iterator<Item = &'static Case> {
    extreme::CASES.iter().chain(stiff::CASES)
}

/// The case of that name.
pub fn by_name(name: &str) -> Option<&'static Case> {
    all().find(|case| case.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_case_has_a_name_of_its_own_and_a_scene_that_is_taken_or_refused_as_it_says() {
        let names: BTreeSet<&str> = all().map(|case| case.name).collect();
        assert_eq!(names.len(), all().count());
        for case in all() {
            let refused = (case.scene)().finish().err().map(|error| error.to_string());
            match case.looks {
                Looks::Refused(words) => assert!(refused.is_some_and(|error| error.contains(words)), "{}", case.name),
                _ => assert_eq!(refused, None, "{}", case.name),
            }
        }
    }
}
