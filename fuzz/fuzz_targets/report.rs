//! `report.json`: an error, or a page.

#![no_main]

#[allow(dead_code, reason = "each target reads one kind")]
#[path = "../../tools/lab/tests/common/from_disk.rs"]
mod from_disk;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    from_disk::report(bytes);
});
