//! Panics in words: a thread that ends without a word lets the window wait for ever.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Does the work; the error is what it said when it panicked.
pub fn guard<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
        format!("a defect of Aquifer: {}", words.unwrap_or("a panic without words"))
    })
}
