//! Questions to meshes and materials, and the one way to reorder vertices.

use crate::{Material, Mesh, TextureRef, unit};
use glam::Vec3;

impl Mesh {
    /// Object-space corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    /// Unit normal of the front side, in object space; +Z for a triangle without area.
    pub fn geometric_normal(&self, triangle: usize) -> Vec3 {
        let [a, b, c] = self.corners(triangle);
        unit::direction((b - a).cross(c - a)).unwrap_or(Vec3::Z)
    }

    /// New vertex `i` is old vertex `sources[i]`, in positions, texture coordinates and colours. Normals, tangents and triangles are
    /// left to the caller, who is making them.
    pub(crate) fn gather(&mut self, sources: &[u32]) {
        pick(&mut self.positions, sources);
        self.uvs.iter_mut().for_each(|uvs| pick(uvs, sources));
        pick(&mut self.colors, sources);
    }
}

fn pick<T: Copy>(values: &mut Vec<T>, sources: &[u32]) {
    if !values.is_empty() {
        *values = sources.iter().map(|&source| values[source as usize]).collect();
    }
}

impl Material {
    /// Every texture it uses.
    pub fn textures(&self) -> impl Iterator<Item = &TextureRef> {
        [&self.base_color_texture, &self.metallic_roughness_texture, &self.emission_texture, &self.normal_texture].into_iter().flatten()
    }

    /// Its surface gives off light. Unlit surfaces are shown, but light nothing.
    pub fn emits(&self) -> bool {
        !self.unlit && self.emission.max_element() > 0.0
    }
}
