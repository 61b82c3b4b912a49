//! Scenes of a few polygons, written in the test that needs them.

use aquifer_scene::{Environment, Lens, Material, Mesh, Node, PunctualLight, Scene};
use glam::{Mat3, Quat, Vec3, Vec4};
use std::sync::Arc;

/// A scene under construction.
#[derive(Default)]
pub struct Stage(Scene);

impl Stage {
    /// Adds a material, and gives its index.
    pub fn material(&mut self, material: Material) -> u32 {
        self.0.materials.push(material);
        self.0.materials.len() as u32 - 1
    }

    /// A purely diffuse material that may emit.
    pub fn diffuse(&mut self, albedo: f32, emission: f32) -> u32 {
        self.material(Material {
            base_color: Vec4::new(albedo, albedo, albedo, 1.0),
            metallic: 0.0,
            specular: 0.0,
            emission: Vec3::splat(emission),
            ..Material::default()
        })
    }

    /// A polygon's corners, counter-clockwise seen from the front, fanned from the first.
    pub fn polygon(&mut self, corners: &[Vec3], material: u32) {
        let triangles: Vec<_> = (2..corners.len() as u32).map(|i| [0, i - 1, i]).collect();
        self.triangles(corners.to_vec(), triangles, material);
    }

    /// Any triangles.
    pub fn triangles(&mut self, positions: Vec<Vec3>, triangles: Vec<[u32; 3]>, material: u32) {
        let materials = vec![material; triangles.len()];
        self.0.meshes.push(Mesh { positions, triangles, materials, ..Mesh::default() });
        self.0.nodes.push(Node { mesh: Some(self.0.meshes.len() as u32 - 1), ..Node::default() });
    }

    /// A square of half size `half` around `centre`, facing `normal`.
    pub fn square(&mut self, centre: Vec3, normal: Vec3, half: f32, material: u32) {
        let (x, y) = normal.any_orthonormal_pair();
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b)| centre + half * (a * x + b * y));
        let flip = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(normal) < 0.0;
        let order: Vec<Vec3> = if flip { corners.into_iter().rev().collect() } else { corners.to_vec() };
        self.polygon(&order, material);
    }

    /// A camera; `full_fov` is vertical, in radians.
    pub fn camera(&mut self, from: Vec3, to: Vec3, full_fov: f32) {
        let up = if (to - from).normalize().y.abs() > 0.99 { Vec3::X } else { Vec3::Y };
        let z = (from - to).normalize();
        let x = up.cross(z).normalize();
        let rotation = Quat::from_mat3(&Mat3::from_cols(x, z.cross(x), z));
        self.0.cameras.push(Lens { name: "main".into(), vertical_fov: full_fov, aspect: None, near: 1e-3 });
        self.0.nodes.push(Node { translation: from, rotation, camera: Some(0), scale: Vec3::ONE, ..Node::default() });
    }

    /// A punctual light that shines along `along`.
    pub fn punctual(&mut self, light: PunctualLight, from: Vec3, along: Vec3) {
        self.0.lights.push(light);
        let rotation = Quat::from_rotation_arc(Vec3::NEG_Z, along.normalize());
        self.0.nodes.push(Node { translation: from, rotation, light: Some(self.0.lights.len() as u32 - 1), ..Node::default() });
    }

    /// The same radiance from everywhere.
    pub fn sky(&mut self, radiance: f32) {
        self.0.environment =
            Some(Environment { name: "sky".into(), width: 8, height: 4, radiance: vec![[radiance; 3]; 32], world_to_map: Mat3::IDENTITY });
    }

    /// The finished scene.
    pub fn finish(self) -> Arc<Scene> {
        Arc::new(self.0.finish().expect("a scene written by hand is valid"))
    }
}
