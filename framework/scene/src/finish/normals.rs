//! Shading normals for every vertex.

use crate::{Mesh, unit};
use glam::Vec3;

/// Gives every triangle three vertices of its own with its geometric normal. glTF 2.0, 3.7.2.1: without normals, flat ones must be
/// calculated, and given tangents ignored.
pub(super) fn flatten(mesh: &mut Mesh) {
    mesh.tangents.clear();
    let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    mesh.normals = (0..mesh.triangles.len()).flat_map(|index| [mesh.geometric_normal(index); 3]).collect();
    mesh.gather(&corners);
    for (index, triangle) in mesh.triangles.iter_mut().enumerate() {
        *triangle = [0, 1, 2].map(|corner| index as u32 * 3 + corner);
    }
}

/// Makes normals unit; one that has no direction takes that of the first triangle that uses it. Gives the number of those.
pub(super) fn repair(mesh: &mut Mesh) -> usize {
    let mut broken = vec![false; mesh.normals.len()];
    for (normal, broken) in mesh.normals.iter_mut().zip(&mut broken) {
        let direction = unit::direction(*normal);
        (*broken, *normal) = (direction.is_none(), direction.unwrap_or(Vec3::Z));
    }
    if !broken.contains(&true) {
        return 0;
    }
    let mut repaired = 0;
    for index in 0..mesh.triangles.len() {
        for corner in mesh.triangles[index].map(|corner| corner as usize) {
            if std::mem::take(&mut broken[corner]) {
                mesh.normals[corner] = mesh.geometric_normal(index);
                repaired += 1;
            }
        }
    }
    repaired
}
