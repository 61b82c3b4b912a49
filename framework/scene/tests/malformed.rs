//! Files as they should not be: none panics, none hangs, none half-loads.

mod common;

use aquifer_scene::{LoadError, Scene};
use common::{File, glb, rich, use_it};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// How long a file may take, also where the machine has other work.
const PATIENCE: Duration = Duration::from_secs(10);

/// SplitMix64.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % limit as u64) as usize
    }
}

/// Loads; what loads must be whole enough to be used.
fn attempt(bytes: &[u8], case: &str) -> Result<Scene, LoadError> {
    let start = Instant::now();
    let result = Scene::from_gltf(bytes, "malformed", None);
    match &result {
        Ok(scene) => use_it(scene, case),
        Err(LoadError::Panicked { why }) => panic!("{case}: {why}"),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    assert!(start.elapsed() < PATIENCE, "{case}: took {:?}", start.elapsed());
    result
}

/// Every place in a document.
fn pointers(value: &Value, at: &str, found: &mut Vec<String>) {
    let mut inside = |key: &str, item: &Value| {
        let pointer = format!("{at}/{key}");
        pointers(item, &pointer, found);
        found.push(pointer);
    };
    match value {
        Value::Array(items) => items.iter().enumerate().for_each(|(index, item)| inside(&index.to_string(), item)),
        Value::Object(members) => members.iter().for_each(|(key, item)| inside(key, item)),
        _ => {}
    }
}

fn places() -> (File, Vec<String>) {
    let file = rich();
    let mut found = Vec::new();
    pointers(&file.json, "", &mut found);
    (file, found)
}

#[test]
fn truncated() {
    let whole = rich().glb();
    let mut count = 0;
    for length in (0..whole.len()).step_by(whole.len() / 150) {
        assert!(attempt(&whole[..length], &format!("first {length} bytes")).is_err());
        count += 1;
    }
    // The header amended to match, so that the reader gets further.
    for length in (28..whole.len()).step_by(whole.len() / 150) {
        let mut short = whole[..length].to_vec();
        short[8..12].copy_from_slice(&(length as u32).to_le_bytes());
        assert!(attempt(&short, &format!("shortened to {length}")).is_err());
        count += 1;
    }
    assert!(count >= 300);
}

#[test]
fn bits_flipped() {
    let whole = rich().glb();
    let mut numbers = Numbers(1);
    for case in 0..600 {
        let mut flipped = whole.clone();
        for _ in 0..=numbers.below(8) {
            let at = numbers.below(flipped.len());
            flipped[at] ^= 1 << numbers.below(8);
        }
        attempt(&flipped, &format!("flip {case}")).ok();
    }
}

#[test]
fn vertices_flipped() {
    let file = rich();
    let mut numbers = Numbers(2);
    for case in 0..300 {
        let mut flipped = file.clone();
        for _ in 0..=numbers.below(4) {
            let at = numbers.below(flipped.bin.len());
            flipped.bin[at] ^= 1 << numbers.below(8);
        }
        attempt(&flipped.glb(), &format!("data flip {case}")).ok();
    }
}

#[test]
fn numbers_replaced() {
    let (file, places) = places();
    let mut count = 0;
    for pointer in places.iter().filter(|pointer| file.json.pointer(pointer).is_some_and(Value::is_number)) {
        for number in [json!(-1), json!(0), json!(1), json!(4_000_000_000_u64), json!(u64::MAX), json!(0.5), json!(1e30), json!(1e39)] {
            let mut changed = file.clone();
            *changed.json.pointer_mut(pointer).expect("listed") = number.clone();
            let result = attempt(&changed.glb(), &format!("{pointer} = {number}"));
            assert!(number != json!(1e39) || result.is_err(), "{pointer} = 1e39");
            count += 1;
        }
    }
    assert!(count > 800, "{count}");
}

#[test]
fn kinds_replaced() {
    let (file, places) = places();
    for pointer in &places {
        for value in [json!(null), json!("text"), json!([]), json!({}), json!(true), json!([[[]]])] {
            let mut changed = file.clone();
            *changed.json.pointer_mut(pointer).expect("listed") = value.clone();
            attempt(&changed.glb(), &format!("{pointer} = {value}")).ok();
        }
    }
}

#[test]
fn members_removed() {
    let (file, places) = places();
    for pointer in &places {
        let (parent, key) = pointer.rsplit_once('/').expect("pointers start with a slash");
        let mut changed = file.clone();
        match changed.json.pointer_mut(parent) {
            Some(Value::Object(members)) => drop(members.remove(key)),
            Some(Value::Array(items)) => drop(items.remove(key.parse().expect("an index"))),
            _ => continue,
        }
        attempt(&changed.glb(), &format!("without {pointer}")).ok();
    }
}

#[test]
fn refused_with_a_reason() {
    let zeros = |count: u64| {
        move |file: &mut File| {
            let sparse = file.json["accessors"][5]["sparse"].clone();
            let accessor = &mut file.json["accessors"][0];
            accessor.as_object_mut().expect("an object").remove("bufferView");
            accessor["count"] = json!(count);
            accessor["sparse"] = sparse;
        }
    };
    let image = |bytes: Vec<u8>| {
        move |file: &mut File| {
            let view = file.view(&bytes);
            file.json["images"][0]["bufferView"] = json!(view);
        }
    };
    let png = common::png(8, 4);
    let mut bomb = png.clone();
    bomb[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    type Edit = Box<dyn Fn(&mut File)>;
    let cases: Vec<(&str, Edit)> = vec![
        ("a node that is its own child", Box::new(|f| f.json["nodes"][0]["children"] = json!([0]))),
        ("two nodes that are each other's parent", Box::new(|f| f.json["nodes"][0]["children"] = json!([2]))),
        ("a root twice", Box::new(|f| f.json["scenes"][0]["nodes"] = json!([2, 2]))),
        ("absurdly many zeros", Box::new(zeros(4_000_000_000))),
        ("more zeros than memory", Box::new(zeros(u64::MAX))),
        ("an offset beyond all numbers", Box::new(|f| f.json["accessors"][0]["byteOffset"] = json!(u64::MAX))),
        ("a view beyond all numbers", Box::new(|f| f.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX))),
        ("a count beyond all numbers", Box::new(|f| f.json["accessors"][0]["count"] = json!(u64::MAX))),
        ("an index past the vertices", Box::new(|f| write(f, 4, &[200]))),
        ("a missing image", Box::new(|f| f.json["images"][0] = json!({ "uri": "missing.png" }))),
        ("an image that is text", Box::new(image(b"not an image".to_vec()))),
        ("half an image", Box::new(image(png[..png.len() / 2].to_vec()))),
        ("an image larger than memory", Box::new(image(bomb))),
        ("a GIF", Box::new(image(b"GIF89a\x01\0\x01\0\0\0\0;".to_vec()))),
        ("a remote buffer", Box::new(|f| f.json["buffers"][0]["uri"] = json!("https://example.org/a.bin"))),
        ("a local buffer without a folder", Box::new(|f| f.json["buffers"][0]["uri"] = json!("a.bin"))),
        ("an unknown light type", Box::new(|f| f.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = json!("laser"))),
        ("a negative light", Box::new(|f| f.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = json!(-1.0))),
        ("a light that is not there", Box::new(|f| f.json["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = json!(9))),
        (
            "a spot inside out",
            Box::new(|f| {
                f.json["extensions"]["KHR_lights_punctual"]["lights"][2]["spot"] = json!({ "innerConeAngle": 1.0, "outerConeAngle": 0.5 })
            }),
        ),
        ("times that go back", Box::new(|f| write(f, 6, &3.0_f32.to_le_bytes()))),
        ("too few animation values", Box::new(|f| f.json["animations"][0]["samplers"][0]["output"] = json!(1))),
        ("a matrix of zeros", Box::new(|f| f.json["nodes"][5]["matrix"] = json!(vec![0; 16]))),
        ("a projective matrix", Box::new(|f| f.json["nodes"][5]["matrix"] = json!([1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]))),
        ("sparse indices out of order", Box::new(|f| f.json["accessors"][5]["sparse"]["count"] = json!(2))),
    ];
    for (case, change) in cases {
        let mut file = rich();
        change(&mut file);
        assert!(attempt(&file.glb(), case).is_err(), "{case}");
    }
}

/// Writes over the first bytes of an accessor.
fn write(file: &mut File, accessor: usize, bytes: &[u8]) {
    let view = file.json["accessors"][accessor]["bufferView"].as_u64().expect("given") as usize;
    let offset = file.json["bufferViews"][view]["byteOffset"].as_u64().expect("given") as usize;
    file.bin[offset..offset + bytes.len()].copy_from_slice(bytes);
}

#[test]
fn odd_files_that_load() {
    let mut flat = rich();
    let positions = flat.positions(&[[1.0; 3]; 4]);
    flat.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(positions);
    let scene = attempt(&flat.glb(), "triangles without area").expect("they are dropped");
    assert!(scene.warnings.iter().any(|warning| warning == "mesh `quads`: 2 degenerate triangles dropped"), "{:?}", scene.warnings);

    let deep = 100_000;
    let mut chain = rich();
    let first = chain.json["nodes"].as_array().expect("a list").len();
    let nodes = chain.json["nodes"].as_array_mut().expect("a list");
    nodes.extend((0..deep).map(|level| json!({ "children": [first + level + 1] })));
    nodes.push(json!({ "mesh": 1 }));
    chain.json["scenes"][0]["nodes"] = json!([first]);
    let scene = attempt(&chain.glb(), "a deep hierarchy").expect("depth is no fault");
    assert_eq!(scene.nodes.len(), deep + 2, "with the default camera");

    let nothing = json!({ "asset": { "version": "2.0" } });
    let scene = attempt(nothing.to_string().as_bytes(), "an empty file").expect("emptiness is no fault");
    assert!(scene.meshes.is_empty() && scene.at(0.0, None).is_ok());
}

#[test]
fn not_gltf_at_all() {
    let nested = "[".repeat(100_000);
    let texts = ["", "{", "null", "[]", "glTF", "{\"asset\":{}}", "\u{feff}{}", nested.as_str()];
    for text in texts {
        assert!(attempt(text.as_bytes(), "text").is_err());
        assert!(attempt(&glb(text.as_bytes(), &[]), "text in a container").is_err());
    }
}

/// Files that fuzzing starts from or has found (`tools/fuzz.sh scene`), read without a fuzzer.
#[test]
fn what_fuzzing_keeps_is_refused_or_loads_whole() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/scene");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(files.len() >= 4, "{files:?}");
    for file in files {
        let loaded = attempt(&std::fs::read(&file).unwrap(), &file.display().to_string());
        assert!(loaded.is_ok() || file.extension().is_none(), "{}: only files that the fuzzer named may be refused", file.display());
    }
}
