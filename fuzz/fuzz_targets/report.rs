//! `report.json`: an error, or a page.

#![no_main]

#[path = "../../tools/lab/tests/common/report.rs"]
mod report;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    report::is_whole(bytes);
});
