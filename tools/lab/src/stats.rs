//! What differences mean.
//!
//! Conventions: p-values are probabilities under the null hypothesis, significance levels are called `alpha`, a *band* is the largest
//! difference that counts as none, and a standard error is the square root of a variance *of a mean*.

pub mod blocks;
pub mod bootstrap;
pub mod chi_square;
pub mod difference;
pub mod ensemble;
pub mod error;
pub mod moments;
pub mod multiple;
pub mod pixels;
pub mod rank_sum;
pub mod rng;

pub use blocks::{BlockTest, Blocks, compare_blocks};
pub use difference::{Difference, Estimate, Rule, Verdict};
pub use moments::Moments;
pub use rank_sum::rank_sum;

/// Two images that should be compared have different sizes.
#[derive(Clone, Copy, Debug, thiserror::Error, PartialEq, Eq)]
#[error("images of {}×{} and {}×{} cannot be compared", .0[0], .0[1], .1[0], .1[1])]
pub struct SizesDiffer(pub [u32; 2], pub [u32; 2]);

/// Checks that two images can be compared pixel by pixel.
pub(crate) fn same_size(a: [u32; 2], b: [u32; 2]) -> Result<(), SizesDiffer> {
    if a == b { Ok(()) } else { Err(SizesDiffer(a, b)) }
}
