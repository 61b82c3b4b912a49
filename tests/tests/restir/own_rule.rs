//! The page `docs/mis_rules.md`, followed: its rule and its graph, from a folder outside the tree.

use crate::toy::{difference, estimates, graph, renderer};
use aquifer_graph::{Document, Graph, NeedsAll, Shelf, Source};
use aquifer_render::{Renderer, RendererOptions, SceneGlobals, View};
use aquifer_tests::{context, scene};
use std::{fs, path::Path};

const PAGE: &str = include_str!("../../../docs/mis_rules.md");

/// The fenced block whose first line names `file`.
fn block(file: &str) -> &'static str {
    let mut blocks = PAGE.split("```").skip(1).step_by(2);
    let named = |block: &&str| block.lines().nth(1).is_some_and(|line| line.contains(file));
    let text = blocks.find(named).unwrap_or_else(|| panic!("the page shows {file}"));
    text.split_once('\n').expect("a block has lines").1
}

fn write(folder: &Path, file: &str) {
    let path = folder.join(file);
    fs::create_dir_all(path.parent().expect("in a folder")).unwrap();
    fs::write(path, block(file)).unwrap();
}

#[test]
fn the_page_works_from_a_folder_outside_the_tree() {
    let folder = tempfile::tempdir().unwrap();
    for file in ["mis/power.wgsl", "power.toml"] {
        write(folder.path(), file);
    }
    let mut library = aquifer_passes::library();
    library.add_folder(folder.path()).unwrap();
    let scene = scene("cornell");
    let registry = aquifer_passes::registry(library, Some(&scene)).unwrap();
    let text = fs::read_to_string(folder.path().join("power.toml")).unwrap();
    let document = Document::parse(Source::new("power.toml", text), &Shelf::new("", aquifer_graphs::files()));
    let graph = Graph::check(&document.unwrap_or_else(|faults| panic!("{faults}")), &registry).unwrap_or_else(|faults| panic!("{faults}"));
    assert!(graph.bias().is_empty(), "{:?}", graph.bias());
    let plan = graph.plan(&NeedsAll, &["shade.color"]).unwrap();
    let Some(context) = context() else { return };
    let globals = SceneGlobals::new(&context, scene.clone(), View::default()).unwrap();
    let options = RendererOptions { size: [32, 18], ..RendererOptions::default() };
    let mut renderer = Renderer::new(&context, &registry, plan, Box::new(globals), options).unwrap();
    (0..4).for_each(|_| renderer.frame().unwrap());
    let color = renderer.read_f32("shade.color").unwrap();
    assert!(color.iter().all(|word| word.is_finite()) && color.iter().sum::<f32>() > 0.0);
}

#[test]
fn the_rule_of_the_page_is_unbiased() {
    let Some(context) = context() else { return };
    for visibility in ["at_shading", "in_target"] {
        let rule = [("mis/power", block("mis/power.wgsl"))];
        let mut renderer = renderer(&context, &graph("power", visibility, 12), &rule, &[]);
        for (count, moments) in (1..).zip(estimates(&mut renderer, |all| all[0].count() >= 8 * 32_768)) {
            let found = difference(&moments);
            eprintln!("power, {visibility}, {count} inputs: {:+.4} % ± {:.4} %", 100.0 * found.value, 100.0 * found.standard_error);
            assert!(found.p_different() > 1e-4 && found.standard_error < 1e-3, "{visibility}, {count} inputs: {found:?}");
        }
    }
}
