//! Where the error of ReSTIR GI lies, and what it costs: beside one path a pixel, how much lower is the square error of one frame after 32, for how
//! many more rays; which part of it is colour alone, and which part sits in a few pixels.
//!
//! ```text
//! cargo run -p aquifer-tests --example error_parts -- FILE COMMIT DATE [SCENE]
//! ```
//!
//! A reservoir keeps one sample, whose target is averaged over all that were merged into it; what else its colour has, its hue, is not. And light that is found in fewer than
//! one of the paths that a reservoir stands for is not averaged at all: it shines seldom, and then in many pixels and frames.

use aquifer_tests::error_parts::{Frame, SEEDS, of_each_scene};
use serde_json::json;

/// The pass that colours, frames before the one that is measured.
const GRAPHS: [(&str, &str, u32); 4] = [
    ("path_tracer_indirect", "path_tracer", 0),
    ("restir_gi_unbiased", "shade", 32),
    ("restir_gi_tuned", "shade", 32),
    ("restir_gi", "shade", 32),
];

fn main() {
    of_each_scene("error_parts", |name, measure, evidence| {
        let mut one_path = None;
        for (graph, pass, warm_up) in GRAPHS {
            let error = measure(Frame { graph, pass, warm_up, settings: &[] });
            let (its_error, its_rays) = *one_path.get_or_insert((error.mse, error.rays_a_pixel));
            let found = json!({
                "seeds": SEEDS, "MSE": error.mse, "rays a pixel": error.rays_a_pixel, "share of hue": error.hue, "share of few pixels": error.few,
                "lower error": its_error / error.mse, "more rays": error.rays_a_pixel / its_rays,
            });
            eprintln!("{name}, {graph}: {found}");
            evidence.put(json!({ "scene": name, "graph": graph, "transport": "indirect:2" }), found);
        }
    });
}
