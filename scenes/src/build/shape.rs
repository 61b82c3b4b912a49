//! Flat-sided shapes, and the mesh they gather in.

use super::normals::smooth_normals;
use aquifer_scene::Mesh;
use glam::{Affine3A, Vec2, Vec3};

/// A mesh in the making: each call adds triangles of one material. Front faces point outward.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    mesh: Mesh,
}

impl Shape {
    /// An empty shape.
    pub fn new(name: &str) -> Self {
        Self { mesh: Mesh { name: name.into(), ..Mesh::default() } }
    }

    /// The finished mesh.
    pub fn into_mesh(self) -> Mesh {
        self.mesh
    }

    /// How many triangles there are so far.
    pub fn triangle_count(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// Adds a vertex and returns its index.
    pub fn vertex(&mut self, position: Vec3, normal: Vec3, uv: Vec2) -> u32 {
        let index = self.mesh.positions.len() as u32;
        self.mesh.positions.push(position);
        self.mesh.normals.push(normal);
        self.mesh.uvs[0].push(uv);
        index
    }

    /// Adds a triangle of vertices that are there already, counter-clockwise seen from the front.
    pub fn triangle(&mut self, material: u32, corners: [u32; 3]) {
        self.mesh.triangles.push(corners);
        self.mesh.materials.push(material);
    }

    /// A flat triangle of its own three vertices.
    pub fn facet(&mut self, material: u32, corners: [Vec3; 3]) {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize();
        let uvs = [Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(0.5, 0.0)];
        let indices = [0, 1, 2].map(|i| self.vertex(corners[i], normal, uvs[i]));
        self.triangle(material, indices);
    }

    /// A parallelogram whose front points along `right × up`; an image on it stands upright.
    pub fn quad(&mut self, material: u32, corner: Vec3, right: Vec3, up: Vec3) {
        self.tiled_quad(material, corner, right, up, Vec2::ONE);
    }

    /// A parallelogram across which an image repeats `tiles` times.
    pub fn tiled_quad(&mut self, material: u32, corner: Vec3, right: Vec3, up: Vec3, tiles: Vec2) {
        let normal = right.cross(up).normalize();
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let [a, b, c, d] = corners.map(|(s, t)| {
            let uv = Vec2::new(s, 1.0 - t) * tiles;
            self.vertex(corner + right * s + up * t, normal, uv)
        });
        self.triangle(material, [a, b, c]);
        self.triangle(material, [a, c, d]);
    }

    /// A box along the axes, seen from outside.
    pub fn cuboid(&mut self, material: u32, low: [f32; 3], high: [f32; 3]) {
        for [corner, right, up] in box_faces(low.into(), high.into()) {
            self.quad(material, corner, right, up);
        }
    }

    /// A box of the given size, standing on the origin of `place`.
    pub fn block(&mut self, material: u32, size: [f32; 3], place: Affine3A) {
        let [x, y, z] = size;
        let low = Vec3::new(-0.5 * x, 0.0, -0.5 * z);
        for [corner, right, up] in box_faces(low, low + Vec3::new(x, y, z)) {
            self.quad(material, place.transform_point3(corner), place.transform_vector3(right), place.transform_vector3(up));
        }
    }

    /// A box seen from inside. Materials in the order −x, +x, −y, +y, −z, +z; a side without one stays open.
    pub fn room(&mut self, sides: [Option<u32>; 6], low: [f32; 3], high: [f32; 3]) {
        for (side, [corner, right, up]) in sides.into_iter().zip(box_faces(low.into(), high.into())) {
            if let Some(material) = side {
                self.quad(material, corner + right, -right, up);
            }
        }
    }

    /// Adds a copy of another shape's triangles, moved.
    pub fn append(&mut self, other: &Shape, place: Affine3A) {
        let first = self.mesh.positions.len() as u32;
        let normal_map = place.matrix3.inverse().transpose();
        self.mesh.positions.extend(other.mesh.positions.iter().map(|p| place.transform_point3(*p)));
        self.mesh.normals.extend(other.mesh.normals.iter().map(|n| (normal_map * *n).normalize()));
        self.mesh.uvs[0].extend_from_slice(&other.mesh.uvs[0]);
        self.mesh.triangles.extend(other.mesh.triangles.iter().map(|t| t.map(|i| i + first)));
        self.mesh.materials.extend_from_slice(&other.mesh.materials);
    }

    /// Moves every vertex by a function of position and unit normal; smooth normals are made anew from the triangles that share a vertex.
    pub fn displace(&mut self, offset: impl Fn(Vec3, Vec3) -> Vec3) {
        for (position, normal) in self.mesh.positions.iter_mut().zip(&self.mesh.normals) {
            *position += offset(*position, *normal);
        }
        self.mesh.normals = smooth_normals(&self.mesh.positions, &self.mesh.triangles);
    }
}

/// Corner, right edge and up edge of the six outward faces, in the order −x, +x, −y, +y, −z, +z.
fn box_faces(low: Vec3, high: Vec3) -> [[Vec3; 3]; 6] {
    let size = high - low;
    let (x, y, z) = (Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z);
    [[low, z, y], [low + x + z, -z, y], [low, x, z], [low + y + z, x, -z], [low + x, -x, y], [low + z, x, y]]
}
