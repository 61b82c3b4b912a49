//! What the choices of `restir_gi_unbiased` that the paper does not have bring: its square error without each, and its rays.
//!
//! ```text
//! cargo run -p aquifer-tests --example gi_choices -- FILE COMMIT DATE [SCENE]
//! ```

use aquifer_tests::{
    context,
    error_parts::{Frame, SEEDS, measure, reference},
    evidence::Evidence,
    scene,
};
use serde_json::json;

const SCENES: [&str; 6] = ["sunlit_wall", "door_ajar", "cornell", "sun_room", "glossy", "animated"];
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
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, commit, date, only @ ..] = &arguments[..] else {
        eprintln!("gi_choices FILE COMMIT DATE [SCENE]");
        std::process::exit(2);
    };
    let Some(context) = context() else { std::process::exit(75) };
    let mut evidence = Evidence::open(file, commit, date, &context);
    for name in SCENES.into_iter().filter(|name| only.is_empty() || only.iter().any(|it| it == name)) {
        let scene = scene(name);
        let reference = reference(&context, &scene, name);
        let frame = Frame { graph: "restir_gi_unbiased", pass: "shade", warm_up: 32, settings: &[] };
        let chosen = measure(&context, &scene, name, frame, &reference);
        for (what, settings) in WITHOUT {
            let other = measure(&context, &scene, name, Frame { settings, ..frame }, &reference);
            let found = json!({
                "settings": settings, "seeds": SEEDS, "MSE": other.mse, "rays a pixel": other.rays_a_pixel,
                "times the error": other.mse / chosen.mse, "times the rays": other.rays_a_pixel / chosen.rays_a_pixel,
            });
            eprintln!("{name}, {what}: {found}");
            evidence.put(json!({ "scene": name, "instead": what }), found);
        }
    }
}
