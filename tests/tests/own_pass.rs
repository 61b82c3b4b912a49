//! Follows docs/own_pass.md from a folder outside the tree.

use aquifer_graph::{Document, FsFiles, Graph, Layered, NeedsAll, Shelf};
use aquifer_render::{Renderer, RendererOptions, SceneGlobals, View};
use aquifer_tests::{context, image, scene};

/// The code block that follows `` `mine/NAME`: ``.
fn block(page: &str, name: &str) -> String {
    let start = page.find(&format!("`mine/{name}`:")).unwrap_or_else(|| panic!("the page names no {name}"));
    let code = page[start..].split("```").nth(1).expect("a code block follows");
    code.split_once('\n').expect("the block has a language").1.to_owned()
}

#[test]
fn the_page_works_as_written() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/own_pass.md")).expect("the page");
    let mine = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(mine.path().join("pass")).expect("a folder");
    for name in ["pass/vignette.wgsl", "vignette.toml"] {
        std::fs::write(mine.path().join(name), block(&page, name)).expect("a file");
    }
    let Some(context) = context() else { return };
    let scene = scene("cornell");
    let registry = aquifer_lab::stage::registry(Some(&scene), &[mine.path().to_owned()]).expect("the folder is read");
    let files = Layered { upper: FsFiles, lower: Shelf::new("built-in", aquifer_graphs::files()) };
    let path = mine.path().join("vignette.toml");
    let mut pictures = ["width=0", "width=4"].map(|setting| {
        let mut document = Document::load(&path.to_string_lossy(), &files).unwrap_or_else(|faults| panic!("{faults}"));
        let settings = [format!("vignette.{setting}"), "transport=direct".into()];
        document.apply(settings.map(|text| aquifer_graph::Source::new("--set", text))).unwrap_or_else(|faults| panic!("{faults}"));
        let graph = Graph::check(&document, &registry).unwrap_or_else(|faults| panic!("{faults}"));
        let plan = graph.plan(&NeedsAll, &[]).expect("a plan");
        let globals = SceneGlobals::new(&context, scene.clone(), View::default()).expect("the scene fits");
        let options = RendererOptions { size: [32, 18], ..RendererOptions::default() };
        let mut renderer = Renderer::new(&context, &registry, plan, Box::new(globals), options).expect("it compiles");
        image(&mut renderer, 1)
    });
    // Half the film is 2 distances wide: the middle keeps its light, the corner is left with cos⁴.
    let [plain, dark] = &mut pictures;
    let share = |pixel: usize| dark[pixel][1] / plain[pixel][1];
    let expected = |x: f64, y: f64| {
        let (px, py) = ((x + 0.5 - 16.0) / 32.0 * 4.0, (y + 0.5 - 9.0) / 32.0 * 4.0);
        (1.0 + px * px + py * py).powi(-2)
    };
    let mut compared = 0;
    for (pixel, color) in plain.iter().enumerate().filter(|(_, color)| color[1] > 0.01 && color[1] < 0.99) {
        let wanted = expected((pixel % 32) as f64, (pixel / 32) as f64);
        assert!((share(pixel) - wanted).abs() < 1e-3 * wanted + 1e-4 / color[1], "{pixel}: {} is not {wanted}", share(pixel));
        compared += 1;
    }
    assert!(compared > 100, "only {compared} pixels are lit");
}
