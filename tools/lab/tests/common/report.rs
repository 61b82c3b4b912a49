//! Whatever the bytes of `report.json`: an error, or a page. For the fuzzer and for tests without one.

use aquifer_lab::{compare::report::Report, page};

/// `report.json`: whether a page could be made of it.
pub fn is_whole(bytes: &[u8]) -> bool {
    let Ok(report) = serde_json::from_slice::<Report>(bytes) else { return false };
    let folder = tempfile::tempdir().expect("a temporary folder");
    match page::html(&report, folder.path()) {
        Ok(html) => {
            assert!(html.trim_end().ends_with("</html>"));
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}
