//! `aquifer regress`

use crate::run::{Run, aquifer, names};
use std::{fs, path::Path};

/// The pictures of this repository.
const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden");
const SHADERS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders");

fn regress(graph: &str, golden: &str, out: &Path, more: &[&str]) -> Run {
    let args = ["regress", graph, "--golden", golden, "-o", out.to_str().unwrap()];
    aquifer(&args.into_iter().chain(more.iter().copied()).collect::<Vec<&str>>())
}

#[test]
fn pictures_are_those_that_were_kept() {
    let out = tempfile::tempdir().unwrap();
    for graph in ["path_tracer", "restir_di_unbiased", "restir_gi_spatial_only"] {
        let run = regress(graph, GOLDEN, out.path(), &[]).succeeds();
        assert!(run.out.starts_with(&format!("{graph}: unchanged")), "{}", run.out);
    }
    assert!(names(out.path()).is_empty());
}

#[test]
fn every_built_in_graph_has_a_picture() {
    let kept = fs::read_to_string(Path::new(GOLDEN).join("pictures.json")).unwrap();
    let kept: serde_json::Value = serde_json::from_str(&kept).unwrap();
    let listed = aquifer(&["graphs"]).succeeds().out;
    let graphs: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(graphs.len() >= 15);
    let pictures = kept["pictures"].as_object().unwrap();
    let missing: Vec<&str> = graphs.into_iter().filter(|graph| !pictures.contains_key(*graph)).collect();
    assert!(missing.is_empty(), "{missing:?}");
    let bytes: u64 = fs::read_dir(GOLDEN).unwrap().map(|entry| entry.unwrap().metadata().unwrap().len()).sum();
    assert!(bytes < 10 << 20, "{bytes} bytes");
}

#[test]
fn a_biased_graph_is_another_picture() {
    // Of the unbiased graph only the name is left: constant weights and reused visibility darken shadow edges.
    let mine = tempfile::tempdir().unwrap();
    let graph = mine.path().join("restir_di_unbiased.toml");
    fs::write(&graph, "extends = 'restir_di.toml'\n").unwrap();
    let out = mine.path().join("out");
    let run = regress(graph.to_str().unwrap(), GOLDEN, &out, &[]);
    assert_eq!(run.code, 1, "{}{}", run.out, run.err);
    assert!(run.out.contains("restir_di_unbiased: changed") && run.err.contains("--bless keeps the new ones"), "{}{}", run.out, run.err);
    let images = ["difference.exr", "got.exr", "want.exr"].map(|end| format!("restir_di_unbiased.{end}"));
    assert_eq!(names(&out), [&["changed.html".to_owned()][..], &images].concat());
    let page = fs::read_to_string(out.join("changed.html")).unwrap();
    assert_eq!((page.matches("data:image/png;base64,").count(), page.matches("restir_di_unbiased").count() > 0), (3, true));
}

/// Replaces a piece of a shader.
fn planted(folder: &Path, module: &str, right: &str, wrong: &str) -> String {
    let text = fs::read_to_string(Path::new(SHADERS).join(format!("{module}.wgsl"))).unwrap();
    assert_eq!(text.matches(right).count(), 1, "{right}");
    let file = folder.join(format!("{module}.wgsl"));
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, text.replace(right, wrong)).unwrap();
    folder.to_str().unwrap().to_owned()
}

#[test]
fn bugs_of_spatial_reuse_are_found() {
    // One rejects neighbours by their samples, which biases; the other finds none, which changes no mean, only noise.
    let joined = "inputs[count] = input_of(other, NOW, HUGE);\n        count += 1u;";
    let by_sample = "if (current[other].weight.value <= 0.0) { continue; }\n        ";
    let found = "return select(NOWHERE, index, verdict == LIKE);";
    let bugs = [("pass/spatial", joined, format!("{by_sample}{joined}")), ("restir/neighbour", found, "return NOWHERE;".to_owned())];
    for (module, right, wrong) in bugs {
        let mine = tempfile::tempdir().unwrap();
        let shaders = planted(mine.path(), module, right, &wrong);
        let run = regress("restir_gi_spatial_only", GOLDEN, &mine.path().join("out"), &["--shaders", &shaders]);
        assert_eq!(run.code, 1, "{module}: {}{}", run.out, run.err);
        assert!(run.out.contains("restir_gi_spatial_only: changed"), "{module}: {}", run.out);
    }
}

#[test]
fn blessing_shows_what_it_changes() {
    let mine = tempfile::tempdir().unwrap();
    let (golden, graph, out) = (mine.path().join("golden"), mine.path().join("mine.toml"), mine.path().join("out"));
    let write = |text: &str| fs::write(&graph, text).unwrap();
    let bless = || regress(graph.to_str().unwrap(), golden.to_str().unwrap(), &out, &["--bless", "--size", "16x9"]).succeeds().out;
    write("extends = 'light_sampling.toml'\n");
    assert!(bless().starts_with("mine: no picture is kept"));
    assert!(bless().starts_with("mine: unchanged (the same bits; 0 of 144 pixels fail"));
    write("extends = 'light_sampling.toml'\ntransport = 'full:0'\n");
    assert!(bless().starts_with("mine: changed (other bits; "));
    assert!(out.join("changed.html").exists());
    assert!(bless().starts_with("mine: unchanged (the same bits"));
}
