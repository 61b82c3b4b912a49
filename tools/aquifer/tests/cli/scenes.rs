//! `aquifer scenes`

use crate::run::{aquifer, names};

#[test]
fn all_scenes_are_listed_and_described() {
    let list = aquifer(&["scenes", "list"]).succeeds();
    assert!(list.err.is_empty(), "{}", list.err);
    assert!(list.out.lines().any(|line| line.starts_with("cornell ")));
    let shown = aquifer(&["scenes", "show", "cornell"]).succeeds();
    assert!(shown.out.contains("emissive_meshes") && shown.out.contains("cameras      main"), "{}", shown.out);
}

#[test]
fn a_description_is_json_too() {
    let shown = aquifer(&["scenes", "show", "cornell", "--json"]).succeeds();
    let value: serde_json::Value = serde_json::from_str(&shown.out).expect("JSON");
    assert_eq!(value["name"], "cornell");
    assert!(value["triangles"].as_u64().is_some_and(|count| count > 10));
}

#[test]
fn an_exported_scene_is_read_again() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("cornell.glb").to_string_lossy().into_owned();
    let exported = aquifer(&["scenes", "export", "cornell", &path]).succeeds();
    assert!(exported.out.is_empty(), "the file is the data");
    let json = |name: &str| -> serde_json::Value {
        serde_json::from_str(&aquifer(&["scenes", "show", name, "--json"]).succeeds().out).expect("JSON")
    };
    let (made, read) = (json("cornell"), json(&path));
    for key in ["placed_triangles", "materials", "cameras", "features"] {
        assert_eq!(made[key], read[key], "{key}");
    }
}

#[test]
fn unknown_scenes_and_broken_files_fail() {
    aquifer(&["scenes", "show", "cornel"]).fails(1, "did you mean `cornell`?");
    aquifer(&["scenes", "show", "nothing.glb"]).fails(1, "nothing.glb");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("broken.glb");
    std::fs::write(&path, b"glTF rubbish").expect("a file");
    aquifer(&["scenes", "show", &path.to_string_lossy()]).fails(1, "error:");
    let missing = folder.path().join("no/such/folder/out.glb");
    aquifer(&["scenes", "export", "cornell", &missing.to_string_lossy()]).fails(1, "there is no folder");
    assert_eq!(names(folder.path()), ["broken.glb"]);
}
