//! Does leaving out what a scene does not need change any bit of what is rendered?

use crate::{Kept, Parts};
use aquifer_lab::{
    film::Film,
    stats::{
        ensemble::Ensemble,
        pixels::{PixelTest, compare_pixels},
    },
};
use aquifer_render::{Context, View};
use aquifer_scene::Scene;
use std::sync::Arc;

/// Pixels of the images that are compared.
pub const SIZE: [u32; 2] = [32, 18];
/// Frames before what is compared: histories are in use by then.
pub const FRAMES: u32 = 3;
/// Seeds of the z-test.
const SEEDS: u64 = 32;

/// A resource whose bits differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Differs {
    /// The first in the order of execution.
    pub resource: String,
    /// Most units in the last place between two of its floats.
    pub ulps: u32,
}

/// A graph on a scene.
#[derive(Clone)]
pub struct Pair<'a> {
    /// A finished scene.
    pub scene: &'a Arc<Scene>,
    /// Text of a graph.
    pub graph: &'a str,
}

impl Pair<'_> {
    fn parts<'a>(&'a self, kept: Kept, keep: &'a [&'a str]) -> Parts<'a> {
        let view = View { step: 0.05, ..View::default() };
        Parts { size: SIZE, kept, keep, view, ..Parts::new(self.scene, self.graph) }
    }

    /// Everything that passes make for the scene, in order of execution, by name.
    fn resources(&self, context: &Context, kept: Kept, names: &[&str]) -> Vec<Vec<u8>> {
        let mut renderer = self.parts(kept, names).renderer(context);
        (0..FRAMES).for_each(|_| renderer.frame().unwrap_or_else(|error| panic!("{error}")));
        names.iter().map(|name| renderer.read(name).unwrap_or_else(|error| panic!("{error}"))).collect()
    }

    /// The first resource of the leanest plan that differs when more is kept.
    ///
    /// # Panics
    /// When anything is wrong: a test should not go on then.
    pub fn first_difference(&self, context: &Context, kept: Kept) -> Option<Differs> {
        let lean = self.parts(Kept::Needed, &[]).renderer(context);
        let names: Vec<String> = lean.plan().resources.iter().map(|resource| resource.name.clone()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let [lean, full] = [Kept::Needed, kept].map(|kept| self.resources(context, kept, &names));
        let differ = names.iter().zip(lean.iter().zip(&full)).find(|(_, (lean, full))| lean != full);
        differ.map(|(name, (lean, full))| Differs { resource: (*name).to_owned(), ulps: ulps(lean, full) })
    }

    /// Do the means of both ways agree, over seeds of their own?
    ///
    /// # Panics
    /// When anything is wrong.
    pub fn means_agree(&self, context: &Context, kept: Kept) -> bool {
        let film = |kept: Kept, first: u64| {
            let mut renderer = self.parts(kept, &[]).renderer(context);
            let mut mean = Ensemble::default();
            for seed in first..first + SEEDS {
                renderer.reseed(seed).unwrap_or_else(|error| panic!("{error}"));
                let color = crate::image(&mut renderer, FRAMES).iter().map(|c| [0, 1, 2].map(|i| c[i] as f32)).collect();
                mean.push(&Film::new(SIZE, color).expect("one colour a pixel")).expect("films of one size");
            }
            mean.film()
        };
        let (lean, full) = (film(Kept::Needed, 0), film(kept, SEEDS));
        compare_pixels(&lean, &full, [SEEDS; 2], &PixelTest::default()).expect("films of one size").passed
    }
}

/// Most steps from one float to the other, word by word; the bits of floats are in order.
fn ulps(a: &[u8], b: &[u8]) -> u32 {
    let ordered = |word: &[u8]| {
        let bits = i32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        if bits < 0 { i32::MIN.wrapping_sub(bits) } else { bits }
    };
    a.chunks_exact(4).zip(b.chunks_exact(4)).map(|(a, b)| ordered(a).abs_diff(ordered(b))).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_counted_across_zero() {
        let bytes = |value: f32| value.to_le_bytes();
        assert_eq!(ulps(&bytes(1.0), &bytes(1.0 + f32::EPSILON)), 1);
        assert_eq!(ulps(&bytes(-0.0), &bytes(0.0)), 0);
        assert_eq!(ulps(&bytes(-f32::from_bits(1)), &bytes(f32::from_bits(1))), 2);
    }
}
