//! glTF files: whatever the bytes, an error or a scene that is whole.

#![no_main]

#[path = "../../framework/scene/tests/common/mod.rs"]
mod common;

use aquifer_scene::{LoadError, Scene};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match Scene::from_gltf(bytes, "fuzz", None) {
        Ok(scene) => common::use_it(&scene, "fuzz"),
        Err(LoadError::Panicked { why }) => panic!("{why}"),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
