//! One frame of a graph with history, over independent seeds: frames of one run share samples, so that no average over them is a test.

use crate::Parts;
use aquifer_lab::{
    film::Film,
    stats::{
        BlockTest, Blocks, Verdict,
        blocks::{BlockComparison, BlockMoments, Quantity},
        compare_blocks,
    },
};
use aquifer_render::{Context, Renderer, View};
use aquifer_scene::Scene;
use std::{ops::Range, sync::Arc, time::Instant};

/// Pixels on a side of a block.
pub const SIDE: u32 = 8;

/// A graph with a pass `shade`, as it is compared.
#[derive(Clone)]
pub struct Trial<'a> {
    /// A finished scene.
    pub scene: &'a Arc<Scene>,
    /// Text of a graph.
    pub graph: &'a str,
    /// `--set` texts.
    pub settings: &'a [&'a str],
    /// Modules over the built-in ones: (path, text).
    pub shaders: &'a [(&'a str, &'a str)],
    /// Camera and time.
    pub view: View,
    /// The frame that is compared; those before are its history.
    pub frame: u32,
    /// Most seeds.
    pub seeds: u64,
}

impl Trial<'_> {
    /// Adds seeds until the comparison of the pass `shade` is resolved or has failed, or all are spent.
    ///
    /// # Panics
    /// When anything is wrong.
    pub fn compare(&self, context: &Context, reference: &Blocks, test: &BlockTest) -> BlockComparison {
        let parts = Parts {
            settings: self.settings,
            shaders: self.shaders,
            keep: &["shade.color"],
            view: self.view.clone(),
            ..Parts::new(self.scene, self.graph)
        };
        let mut renderer = parts.renderer(context);
        let mut moments = BlockMoments::new(parts.size, SIDE, Quantity::Luminance);
        let begin = Instant::now();
        let mut count = 0;
        while count < self.seeds {
            add_seeds(&mut renderer, self.frame, count..count + 1, &mut moments);
            count += 1;
            let looks = count % 32 == 0 && count < self.seeds;
            if looks && compare_blocks(&moments.blocks(), reference, test).is_ok_and(|found| found.verdict != Verdict::NotResolved) {
                break;
            }
        }
        let found = compare_blocks(&moments.blocks(), reference, test).expect("grids of one size");
        eprintln!("{:?}, {count} seeds in {:.1?}: {found}", self.settings, begin.elapsed());
        found
    }
}

/// Adds what frame `frame` of the pass `shade` shows for each of these seeds.
///
/// # Panics
/// When the device fails, or the sizes differ.
pub fn add_seeds(renderer: &mut Renderer, frame: u32, seeds: Range<u64>, moments: &mut BlockMoments) {
    for seed in seeds {
        moments.push(&shaded(renderer, "shade.color", seed, frame)).expect("films of one size");
    }
}

/// What frame `frame` of this seed shows.
///
/// # Panics
/// When the device fails, or there is no such port.
pub fn shaded(renderer: &mut Renderer, port: &str, seed: u64, frame: u32) -> Film {
    renderer.reseed(seed).unwrap_or_else(|error| panic!("{error}"));
    (0..=frame).for_each(|_| renderer.frame().unwrap_or_else(|error| panic!("{error}")));
    film_of(renderer, port)
}

/// What the last frame shows.
///
/// # Panics
/// When the device fails, or there is no such port.
pub fn film_of(renderer: &mut Renderer, port: &str) -> Film {
    let words = renderer.read_f32(port).unwrap_or_else(|error| panic!("{error}"));
    let color = words.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    Film::new(renderer.options().size, color).expect("one colour a pixel")
}

/// Block means of the path tracer's image of light of one transport.
pub fn path_traced(context: &Context, scene: &Arc<Scene>, transport: &str, frames: u32, view: View) -> Blocks {
    let graph = format!("extends = 'path_tracer.toml'\ntransport = '{transport}'");
    Blocks::of_film(&path_traced_film(context, scene, &graph, frames, view), SIDE, Quantity::Luminance)
}

/// The image of a graph with a path tracer, 64×36, from `frames` frames of eight paths.
pub fn path_traced_film(context: &Context, scene: &Arc<Scene>, graph: &str, frames: u32, view: View) -> Film {
    path_traced_parts(scene, graph, view).film(context, frames)
}

/// What makes it: seeds that nothing else has.
pub fn path_traced_parts<'a>(scene: &'a Arc<Scene>, graph: &'a str, view: View) -> Parts<'a> {
    Parts { settings: &["path_tracer.samples=8"], seed: 1 << 40, view, ..Parts::new(scene, graph) }
}
