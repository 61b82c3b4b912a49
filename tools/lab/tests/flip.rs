//! FLIP against the authors' own program: `flip.json` was made by `flip.py`, which draws the same images.

use aquifer_lab::{
    film::Film,
    metrics::{FlipMap, flip_hdr, flip_ldr},
    stats::rng::SplitMix,
};
use serde_json::Value;

/// Largest difference of means that both programs' 32-bit arithmetic explains.
const TOLERANCE: f64 = 1e-5;

/// 24 bits, so that every value is exact.
fn uniform(rng: &mut SplitMix) -> f64 {
    (rng.bits() >> 40) as f64 / f64::from(1 << 24)
}

/// Blocks of flat colour, with noise on every pixel, and every block a whole number of stops brighter or darker.
fn picture(size: [u32; 2], recipe: &Value) -> Film {
    let number = |key: &str| recipe[key].as_f64().expect("a number");
    let (mut rng, noise, stops) = (SplitMix::new(number("seed") as u64), number("noise"), number("stops") as i64);
    let [across, down] = size.map(|side| side.div_ceil(8) as usize);
    let color: Vec<[f32; 3]> = (0..across * down).map(|_| [0; 3].map(|_| uniform(&mut rng) as f32)).collect();
    let scale: Vec<f32> = color.iter().map(|_| (((rng.bits() % (2 * stops as u64 + 1)) as i64 - stops) as f32).exp2()).collect();
    let pixels = (0..size[1] as usize).flat_map(|y| (0..size[0] as usize).map(move |x| y / 8 * across + x / 8));
    let pixels = pixels.map(|block| [0, 1, 2].map(|c| scale[block] * (color[block][c] + (noise * uniform(&mut rng)) as f32)));
    Film::new(size, pixels.collect()).expect("a pixel for every place")
}

fn mean(map: &FlipMap) -> f64 {
    map.errors.iter().map(|&error| f64::from(error)).sum::<f64>() / map.errors.len() as f64
}

#[test]
fn means_are_those_of_the_authors() {
    let expected: Value = serde_json::from_str(include_str!("flip.json")).expect("JSON");
    let cases = expected["cases"].as_array().expect("a list");
    assert!(cases.iter().any(|case| case["range"] == "LDR") && cases.iter().any(|case| case["range"] == "HDR"));
    for case in cases {
        let size = [0, 1].map(|i| case["size"][i].as_u64().expect("a side") as u32);
        let [image, reference] = ["image", "reference"].map(|part| picture(size, &case[part]));
        let map = match case["range"].as_str() {
            Some("HDR") => flip_hdr(&image, &reference).expect("equal sizes").expect("a lit reference"),
            _ => flip_ldr(&image, &reference).expect("equal sizes"),
        };
        let theirs = case["mean"].as_f64().expect("a number");
        assert!((mean(&map) - theirs).abs() < TOLERANCE, "{} {theirs}\n{case}", mean(&map));
    }
}
