//! Smooth normals from triangles.

use glam::Vec3;

/// At each vertex the mean of the normals of the triangles that share it, weighted by area; straight up where there are none.
pub(super) fn smooth_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        let weighted = (b - a).cross(c - a);
        for index in triangle {
            sums[*index as usize] += weighted;
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or(Vec3::Y)).collect()
}
