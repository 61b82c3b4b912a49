//! Graph files: whatever the text, faults that can be read or a graph that can be planned.

#![no_main]

#[path = "../../framework/graph/tests/common/anything.rs"]
mod anything;
#[path = "../../framework/graph/tests/fake/mod.rs"]
mod fake;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| anything::survives(text));
