//! Which triangles can be hit and shaded at all.

use crate::Mesh;
use glam::{DVec3, Vec3};

/// A triangle whose height is below this share of its longest edge is a line to 32-bit positions: rounding decides which side is
/// the front.
const SLIVER: f64 = 1e-7;

/// Drops what has no usable area, with its material; gives the number.
pub(super) fn drop_degenerate(mesh: &mut Mesh) -> usize {
    let keep: Vec<bool> = (0..mesh.triangles.len()).map(|index| is_usable(mesh.corners(index))).collect();
    let mut kept = keep.iter();
    mesh.triangles.retain(|_| kept.next().copied().unwrap_or(true));
    let mut kept = keep.iter();
    mesh.materials.retain(|_| kept.next().copied().unwrap_or(true));
    keep.iter().filter(|&&keep| !keep).count()
}

/// Finite, no sliver, and of a size whose normal 32-bit arithmetic can normalise (about 10⁻⁹ to 10⁹ metres across).
fn is_usable(corners: [Vec3; 3]) -> bool {
    let [a, b, c]: [DVec3; 3] = corners.map(Vec3::as_dvec3);
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let twice_area = (b - a).cross(c - a).length();
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    // NaN fails the comparison.
    twice_area > SLIVER * longest && normal.length_squared().is_normal()
}
