//! Waiting with an end.

use std::time::{Duration, Instant};

/// Longer than anything takes on a busy machine; only waited for in full when what is waited for never comes.
const LONG: Duration = Duration::from_secs(60);

/// Looks until there is something; what a look gives instead is told when it never comes.
pub fn until<T>(what: &str, mut look: impl FnMut() -> Result<T, String>) -> T {
    let end = Instant::now() + LONG;
    loop {
        let instead = match look() {
            Ok(found) => return found,
            Err(instead) => instead,
        };
        assert!(Instant::now() < end, "{what}: still waiting; {instead}");
        std::thread::sleep(Duration::from_millis(10));
    }
}
