//! `aquifer regress`

use crate::run::{aquifer, names};

/// The pictures of this repository.
const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden");

#[test]
fn pictures_are_those_that_were_kept() {
    let out = tempfile::tempdir().unwrap();
    let run = aquifer(&["regress", "--golden", GOLDEN, "-o", out.path().to_str().unwrap()]).succeeds();
    assert!(run.out.lines().count() >= 4 && run.out.lines().all(|line| line.contains(": unchanged")), "{}", run.out);
    assert!(names(out.path()).is_empty());
}

#[test]
fn a_biased_graph_is_another_picture() {
    // Of the unbiased graph only the name is left: constant weights and reused visibility darken shadow edges.
    let mine = tempfile::tempdir().unwrap();
    let graph = mine.path().join("restir_di_unbiased.toml");
    std::fs::write(&graph, "extends = 'restir_di.toml'\n").unwrap();
    let (graph, out) = (graph.to_str().unwrap(), mine.path().join("out"));
    let run = aquifer(&["regress", graph, "--golden", GOLDEN, "-o", out.to_str().unwrap()]);
    assert_eq!(run.code, 1, "{}{}", run.out, run.err);
    assert!(run.out.contains("restir_di_unbiased: changed") && run.err.contains("--bless keeps the new ones"), "{}{}", run.out, run.err);
    assert_eq!(names(&out), ["restir_di_unbiased.difference.exr", "restir_di_unbiased.got.exr", "restir_di_unbiased.want.exr"]);
}
