//! What the choices of `restir_gi_unbiased` that the paper does not have bring: its square error without each, and its rays.
//!
//! ```text
//! cargo run -p aquifer-tests --example gi_choices -- FILE COMMIT DATE [SCENE]
//! ```

use aquifer_tests::error_parts::{Frame, SEEDS, of_each_scene};
use serde_json::json;

/// In words, and as settings.
const WITHOUT: [(&str, &[&str]); 5] = [
    ("luminances as targets", &["slots.magnitude=luminance"]),
    ("what is kept is shaded", &["spatial.slots.shading=kept", "shade.in.light=false"]),
    ("one path a pixel", &["initial.candidates=1"]),
    ("three neighbours", &["spatial.taps=3"]),
    (
        "all four",
        &["slots.magnitude=luminance", "spatial.slots.shading=kept", "shade.in.light=false", "initial.candidates=1", "spatial.taps=3"],
    ),
];

fn main() {
    of_each_scene("gi_choices", |name, measure, evidence| {
        let frame = Frame { graph: "restir_gi_unbiased", pass: "shade", warm_up: 32, settings: &[] };
        let chosen = measure(frame);
        for (what, settings) in WITHOUT {
            let other = measure(Frame { settings, ..frame });
            let found = json!({
                "settings": settings, "seeds": SEEDS, "MSE": other.mse, "rays a pixel": other.rays_a_pixel,
                "times the error": other.mse / chosen.mse, "times the rays": other.rays_a_pixel / chosen.rays_a_pixel,
            });
            eprintln!("{name}, {what}: {found}");
            evidence.put(json!({ "scene": name, "instead": what }), found);
        }
    });
}
