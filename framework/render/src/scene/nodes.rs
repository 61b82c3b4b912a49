//! Hierarchies as `trace/bvh2` reads them: both children of an inner node in one record.

use super::mirror::NONE;
use aquifer_scene::{Bvh, BvhNode};
use bytemuck::{Pod, Zeroable};

/// `trace/bvh2::LEAF`.
const LEAF: u32 = 1 << 31;

/// A child: its box, and what it is.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Child {
    low: [f32; 3],
    reference: u32,
    high: [f32; 3],
    padding: u32,
}

/// An inner node.
pub type Pair = [Child; 2];

/// Reference to the root of a hierarchy whose inner nodes begin at `first_node`, and whose primitives at `first_primitive`.
pub fn root(bvh: &Bvh, first_node: u32, first_primitive: u32) -> u32 {
    bvh.nodes.first().map_or(NONE, |node| reference(node, first_node, first_primitive))
}

/// Its inner nodes. Children stand side by side behind the root, so that each pair of nodes is one record.
pub fn pairs(bvh: &Bvh, first_node: u32, first_primitive: u32) -> impl Iterator<Item = Pair> {
    let child =
        move |node: &BvhNode| Child { low: node.min, reference: reference(node, first_node, first_primitive), high: node.max, padding: 0 };
    bvh.nodes.get(1..).unwrap_or_default().chunks_exact(2).map(move |both| [child(&both[0]), child(&both[1])])
}

fn reference(node: &BvhNode, first_node: u32, first_primitive: u32) -> u32 {
    match node.count {
        0 => first_node + (node.first - 1) / 2,
        count => LEAF | (count - 1) << 28 | (first_primitive + node.first),
    }
}

/// The upper hierarchy: a reference to its root, then its inner nodes.
pub fn upper(bvh: &Bvh) -> Vec<Pair> {
    let head = Child { low: [f32::from_bits(root(bvh, 1, 0)), 0.0, 0.0], ..Child::default() };
    std::iter::once([head, Child::default()]).chain(pairs(bvh, 1, 0)).collect()
}
