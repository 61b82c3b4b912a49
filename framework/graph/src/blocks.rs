//! Memory sharing: transients that are never alive together lie in one block.

use crate::{Life, Plan};
use serde::Serialize;

/// Which memory each resource lies in, for one image size.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Blocks {
    /// Bytes of each block: those of the largest resource in it.
    pub sizes: Vec<u64>,
    /// The block of each resource of the plan; `None` for resources that share with nobody: history and outputs.
    pub of: Vec<Option<usize>>,
    /// What the transients would need without sharing.
    pub unshared: u64,
}

impl Blocks {
    /// Bytes of all blocks together.
    pub fn total(&self) -> u64 {
        self.sizes.iter().sum()
    }
}

impl Plan {
    /// Shares memory among the transients for an image of `size` pixels: the largest first, each into the first block that is free for all
    /// of its life. A block is one buffer: wgpu forbids a buffer to be read and written by one dispatch, so parts of one would not do.
    pub fn blocks(&self, size: [u32; 2]) -> Blocks {
        let mut transients: Vec<(usize, u64, (usize, usize))> = self.transients(size).collect();
        transients.sort_by_key(|&(index, bytes, _)| (std::cmp::Reverse(bytes), index));
        let mut blocks = Blocks { of: vec![None; self.resources.len()], ..Blocks::default() };
        let mut lives: Vec<Vec<(usize, usize)>> = Vec::new();
        for (index, bytes, life) in transients {
            let block = lives.iter().position(|others| others.iter().all(|&other| are_apart(other, life))).unwrap_or_else(|| {
                lives.push(Vec::new());
                blocks.sizes.push(bytes);
                lives.len() - 1
            });
            lives[block].push(life);
            blocks.of[index] = Some(block);
            blocks.unshared += bytes;
        }
        blocks
    }

    fn transients(&self, size: [u32; 2]) -> impl Iterator<Item = (usize, u64, (usize, usize))> {
        self.resources.iter().enumerate().filter_map(move |(index, resource)| match resource.life {
            Life::Transient { first, last } => Some((index, resource.bytes(size), (first, last))),
            Life::History | Life::Output => None,
        })
    }
}

/// One ends before the other begins.
fn are_apart(a: (usize, usize), b: (usize, usize)) -> bool {
    a.1 < b.0 || b.1 < a.0
}
