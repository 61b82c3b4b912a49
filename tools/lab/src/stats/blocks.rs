//! Do two images agree: as a whole, and block by block?
//!
//! A block is a square of pixels. Averaging over it makes noise small enough for a tight band, and the means close to normal. A block
//! counts only when it is *lit* (bright enough to matter) and *resolved* (its error is small against the band); when too few lit blocks
//! are resolved the verdict is "not resolved", never "passed".

mod compare;

pub use compare::{BlockComparison, BlockDifference, BlockTest, PlaneComparison, compare_blocks};

use super::{Estimate, Moments, SizesDiffer, same_size};
use crate::film::{Film, LUMINANCE, luminance};
use serde::{Deserialize, Serialize};

/// What is averaged over blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// Luminance. From per-channel variances its standard error can only be bounded from above (by channels that vary together, which is
    /// nearly true of rendered noise); the bound is used, so that resolution is never overstated.
    #[default]
    Luminance,
    /// Red, green and blue, each on its own.
    Channels,
}

impl Quantity {
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::Luminance => &["luminance"],
            Self::Channels => &["red", "green", "blue"],
        }
    }

    fn mean(self, plane: usize, color: [f32; 3]) -> f64 {
        match self {
            Self::Luminance => luminance(color.map(f64::from)),
            Self::Channels => f64::from(color[plane]),
        }
    }

    fn variance(self, plane: usize, variance: [f32; 3]) -> f64 {
        match self {
            Self::Luminance => {
                let errors = variance.map(|v| f64::from(v).sqrt());
                LUMINANCE.iter().zip(errors).map(|(weight, error)| weight * error).sum::<f64>().powi(2)
            }
            Self::Channels => f64::from(variance[plane]),
        }
    }
}

/// Means over blocks with their standard errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocks {
    grid: Grid,
    planes: Vec<Plane>,
}

/// One averaged quantity.
#[derive(Clone, Debug, PartialEq)]
struct Plane {
    name: &'static str,
    overall: Estimate,
    blocks: Vec<Estimate>,
}

impl Blocks {
    /// From one film. Its pixels must be independent: right for path tracing, wrong for anything that reuses samples of neighbours
    /// (use [`BlockMoments`] there). A film without variance counts as exact.
    pub fn of_film(film: &Film, side: u32, quantity: Quantity) -> Self {
        let grid = Grid::new(film.size, side);
        let plane = |(index, &name): (usize, &&'static str)| {
            let mean = |i: usize| quantity.mean(index, film.color[i]);
            let variance = |i: usize| film.variance.as_ref().map_or(0.0, |v| quantity.variance(index, v[i]));
            let estimate = |pixels: &[usize]| {
                let n = pixels.len() as f64;
                Estimate {
                    mean: pixels.iter().map(|&i| mean(i)).sum::<f64>() / n,
                    standard_error: pixels.iter().map(|&i| variance(i)).sum::<f64>().sqrt() / n,
                    freedom: f64::INFINITY,
                }
            };
            let all: Vec<usize> = (0..film.pixels()).collect();
            Plane { name, overall: estimate(&all), blocks: grid.pixels().iter().map(|pixels| estimate(pixels)).collect() }
        };
        Self { grid, planes: quantity.names().iter().enumerate().map(plane).collect() }
    }
}

/// Block means over independent renders, one a seed: right whatever the renders share within themselves.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct BlockMoments {
    grid: Grid,
    quantity: Quantity,
    /// For each plane: the whole, then every block.
    planes: Vec<(Moments, Vec<Moments>)>,
}

impl BlockMoments {
    /// Of nothing yet.
    pub fn new(size: [u32; 2], side: u32, quantity: Quantity) -> Self {
        let grid = Grid::new(size, side);
        let empty = (Moments::default(), vec![Moments::default(); grid.count()]);
        Self { grid, quantity, planes: vec![empty; quantity.names().len()] }
    }

    /// Adds one render.
    pub fn push(&mut self, film: &Film) -> Result<(), SizesDiffer> {
        same_size(self.grid.size, film.size)?;
        let means = Blocks::of_film(film, self.grid.side, self.quantity);
        for ((overall, blocks), plane) in self.planes.iter_mut().zip(means.planes) {
            overall.push(plane.overall.mean);
            blocks.iter_mut().zip(plane.blocks).for_each(|(moments, block)| moments.push(block.mean));
        }
        Ok(())
    }

    /// How many renders so far.
    pub fn count(&self) -> u64 {
        self.planes.first().map_or(0, |(overall, _)| overall.count())
    }

    /// Means and standard errors so far.
    pub fn blocks(&self) -> Blocks {
        let plane = |((overall, blocks), &name): (&(Moments, Vec<Moments>), &&'static str)| Plane {
            name,
            overall: overall.into(),
            blocks: blocks.iter().map(Estimate::from).collect(),
        };
        Blocks { grid: self.grid, planes: self.planes.iter().zip(self.quantity.names()).map(plane).collect() }
    }
}

/// How an image is cut into blocks; those at the right and lower edge may be smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Grid {
    size: [u32; 2],
    side: u32,
}

impl Grid {
    fn new(size: [u32; 2], side: u32) -> Self {
        Self { size, side: side.max(1) }
    }

    fn blocks(&self) -> [usize; 2] {
        self.size.map(|length| length.div_ceil(self.side) as usize)
    }

    fn count(&self) -> usize {
        self.blocks()[0] * self.blocks()[1]
    }

    /// Top left pixel of a block.
    fn corner(&self, block: usize) -> [u32; 2] {
        let across = self.blocks()[0].max(1);
        [(block % across) as u32 * self.side, (block / across) as u32 * self.side]
    }

    /// The pixels of every block.
    fn pixels(&self) -> Vec<Vec<usize>> {
        let across = self.blocks()[0];
        let mut pixels = vec![Vec::new(); self.count()];
        for y in 0..self.size[1] {
            for x in 0..self.size[0] {
                let block = (y / self.side) as usize * across + (x / self.side) as usize;
                pixels[block].push(y as usize * self.size[0] as usize + x as usize);
            }
        }
        pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_errors_by_hand() {
        let film =
            Film { variance: Some(vec![[0.04; 3], [0.12; 3], [1.0; 3]]), ..Film::new([3, 1], vec![[1.0; 3], [3.0; 3], [5.0; 3]]).unwrap() };
        for quantity in [Quantity::Luminance, Quantity::Channels] {
            let blocks = Blocks::of_film(&film, 2, quantity);
            let plane = &blocks.planes[0];
            assert_eq!(plane.blocks.len(), 2);
            assert!((plane.blocks[0].mean - 2.0).abs() < 1e-7 && (plane.blocks[0].standard_error - 0.2).abs() < 1e-7);
            assert!((plane.blocks[1].mean - 5.0).abs() < 1e-7 && (plane.blocks[1].standard_error - 1.0).abs() < 1e-7);
            assert!((plane.overall.standard_error - 1.16_f64.sqrt() / 3.0).abs() < 1e-7);
        }
    }

    #[test]
    fn edge_blocks_are_smaller() {
        let grid = Grid::new([10, 9], 8);
        assert_eq!(grid.blocks(), [2, 2]);
        assert_eq!(grid.pixels().iter().map(Vec::len).collect::<Vec<_>>(), [64, 16, 8, 2]);
        assert_eq!(grid.corner(3), [8, 8]);
    }

    #[test]
    fn renders_that_share_noise_within_themselves_have_a_large_error() {
        // Every pixel of a render has the same error: averaging over pixels must not make it look smaller.
        let mut moments = BlockMoments::new([8, 8], 8, Quantity::Luminance);
        for error in [-0.1_f32, 0.1, -0.1, 0.1] {
            moments.push(&Film::new([8, 8], vec![[1.0 + error; 3]; 64]).unwrap()).unwrap();
        }
        let block = moments.blocks().planes[0].blocks[0];
        assert!((block.mean - 1.0).abs() < 1e-6 && (block.standard_error - (0.04_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-6);
        assert_eq!(block.freedom, 3.0);
    }
}
