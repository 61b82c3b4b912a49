//! Texts that fuzzing has found (`tools/fuzz.sh graph`), read without a fuzzer.

#[path = "common/anything.rs"]
mod anything;
mod fake;

#[test]
fn what_fuzzing_keeps_is_refused_or_planned() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/graph");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(!files.is_empty());
    for file in files {
        // As the fuzzer's own reader of texts: what is no text is passed over.
        if let Ok(text) = std::str::from_utf8(&std::fs::read(&file).unwrap()) {
            anything::survives(text);
        }
    }
}
