//! A mesh's hierarchy with eight children a node, compressed, for shaders.

use crate::{BvhOptions, BvhQuality, Mesh, bvh};
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;

/// Most triangles in a leaf that obvhs's nodes can count.
const MAX_LEAF: u32 = 3;

/// obvhs's `CwBvh` (Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs").
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WideBvh {
    /// obvhs's `CwBvhNode`s, 80 bytes each. Node 0 is the root; empty when there are no triangles.
    pub nodes: Vec<[u32; 20]>,
    /// Indices into [`Mesh::triangles`], in the order of the leaves.
    pub order: Vec<u32>,
}

impl WideBvh {
    /// Over the triangles of a finished mesh. Deterministic.
    pub fn of(mesh: &Mesh, quality: BvhQuality) -> WideBvh {
        let boxes = bvh::triangle_boxes(mesh);
        if boxes.is_empty() {
            return WideBvh::default();
        }
        // The conversion makes leaves itself, from leaves of one triangle.
        let tree = bvh::build_tree(&boxes, &BvhOptions { max_leaf: 1, quality });
        let wide = bvh2_to_cwbvh(&tree, MAX_LEAF, true, false);
        WideBvh { nodes: wide.nodes.iter().map(|node| bytemuck::cast(*node)).collect(), order: wide.primitive_indices }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn every_triangle_is_in_one_leaf() {
        for count in [0, 1, 2, 5, 300] {
            let corner = |i: u32| vec3((i % 7) as f32, (i / 7 % 5) as f32, (i / 35) as f32);
            let mesh = Mesh {
                positions: (0..count).flat_map(|i| [corner(i), corner(i) + vec3(0.5, 0.0, 0.1), corner(i) + vec3(0.0, 0.5, 0.2)]).collect(),
                triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
                ..Mesh::default()
            };
            let wide = WideBvh::of(&mesh, BvhQuality::Medium);
            let mut order = wide.order.clone();
            order.sort_unstable();
            assert!(order.into_iter().eq(0..count), "{count}");
            assert_eq!(wide.nodes.is_empty(), count == 0);
        }
    }
}
