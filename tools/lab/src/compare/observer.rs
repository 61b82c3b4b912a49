//! Who watches a comparison.

/// Hears how far a comparison is, and may end it.
pub trait Observer {
    /// Part `done` of `of` of what is being done, in words. `of` is 0 where the end is not known.
    fn progress(&mut self, what: &str, done: u64, of: u64);

    /// Something that a reader of the result must know.
    fn warn(&mut self, text: &str);

    /// Should the work end here? What is done is kept.
    fn stop(&self) -> bool {
        false
    }
}

/// Nobody.
pub struct Unwatched;

impl Observer for Unwatched {
    fn progress(&mut self, _: &str, _: u64, _: u64) {}

    fn warn(&mut self, text: &str) {
        tracing::warn!("{text}");
    }
}
