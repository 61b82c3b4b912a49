//! What a comparison has measured, from disk: whole, or counted as missing.

#![no_main]

#[path = "../../tools/lab/tests/common/measured.rs"]
mod measured;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    measured::is_whole(bytes);
});
