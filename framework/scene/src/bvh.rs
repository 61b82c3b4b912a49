//! One level of the bounding volume hierarchy: nodes as the GPU reads them, built by obvhs.

use crate::Mesh;
use bytemuck::{Pod, Zeroable};
use glam::Vec3A;
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, leaf_collapser::collapse, reinsertion::ReinsertionOptimizer},
    ploc::PlocBuilder,
};

/// A node, 32 bytes, as shaders read it. The root is node 0; the two children of an inner node stand side by side.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BvhNode {
    /// Lower corner of the box.
    pub min: [f32; 3],
    /// Inner: index of the left child, the right one follows it. Leaf: index of the first primitive.
    pub first: u32,
    /// Upper corner of the box.
    pub max: [f32; 3],
    /// Inner: 0. Leaf: how many primitives.
    pub count: u32,
}

/// A binary hierarchy. Of a mesh: primitives are triangles, in leaf order. Of a [`crate::Tlas`]: instances, one a leaf.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    /// Node 0 is the root; empty when there are no primitives. Children come after their parent.
    pub nodes: Vec<BvhNode>,
    /// Nodes on the longest way from the root to a leaf, both counted. Descending into the near child and keeping the far one needs
    /// a stack of `depth - 1` entries.
    pub depth: u32,
}

/// How carefully to build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BvhQuality {
    /// obvhs's `very_fast_build`: for what is rebuilt every frame.
    Fast,
    /// obvhs's `medium_build`: about Embree's build time, faster to traverse.
    Medium,
    /// obvhs's `very_slow_build` without its spatial splits, which would put a triangle into several leaves.
    Slow,
}

/// How to build the hierarchies of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BvhOptions {
    /// Most triangles in a leaf, 1 to 8: shaders count them in 3 bits.
    pub max_leaf: u32,
    /// Build time against traversal time.
    pub quality: BvhQuality,
}

impl Default for BvhOptions {
    fn default() -> Self {
        Self { max_leaf: 4, quality: BvhQuality::Medium }
    }
}

impl BvhQuality {
    fn params(self) -> BvhBuildParams {
        match self {
            BvhQuality::Fast => BvhBuildParams::very_fast_build(),
            BvhQuality::Medium => BvhBuildParams::medium_build(),
            BvhQuality::Slow => BvhBuildParams { pre_split: false, ..BvhBuildParams::very_slow_build() },
        }
    }
}

impl Bvh {
    /// Builds over finite boxes, and gives the order of the leaves: `order[new] = old`. Deterministic.
    pub fn build(boxes: &[Aabb], options: &BvhOptions) -> (Bvh, Vec<u32>) {
        if boxes.is_empty() {
            return (Bvh::default(), Vec::new());
        }
        flatten(&build_tree(boxes, options))
    }

    /// Over the triangles of a mesh.
    pub fn of(mesh: &Mesh, options: &BvhOptions) -> (Bvh, Vec<u32>) {
        Bvh::build(&triangle_boxes(mesh), options)
    }

    /// The root's box, or `None` when there are no primitives.
    pub fn bounds(&self) -> Option<Aabb> {
        self.nodes.first().map(BvhNode::aabb)
    }

    /// The same hierarchy in obvhs's terms, for its traversal on the CPU. Primitive indices are those of the leaves.
    pub(crate) fn to_obvhs(&self) -> Bvh2 {
        let nodes = self.nodes.iter().map(|node| obvhs::bvh2::node::Bvh2Node::new(node.aabb(), node.count, node.first));
        Bvh2 { nodes: nodes.collect(), max_depth: self.depth as usize, children_are_ordered_after_parents: true, ..Bvh2::default() }
    }
}

impl BvhNode {
    /// Its box.
    pub fn aabb(&self) -> Aabb {
        Aabb::new(Vec3A::from_array(self.min), Vec3A::from_array(self.max))
    }

    fn new(aabb: &Aabb, first: u32, count: u32) -> Self {
        Self { min: aabb.min.to_array(), first, max: aabb.max.to_array(), count }
    }
}

/// The steps of `obvhs::bvh2::builder::build_bvh2`, without its validation, which takes longer than the build.
pub(crate) fn build_tree(boxes: &[Aabb], options: &BvhOptions) -> Bvh2 {
    let params = options.quality.params();
    let indices = (0..boxes.len() as u32).collect();
    let mut tree = PlocBuilder::with_capacity(boxes.len()).build(
        params.ploc_search_distance,
        boxes,
        indices,
        params.sort_precision,
        params.search_depth_threshold,
    );
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut tree, params.reinsertion_batch_ratio, None);
    collapse(&mut tree, options.max_leaf.clamp(1, 8), params.collapse_traversal_cost);
    let second_pass = params.reinsertion_batch_ratio * params.post_collapse_reinsertion_batch_ratio_multiplier;
    optimizer.run(&mut tree, second_pass, None);
    tree
}

/// Copies the tree depth first, left before right, and numbers the primitives as their leaves are met: neighbours in space become
/// neighbours in memory, and the real depth shows.
fn flatten(tree: &Bvh2) -> (Bvh, Vec<u32>) {
    let mut bvh = Bvh { nodes: Vec::with_capacity(tree.nodes.len()), depth: 0 };
    let mut order = Vec::with_capacity(tree.primitive_indices.len());
    bvh.nodes.push(BvhNode::default());
    let mut stack = vec![(0_usize, 0_usize, 1_u32)];
    while let Some((from, to, level)) = stack.pop() {
        let node = &tree.nodes[from];
        bvh.depth = bvh.depth.max(level);
        if node.is_leaf() {
            let first = node.first_index as usize;
            bvh.nodes[to] = BvhNode::new(node.aabb(), order.len() as u32, node.prim_count);
            order.extend_from_slice(&tree.primitive_indices[first..first + node.prim_count as usize]);
        } else {
            let (left, child) = (bvh.nodes.len(), node.first_index as usize);
            bvh.nodes[to] = BvhNode::new(node.aabb(), left as u32, 0);
            bvh.nodes.extend([BvhNode::default(); 2]);
            stack.push((child + 1, left + 1, level + 1));
            stack.push((child, left, level + 1));
        }
    }
    (bvh, order)
}

/// Boxes of a mesh's triangles.
pub(crate) fn triangle_boxes(mesh: &Mesh) -> Vec<Aabb> {
    let triangle = |index| padded(Aabb::from_points(&mesh.corners(index).map(Into::into)));
    (0..mesh.triangles.len()).map(triangle).collect()
}

/// Grows a box by a few units in the last place, so that the rounding of slab tests and transforms cannot lose what lies on its faces.
pub(crate) fn padded(aabb: Aabb) -> Aabb {
    let reach = aabb.min.abs().max(aabb.max.abs()).max_element();
    let margin = Vec3A::splat((reach * 4.0 * f32::EPSILON).max(f32::MIN_POSITIVE));
    Aabb::new(aabb.min - margin, aabb.max + margin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3a;

    fn boxes(count: u32) -> Vec<Aabb> {
        let place = |i: u32| vec3a((i % 7) as f32, (i / 7 % 5) as f32, (i / 35) as f32);
        (0..count).map(|i| Aabb::new(place(i), place(i) + Vec3A::splat(0.8))).collect()
    }

    fn check(bvh: &Bvh, order: &[u32], boxes: &[Aabb], max_leaf: u32) {
        let mut met = vec![0; boxes.len()];
        let mut deepest = 0;
        let mut stack = vec![(0, 1)];
        while let Some((index, level)) = stack.pop() {
            let node = &bvh.nodes[index as usize];
            deepest = deepest.max(level);
            if node.count == 0 {
                for child in [node.first, node.first + 1] {
                    assert!(child > index, "children come after their parent");
                    assert_eq!(node.aabb().union(&bvh.nodes[child as usize].aabb()), node.aabb());
                    stack.push((child, level + 1));
                }
            }
            assert!(node.count <= max_leaf);
            for primitive in node.first..node.first + node.count {
                let old = order[primitive as usize] as usize;
                met[old] += 1;
                assert_eq!(node.aabb().union(&boxes[old]), node.aabb());
            }
        }
        assert!(met.iter().all(|&count| count == 1), "every primitive is in one leaf");
        assert_eq!(deepest, bvh.depth);
    }

    #[test]
    fn every_primitive_is_in_one_leaf_that_holds_it() {
        for count in [1, 2, 3, 5, 9, 64, 700] {
            for max_leaf in [1, 4] {
                for quality in [BvhQuality::Fast, BvhQuality::Medium, BvhQuality::Slow] {
                    let boxes = boxes(count);
                    let (bvh, order) = Bvh::build(&boxes, &BvhOptions { max_leaf, quality });
                    check(&bvh, &order, &boxes, max_leaf);
                }
            }
        }
    }

    #[test]
    fn equal_and_flat_boxes_are_no_trouble() {
        let same = vec![Aabb::new(Vec3A::ONE, Vec3A::ONE); 33];
        let (bvh, order) = Bvh::build(&same, &BvhOptions::default());
        check(&bvh, &order, &same, 4);
    }

    #[test]
    fn nothing_gives_no_nodes() {
        assert_eq!(Bvh::build(&[], &BvhOptions::default()), (Bvh::default(), Vec::new()));
    }

    #[test]
    fn twice_the_same() {
        let boxes = boxes(5000);
        assert_eq!(Bvh::build(&boxes, &BvhOptions::default()), Bvh::build(&boxes, &BvhOptions::default()));
    }
}
