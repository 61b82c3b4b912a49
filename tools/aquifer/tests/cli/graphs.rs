//! `aquifer graphs`, `check`, `dot`, `passes`

use crate::run::aquifer;
use std::path::PathBuf;

/// A graph file in a folder that lives as long as the test.
fn file(text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path: PathBuf = folder.path().join("graph.toml");
    std::fs::write(&path, text).expect("a file");
    let name = path.to_string_lossy().into_owned();
    (folder, name)
}

#[test]
fn every_built_in_graph_is_sound() {
    let list = aquifer(&["graphs"]).succeeds().out;
    let names: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.contains(&"path_tracer"), "{list}");
    for name in names {
        let text = aquifer(&["graphs", name]).succeeds().out;
        assert!(text.contains("title"), "{text}");
        aquifer(&["check", name]).succeeds();
    }
    assert!(aquifer(&["check", "path_tracer"]).succeeds().out.ends_with("unbiased\n"));
    aquifer(&["graphs", "path_trace"]).fails(1, "did you mean `path_tracer`?");
}

#[test]
fn faults_name_file_line_and_column() {
    let (_folder, path) = file("extends = \"path_tracer.toml\"\n\n[pass.tonemap]\nset.exposur = 1.0\n");
    aquifer(&["check", &path]).fails(1, "graph.toml:4:").fails(1, "unknown-param").fails(1, "exposure");
    let (_folder, path) = file("extends = \"graph.toml\"\n");
    aquifer(&["check", &path]).fails(1, "extends-loop");
    aquifer(&["check", "no_such_graph"]).fails(1, "no_such_graph");
    aquifer(&["check", "path_tracer", "--set", "tonemap.exposur=1"]).fails(1, "unknown-param").fails(1, "--set");
}

#[test]
fn settings_and_transport_are_laid_over() {
    let checked = |args: &[&str]| -> serde_json::Value {
        let args = [&["check", "path_tracer", "--json"], args].concat();
        serde_json::from_str(&aquifer(&args).succeeds().out).expect("JSON")
    };
    assert_eq!(checked(&["--transport", "direct"])["transport"], "direct");
    let exposed = checked(&["--set", "tonemap.exposure=2.5"]).to_string();
    assert!(exposed.contains("\"exposure\":2.5"), "{exposed}");
}

#[test]
fn graphs_are_drawn() {
    let dot = aquifer(&["dot", "path_tracer"]).succeeds().out;
    assert!(dot.starts_with("digraph") && dot.contains("accumulate"), "{dot}");
}

#[test]
fn passes_are_listed_and_explained() {
    let list = aquifer(&["passes"]).succeeds().out;
    assert!(list.lines().any(|line| line.starts_with("path_tracer ")), "{list}");
    assert!(!list.contains("(broken"), "{list}");
    let page = aquifer(&["passes", "tonemap"]).succeeds().out;
    for words in ["exposure", "Ports", "color (in)", "image (out)", "one of linear, reinhard, aces, agx", "Reinhard et al."] {
        assert!(page.contains(words), "`{words}` is not in\n{page}");
    }
    aquifer(&["passes", "tonemapp"]).fails(1, "did you mean `tonemap`?");
}

#[test]
fn the_page_of_all_passes_is_current() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/passes.md")).expect("the page");
    let made = aquifer(&["passes", "--markdown"]).succeeds().out;
    assert!(page == made, "docs/passes.md is not what the shaders say: aquifer passes --markdown > docs/passes.md");
    // A bar in what a shader says of a parameter would be a column of the table more.
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        assert_eq!(row.replace(r"\|", "").matches('|').count(), 5, "not four cells: {row}");
    }
}

#[test]
fn a_folder_of_shaders_adds_passes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir(folder.path().join("pass")).expect("a folder");
    let shader = "//! Paints everything grey.\n\n/// The paint.\n@group(1) @binding(0) var<storage, read_write> image: array<vec4<f32>>;\n\n@compute @workgroup_size(8, 8) fn main() { image[0] = vec4<f32>(0.5); }\n";
    std::fs::write(folder.path().join("pass/grey.wgsl"), shader).expect("a file");
    let shaders = folder.path().to_string_lossy().into_owned();
    let page = aquifer(&["passes", "grey", "--shaders", &shaders]).succeeds().out;
    assert!(page.contains("Paints everything grey.") && page.contains("The paint."), "{page}");
    aquifer(&["passes", "grey", "--shaders", "/no/such/folder"]).fails(1, "/no/such/folder");
}

#[test]
fn the_schema_takes_what_check_takes() {
    let schema: serde_json::Value = serde_json::from_str(&aquifer(&["schema"]).succeeds().out).expect("JSON");
    let validator = jsonschema::draft7::new(&schema).expect("a draft-07 schema");
    let as_json = |text: &str| serde_json::to_value(toml::from_str::<toml::Value>(text).expect("TOML")).expect("JSON");
    let list = aquifer(&["graphs"]).succeeds().out;
    for name in list.lines().filter_map(|line| line.split_whitespace().next()) {
        let graph = as_json(&aquifer(&["graphs", name]).succeeds().out);
        let faults: Vec<String> = validator.iter_errors(&graph).map(|fault| format!("{}: {fault}", fault.instance_path)).collect();
        assert!(faults.is_empty(), "{name}: {faults:?}");
    }
    for wrong in [
        "outptu = 'a.b'",
        "transport = 'indirect:0'",
        "[slots]\nproposal = 'powr'",
        "[pass.path_tracer]\nset.samples = 0",
        "[pass.path_tracer]\nset.sample = 1",
        "[pass.path_tracer]\nin.surfaces = 'a.b'",
        "[pass.mine]\nkind = 'no_such_kind'",
    ] {
        assert!(!validator.is_valid(&as_json(wrong)), "{wrong}");
    }
    let exposure = &schema["properties"]["pass"]["properties"]["tonemap"]["properties"]["set"]["properties"]["exposure"];
    assert_eq!(exposure["description"], "Exposure in stops.");
}

/// What references are made with is no matter of the folder one stands in.
#[test]
fn a_bare_name_is_the_built_in_graph() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("path_tracer.toml"), "title = 'another'\n").unwrap();
    let check = |graph: &str| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_aquifer")).args(["check", graph]).current_dir(folder.path()).output();
        output.unwrap().status.success()
    };
    assert!(check("path_tracer"));
    assert!(!check("./path_tracer.toml") && !check("path_tracer.toml"), "the file is the one without passes");
}
