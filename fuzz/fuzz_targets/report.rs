//! `report.json`: an error, or a page.

#![no_main]

use aquifer_lab::{compare::report::Report, page};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(report) = serde_json::from_slice::<Report>(bytes) else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    if let Ok(html) = page::html(&report, folder.path()) {
        assert!(html.ends_with("</html>\n") || html.ends_with("</html>"));
    }
});
