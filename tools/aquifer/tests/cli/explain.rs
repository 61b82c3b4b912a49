//! `aquifer explain`, `--keep-all`

use crate::run::aquifer;
use serde_json::Value;

#[test]
fn what_is_left_out_is_told_with_its_reason_and_its_bytes() {
    let scene = ["explain", "restir_gi_validated", "--scene", "cornell", "--size", "32x18", "--rounds", "1"];
    let told: Value = serde_json::from_str(&aquifer(&[&scene[..], &["--json"]].concat()).succeeds().out).unwrap();
    let of = |list: &str, name: &str| -> Value {
        let found = told[list].as_array().unwrap().iter().find(|row| row["name"] == name);
        found.unwrap_or_else(|| panic!("no {name} in {}", told[list])).clone()
    };
    let motion = of("left_out", "gbuffer_traced.motion");
    assert_eq!(
        (motion["because"].as_str(), motion["bytes"].as_u64()),
        (Some("the scene has no moving camera, no moving objects"), Some(32 * 18 * 8))
    );
    let hierarchy = of("arrays", "scene/hierarchy::tlas_prev");
    assert_eq!(hierarchy["because"], "the scene has no moving objects");
    assert!(hierarchy["bytes"].as_u64().unwrap() > 0);
    let pieces = told["pieces"].as_array().unwrap();
    let conditions: Vec<&str> = pieces.iter().map(|piece| piece["condition"].as_str().unwrap()).collect();
    for fact in
        ["textures", "environment", "punctual_lights", "alpha", "normal_maps", "metals", "glossy", "moving_lights || moving_objects"]
    {
        assert!(conditions.contains(&fact), "{fact} is not in {conditions:?}");
    }
    assert!(told["bytes"]["needed"].as_u64() < told["bytes"]["all"].as_u64());
    assert!(told["frame_ms"]["needed"]["median"].as_f64().unwrap() > 0.0);
}

#[test]
fn keeping_all_renders_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let image = |name: &str, more: &[&str]| {
        let path = folder.path().join(name);
        let args = ["render", "light_sampling", "--scene", "cornell", "--size", "16x9", "--frames", "2", "-o", path.to_str().unwrap()];
        aquifer(&[&args[..], more].concat()).succeeds();
        std::fs::read(path).unwrap()
    };
    assert_eq!(image("lean.png", &[]), image("all.png", &["--keep-all"]));
}
