//! What a comparison has measured, from disk: whole, or counted as missing.

#![no_main]

#[allow(dead_code, reason = "each target reads one kind")]
#[path = "../../tools/lab/tests/common/from_disk.rs"]
mod from_disk;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    from_disk::measured(bytes);
});
