//! The toy domain: its pixels, their integrals, and rigs that run shaders of the tree on it.

use aquifer_lab::stats::{Difference, Moments};
use aquifer_render::{Context, Renderer, View};
use aquifer_scene::{Channel, Interpolation, Scene, Track};
use aquifer_scenes::by_name;
use aquifer_tests::Parts;
use glam::Vec3;
use std::{fmt::Write, sync::Arc};

/// One pixel of the toy; see `toy.wgsl`.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    pub k: f64,
    /// In even and odd frames.
    pub support: [[f64; 2]; 2],
    pub alpha: f64,
    /// In even and odd frames.
    pub beta: [f64; 2],
    pub gamma: f64,
    pub dark: [f64; 2],
}

/// The first is the receiver of the tests of rules, the same in all frames; the fifth never sees anything: its reservoirs are always empty.
/// Halves hold all the numbers exactly: some travel in fields that a g-buffer keeps as such.
pub const PIXELS: [Pixel; 9] = [
    Pixel { k: 0.375, support: [[0.0625, 0.96875]; 2], alpha: 1.0, beta: [0.75, 0.75], gamma: 0.125, dark: [0.3125, 0.328125] },
    Pixel { k: 1.25, support: [[0.0, 0.75], [0.125, 0.875]], alpha: 1.25, beta: [-0.5, 0.25], gamma: -0.25, dark: [0.34375, 0.4375] },
    Pixel { k: 0.0, support: [[0.25, 1.0], [0.0, 0.8125]], alpha: 0.75, beta: [1.5, 0.5], gamma: 0.25, dark: [0.28125, 0.328125] },
    Pixel { k: 2.0, support: [[0.125, 0.875]; 2], alpha: 1.0, beta: [0.0, 1.0], gamma: 0.0, dark: [0.5, 0.5625] },
    Pixel { k: 0.25, support: [[2.0, 3.0]; 2], alpha: 1.0, beta: [0.0, 0.0], gamma: 0.0, dark: [0.0, 0.0] },
    Pixel { k: 0.75, support: [[0.375, 0.625], [0.4375, 1.0]], alpha: 2.0, beta: [1.0, 1.0], gamma: 0.5, dark: [0.0, 0.0] },
    Pixel { k: 0.125, support: [[0.0, 1.0]; 2], alpha: 0.5, beta: [2.0, 1.0], gamma: -0.25, dark: [0.625, 0.8125] },
    Pixel { k: 1.5, support: [[0.5, 1.0]; 2], alpha: 1.125, beta: [-0.5, 0.5], gamma: 0.25, dark: [0.875, 0.90625] },
    Pixel { k: 0.625, support: [[0.0, 0.96875], [0.0, 0.6875]], alpha: 0.875, beta: [0.875, 0.625], gamma: 0.125, dark: [0.1875, 0.3125] },
];

impl Pixel {
    /// What the pixel sees of the integrand: ∫ (α + β u) (1 + 2 k u) du over its support, less what is dark.
    pub fn integral(&self, frame: u32) -> f64 {
        let odd = (frame & 1) as usize;
        let (beta, support) = (self.beta[odd], self.support[odd]);
        let primitive = |u: f64| self.alpha * u + (beta / 2.0 + self.alpha * self.k) * u * u + 2.0 / 3.0 * beta * self.k * u.powi(3);
        let over = |[from, to]: [f64; 2]| primitive(to) - primitive(from);
        let [low, high] = support.map(|u| u.min(1.0));
        let dark = self.dark.map(|u| u.clamp(low, high));
        over([low, high]) - over(dark)
    }

    /// Its x in the world: between the camera's two places where the support is another from each, else to their right.
    fn place(&self) -> f64 {
        if self.support[0] == self.support[1] { 3.0 * JUMP } else { 0.5 * JUMP }
    }
}

/// The camera's x is 0 in even frames and this in odd ones.
const JUMP: f64 = 8.0;
/// Frames for which it jumps.
const FRAMES: u16 = 2048;

/// A scene whose camera jumps; what it sees is nothing to the toy.
fn jumping() -> Arc<Scene> {
    let mut scene = (by_name("cornell").expect("built in").make)();
    let camera = scene.nodes.iter().position(|node| node.camera.is_some()).expect("scenes have a camera");
    let place = |frame: u16| Vec3::X * f32::from(frame & 1) * JUMP as f32;
    let track = Track::Translation((0..FRAMES).map(place).collect());
    let times = (0..FRAMES).map(f32::from).collect();
    scene.animation.push(Channel { node: camera as u32, track, times, interpolation: Interpolation::Step });
    Arc::new(scene.finish().expect("built in"))
}

/// The domain's text, with the pixels in it.
pub fn domain() -> String {
    let mut table = String::new();
    for (i, pixel) in PIXELS.iter().enumerate() {
        let Pixel { k, support: [left, right], alpha, beta, gamma, dark } = pixel;
        let pair = |[a, b]: [f64; 2]| format!("vec2<f32>({a:?}, {b:?})");
        let [left, right, beta, dark] = [*left, *right, *beta, *dark].map(pair);
        let numbers = format!("{:?}, {k:?}, {left}, {right}, {alpha:?}, {beta}, {gamma:?}, {dark}", pixel.place());
        writeln!(table, "case {i}u: {{ return Toy({numbers}); }}").expect("a text takes all");
    }
    replaced(include_str!("toy.wgsl"), "// TABLE", &table)
}

/// The text with one part of it replaced.
pub fn replaced(text: &str, what: &str, by: &str) -> String {
    assert_eq!(text.matches(what).count(), 1, "`{what}` is once in the text");
    text.replace(what, by)
}

/// The text of a module of the tree.
pub fn module(path: &str) -> &'static str {
    aquifer_shaders::modules().into_iter().find(|(name, _)| name == path).unwrap_or_else(|| panic!("no module {path}")).1
}

/// A renderer of `graph` with the toy domain, and further modules over those of the tree.
pub fn renderer(context: &Context, graph: &str, shaders: &[(&str, &str)], keep: &[&str]) -> Renderer {
    sized(context, graph, shaders, keep, SIZE)
}

/// The same, of any size whose width nine divides.
pub fn sized(context: &Context, graph: &str, shaders: &[(&str, &str)], keep: &[&str], size: [u32; 2]) -> Renderer {
    let scene = jumping();
    let domain = domain();
    let mut all = vec![
        ("domain/toy", domain.as_str()),
        ("pass/toy_gbuffer", include_str!("toy_gbuffer.wgsl")),
        ("pass/combine", include_str!("combine.wgsl")),
    ];
    all.extend(shaders);
    let view = View { step: 1.0, ..View::default() };
    Parts { shaders: &all, size, keep, view, ..Parts::new(&scene, graph) }.renderer(context)
}

/// Nine pixels in a row.
pub const SIZE: [u32; 2] = [9 * 128, 256];

/// Most inputs of a rule.
pub const INPUTS: usize = PIXELS.len();

/// A `target_limit` that refuses many of the toy's shifts and leaves many others.
pub const LIMIT: &str = "set.target_limit = 1.5";

/// A graph that combines what `initial` makes of the toy by a rule, from this many candidates. What is added to it is of the pass `combine`.
pub fn graph(mis: &str, visibility: &str, candidates: u32) -> String {
    format!(
        "transport = 'direct'
output = 'combine.results'
slots = {{ domain = 'toy', mis = '{mis}', visibility = '{visibility}' }}
[pass.toy_gbuffer]
[pass.initial]
in.surface = 'toy_gbuffer.surface'
set.candidates = {candidates}
[pass.combine]
in.surface = 'toy_gbuffer.surface'
in.current = 'initial.reservoir'
in.previous_surface = 'toy_gbuffer.surface@prev'
in.history = 'initial.reservoir@prev'
"
    )
}

/// One frame: the results of all trials, for 1 to 9 inputs.
pub fn results(renderer: &mut Renderer) -> Vec<Vec<f64>> {
    renderer.frame().unwrap();
    let words = renderer.read_f32("combine.results").unwrap();
    words.chunks_exact(words.len() / INPUTS).map(|trials| trials.iter().map(|word| f64::from(*word)).collect()).collect()
}

/// f(Y) W for 1 to 9 inputs, over frames until `enough` says so.
pub fn estimates(renderer: &mut Renderer, mut enough: impl FnMut(&[Moments]) -> bool) -> Vec<Moments> {
    // The first frame has no history.
    results(renderer);
    let mut moments = vec![Moments::default(); INPUTS];
    loop {
        for (moments, trials) in moments.iter_mut().zip(results(renderer)) {
            *moments = moments.merged(trials.into_iter().collect());
        }
        if enough(&moments) {
            return moments;
        }
    }
}

/// From the closed form, in its units.
pub fn difference(moments: &Moments) -> Difference {
    let truth = PIXELS[0].integral(0);
    Difference::normal(moments.mean() - truth, moments.standard_error()).relative_to(truth)
}
