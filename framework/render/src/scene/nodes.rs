//! Hierarchies as `scene/hierarchy` reads them: a texel a child, its box in 16 bits a plane on the grid of the whole hierarchy.

use super::mirror::NONE;
use aquifer_scene::{Bvh, BvhNode};

/// `scene/hierarchy::LEAF`.
const LEAF: u32 = 1 << 31;

/// The highest plane of a grid.
const LAST: f64 = 65535.0;

/// Both children of an inner node: words of their planes by axis, the lower in the low half, and what they are.
pub type Pair = [[u32; 4]; 2];

/// A hierarchy whose inner nodes and primitives stand among those of others.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    pub bvh: &'a Bvh,
    pub first_node: u32,
    pub first_primitive: u32,
}

/// Plane q of an axis lies at `low + q · step`.
struct Grid {
    low: [f32; 3],
    step: [f32; 3],
}

impl Placed<'_> {
    /// Where it begins: origin of the grid and reference to the root, steps of the grid.
    pub fn root(&self) -> Pair {
        let Grid { low, step } = self.grid();
        let [low, step] = [low, step].map(|v| v.map(f32::to_bits));
        let root = self.bvh.nodes.first().map_or(NONE, |node| self.reference(node));
        [[low[0], low[1], low[2], root], [step[0], step[1], step[2], 0]]
    }

    /// Its inner nodes. Children stand side by side behind the root, so that each pair of nodes is one record.
    pub fn pairs(&self) -> Vec<Pair> {
        let grid = self.grid();
        let child = |node: &BvhNode| {
            let planes = |axis: usize| grid.below(axis, node.min[axis]) | grid.above(axis, node.max[axis]) << 16;
            [planes(0), planes(1), planes(2), self.reference(node)]
        };
        self.bvh.nodes.get(1..).unwrap_or_default().chunks_exact(2).map(|both| [child(&both[0]), child(&both[1])]).collect()
    }

    fn reference(&self, node: &BvhNode) -> u32 {
        match node.count {
            0 => self.first_node + (node.first - 1) / 2,
            count => LEAF | (count - 1) << 28 | (self.first_primitive + node.first),
        }
    }

    fn grid(&self) -> Grid {
        let Some(root) = self.bvh.nodes.first() else { return Grid { low: [0.0; 3], step: [0.0; 3] } };
        // Up to the next float, so that the last plane is not below the box.
        let step = [0, 1, 2].map(|axis| (((f64::from(root.max[axis]) - f64::from(root.min[axis])) / LAST) as f32).next_up());
        Grid { low: root.min, step }
    }
}

impl Grid {
    fn below(&self, axis: usize, at: f32) -> u32 {
        self.place(axis, at).floor().clamp(0.0, LAST) as u32
    }

    fn above(&self, axis: usize, at: f32) -> u32 {
        self.place(axis, at).ceil().clamp(0.0, LAST) as u32
    }

    fn place(&self, axis: usize, at: f32) -> f64 {
        (f64::from(at) - f64::from(self.low[axis])) / f64::from(self.step[axis])
    }
}

/// The upper hierarchy: where it begins, then its inner nodes.
pub fn upper(bvh: &Bvh) -> Vec<Pair> {
    let placed = Placed { bvh, first_node: 1, first_primitive: 0 };
    std::iter::once(placed.root()).chain(placed.pairs()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_on_the_grid_hold_the_boxes() {
        // Corners of ever other sizes within the root's box, from a low-discrepancy sequence.
        let at = |i: u32, axis: usize| ((f64::from(i) * [0.754_877_67, 0.569_840_29, 0.438_579_51][axis]).fract() * 40.0 - 7.0) as f32;
        let node = |i: u32| {
            let (a, b) = ([0, 1, 2].map(|axis| at(2 * i, axis)), [0, 1, 2].map(|axis| at(2 * i + 1, axis)));
            let [min, max] = [f32::min, f32::max].map(|pick: fn(f32, f32) -> f32| [0, 1, 2].map(|axis| pick(a[axis], b[axis])));
            BvhNode { min, first: i, max, count: 1 }
        };
        let root = BvhNode { min: [-7.0; 3], first: 1, max: [33.0; 3], count: 0 };
        let bvh = Bvh { nodes: std::iter::once(root).chain((0..1000).map(node)).collect(), depth: 2 };
        let placed = Placed { bvh: &bvh, first_node: 0, first_primitive: 0 };
        let (grid, pairs) = (placed.grid(), placed.pairs());
        for (node, child) in bvh.nodes[1..].iter().zip(pairs.as_flattened()) {
            for (axis, planes) in child[..3].iter().enumerate() {
                let step = f64::from(grid.step[axis]);
                let plane = |q: u32| f64::from(grid.low[axis]) + f64::from(q) * step;
                let (low, high) = (plane(planes & 0xffff), plane(planes >> 16));
                let (min, max) = (f64::from(node.min[axis]), f64::from(node.max[axis]));
                assert!(low <= min && min - low < 1.001 * step, "{low} {min}");
                assert!(max <= high && high - max < 1.001 * step, "{max} {high}");
            }
        }
    }
}
