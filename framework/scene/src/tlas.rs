//! The upper level of the hierarchy: the instances of one moment.

use crate::{Bvh, BvhOptions, BvhQuality, Moment, Scene, bvh::padded};
use glam::{Affine3A, Vec3A};
use obvhs::aabb::Aabb;

/// Farther out, in metres, areas of boxes overflow 32-bit floats: what reaches there is not traced.
const REACH: f32 = 1e15;

/// Hierarchy over a [`Moment`]'s instances, rebuilt for every moment. Each leaf holds one instance: `first` is its index in
/// [`Moment::instances`]. In no leaf are instances of empty meshes, those squashed flat (no inverse transform), and those that reach
/// farther than 10¹⁵ metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tlas {
    /// The hierarchy.
    pub bvh: Bvh,
}

impl Tlas {
    /// Builds it for `moment` of the finished `scene`. Deterministic.
    pub fn build(scene: &Scene, moment: &Moment) -> Tlas {
        let mut placed = Vec::new();
        let mut boxes = Vec::new();
        for (index, instance) in moment.instances.iter().enumerate() {
            let Some(local) = scene.meshes[instance.mesh as usize].bvh.bounds() else { continue };
            let world = padded(transformed(&local, &instance.transform));
            if instance.is_solid() && within_reach(&world) {
                placed.push(index as u32);
                boxes.push(world);
            }
        }
        let (mut bvh, order) = Bvh::build(&boxes, &BvhOptions { max_leaf: 1, quality: BvhQuality::Fast });
        for leaf in bvh.nodes.iter_mut().filter(|node| node.count > 0) {
            leaf.first = placed[order[leaf.first as usize] as usize];
        }
        Tlas { bvh }
    }

    /// Box of everything that rays can hit, or `None` when there is nothing.
    pub fn bounds(&self) -> Option<Aabb> {
        self.bvh.bounds()
    }
}

/// False for NaN, too.
pub(crate) fn within_reach(aabb: &Aabb) -> bool {
    aabb.min.cmpgt(Vec3A::splat(-REACH)).all() && aabb.max.cmplt(Vec3A::splat(REACH)).all()
}

/// The box of a transformed box (Arvo, "Transforming axis-aligned bounding boxes", Graphics Gems, 1990).
pub(crate) fn transformed(aabb: &Aabb, transform: &Affine3A) -> Aabb {
    let centre = transform.transform_point3a(aabb.center());
    let half = aabb.diagonal() * 0.5;
    let matrix = &transform.matrix3;
    let reach: Vec3A = matrix.x_axis.abs() * half.x + matrix.y_axis.abs() * half.y + matrix.z_axis.abs() * half.z;
    Aabb::new(centre - reach, centre + reach)
}
