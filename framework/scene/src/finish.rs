//! From arrays that someone filled to arrays that a renderer can trust: the step shared by the loader and by generators.

mod check;
mod default_camera;
mod normals;
mod tangents;
mod triangles;

use crate::{Bvh, BvhOptions, Material, Mesh, Scene, SceneError};
use glam::Vec2;

impl Scene {
    /// [`Scene::finish_with`] default options.
    ///
    /// # Errors
    /// As [`Scene::finish_with`].
    pub fn finish(self) -> Result<Scene, SceneError> {
        self.finish_with(&BvhOptions::default())
    }

    /// Checks every index and number, then makes the scene ready to be traced. What it changes is counted in [`Scene::warnings`]:
    ///
    /// - triangles that have no area, are thinner than floats can tell, or have a corner at no finite place are dropped;
    /// - missing normals become flat ones, as glTF asks (vertices are then no longer shared); unusable ones are replaced;
    /// - missing tangents are made by MikkTSpace where a normal map needs them;
    /// - missing texture coordinates become (0, 0) where a texture needs them;
    /// - material factors are clamped to what they may be;
    /// - the hierarchy of each mesh is built, and its triangles are put into leaf order;
    /// - a scene without a camera gets one that frames it.
    ///
    /// # Errors
    /// The first fault found in the arrays.
    pub fn finish_with(mut self, options: &BvhOptions) -> Result<Scene, SceneError> {
        check::check(&self)?;
        check::normalise(&mut self);
        for mesh in &mut self.meshes {
            prepare(mesh, &self.materials, options, &mut self.warnings);
        }
        check::check_lights(&self)?;
        default_camera::add_if_missing(&mut self)?;
        Ok(self)
    }
}

fn prepare(mesh: &mut Mesh, materials: &[Material], options: &BvhOptions, warnings: &mut Vec<String>) {
    let name = if mesh.name.is_empty() { "a mesh without a name".to_owned() } else { format!("mesh `{}`", mesh.name) };
    let mut warn = |count: usize, what: &str| {
        if count > 0 {
            warnings.push(format!("{name}: {count} {what}"));
        }
    };
    warn(triangles::drop_degenerate(mesh), "degenerate triangles dropped");
    if mesh.normals.is_empty() {
        normals::flatten(mesh);
    } else {
        warn(normals::repair(mesh), "unusable normals replaced");
    }
    warn(fill_uvs(mesh, materials), "sets of texture coordinates missing for a texture, filled with (0, 0)");
    warn(tangents::complete(mesh, materials), "unusable tangents replaced");
    build_bvh(mesh, options);
}

/// Prepares a part of a mesh for being joined with others, some of which bring normals or tangents.
pub(crate) fn complete_part(part: &mut Mesh, materials: &[Material], normals: bool, tangents: bool) {
    if part.normals.is_empty() {
        if normals {
            normals::flatten(part);
        }
        part.tangents.clear();
    }
    if tangents && part.tangents.is_empty() {
        fill_uvs(part, materials);
        tangents::complete(part, materials);
        tangents::fill_missing(part);
    }
}

/// Every texture finds its coordinates.
fn fill_uvs(mesh: &mut Mesh, materials: &[Material]) -> usize {
    let mut filled = 0;
    for set in 0..mesh.uvs.len() {
        let needed = |&material: &u32| materials[material as usize].textures().any(|texture| texture.uv_set == set as u32);
        if mesh.uvs[set].is_empty() && mesh.materials.iter().any(needed) {
            mesh.uvs[set] = vec![Vec2::ZERO; mesh.positions.len()];
            filled += 1;
        }
    }
    filled
}

fn build_bvh(mesh: &mut Mesh, options: &BvhOptions) {
    let (bvh, order) = Bvh::of(mesh, options);
    mesh.triangles = order.iter().map(|&old| mesh.triangles[old as usize]).collect();
    mesh.materials = order.iter().map(|&old| mesh.materials[old as usize]).collect();
    mesh.bvh = bvh;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Alpha, Image, Node, TextureRef, Wrap};
    use glam::{Mat3, Vec3, vec3};

    fn grid(side: u32) -> Mesh {
        let positions = (0..=side).flat_map(|y| (0..=side).map(move |x| vec3(x as f32, y as f32, 0.0))).collect();
        let corner = |x: u32, y: u32| y * (side + 1) + x;
        let quads = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        let triangles: Vec<[u32; 3]> = quads
            .flat_map(|(x, y)| {
                let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let materials = (0..triangles.len() as u32).map(|index| index % 2).collect();
        Mesh { positions, triangles, materials, ..Mesh::default() }
    }

    fn scene(mesh: Mesh) -> Scene {
        let nodes = vec![Node { mesh: Some(0), ..Node::default() }];
        Scene { meshes: vec![mesh], materials: vec![Material::default(); 2], nodes, ..Scene::default() }
    }

    #[test]
    fn triangles_keep_their_materials_in_leaf_order() {
        let mut mesh = grid(9);
        mesh.normals = vec![Vec3::Z; mesh.positions.len()];
        let before: std::collections::BTreeSet<_> = mesh.triangles.iter().copied().zip(mesh.materials.iter().copied()).collect();
        let finished = scene(mesh).finish().unwrap();
        let mesh = &finished.meshes[0];
        let after: std::collections::BTreeSet<_> = mesh.triangles.iter().copied().zip(mesh.materials.iter().copied()).collect();
        assert_eq!(before, after);
        assert_eq!(mesh.triangles.len(), 162);
        for node in mesh.bvh.nodes.iter().filter(|node| node.count > 0) {
            for index in node.first..node.first + node.count {
                let bounds = crate::bvh::triangle_boxes(mesh)[index as usize];
                assert_eq!(bounds.union(&node.aabb()), node.aabb());
            }
        }
    }

    #[test]
    fn flat_normals_unshare_vertices() {
        let finished = scene(grid(2)).finish().unwrap();
        let mesh = &finished.meshes[0];
        assert_eq!((mesh.positions.len(), mesh.normals.len()), (24, 24));
        assert!(mesh.normals.iter().all(|&normal| normal == Vec3::Z));
    }

    #[test]
    fn what_cannot_be_hit_is_dropped_and_counted() {
        let mut mesh = grid(1);
        mesh.positions.extend([vec3(f32::NAN, 0.0, 0.0), vec3(0.5, 0.0, 0.0), vec3(0.5, 1e-9, 0.0), vec3(1e-30, 1e-30, 0.0)]);
        mesh.triangles.extend([[0, 1, 4], [0, 1, 5], [0, 1, 6], [0, 0, 1], [0, 7, 7]]);
        mesh.materials.extend([0; 5]);
        let finished = scene(mesh).finish().unwrap();
        assert_eq!(finished.meshes[0].triangles.len(), 2);
        assert_eq!(finished.warnings[0], "a mesh without a name: 5 degenerate triangles dropped");
    }

    #[test]
    fn a_mesh_may_lose_all_its_triangles() {
        let mut mesh = grid(1);
        mesh.positions = vec![Vec3::ZERO; 4];
        let finished = scene(mesh).finish().unwrap();
        assert!(finished.meshes[0].bvh.nodes.is_empty());
        assert!(finished.at(0.0, None).is_ok());
    }

    #[test]
    fn faults_name_the_place() {
        let mut wrong = grid(1);
        wrong.triangles[1][2] = 4;
        assert_eq!(scene(wrong).finish().unwrap_err().to_string(), "meshes[0].triangles[1]: index 4 is out of range, there are 4");
        let mut wrong = grid(1);
        wrong.materials.pop();
        assert_eq!(scene(wrong).finish().unwrap_err().to_string(), "meshes[0].materials: 1 entries where 2 are needed");
        let mut wrong = scene(grid(1));
        wrong.nodes[0].parent = Some(0);
        assert!(matches!(wrong.finish(), Err(SceneError::ParentOrder { node: 0, parent: 0 })));
        let mut wrong = scene(grid(1));
        wrong.materials[1].alpha = Alpha::Mask { cutoff: f32::NAN };
        assert_eq!(wrong.finish().unwrap_err().to_string(), "materials[1].alpha: not a finite number");
    }

    #[test]
    fn a_camera_is_added_that_sees_the_scene() {
        let finished = scene(grid(4)).finish().unwrap();
        assert!(finished.warnings.iter().any(|warning| warning.contains("no camera")));
        let camera = finished.at(0.0, None).unwrap().camera;
        for corner in [vec3(0.0, 0.0, 0.0), vec3(4.0, 4.0, 0.0)] {
            let seen = camera.to_world.inverse().transform_point3(corner);
            let limit = (camera.vertical_fov * 0.5).tan();
            assert!(seen.z < 0.0 && seen.x.abs() < -seen.z * limit && seen.y.abs() < -seen.z * limit);
        }
        let again = finished.clone().finish().unwrap();
        assert_eq!(again.warnings, finished.warnings, "finishing twice changes nothing more");
    }

    #[test]
    fn a_normal_map_brings_tangents() {
        let mut scene = scene(grid(2));
        // glTF's v points down in the image, so that (x, 1 − y) shows an image upright on the plane z = 0.
        let uvs = scene.meshes[0].positions.iter().map(|p| Vec2::new(p.x, 1.0 - p.y)).collect();
        scene.meshes[0].uvs[0] = uvs;
        scene.images.push(Image { name: String::new(), width: 1, height: 1, rgba: vec![[128, 128, 255, 255]], srgb: false });
        let texture = TextureRef { image: 0, uv_set: 0, transform: Mat3::IDENTITY, wrap: [Wrap::Repeat; 2], linear: true };
        scene.materials[0].normal_texture = Some(texture);
        let finished = scene.finish().unwrap();
        let mesh = &finished.meshes[0];
        assert_eq!(mesh.tangents.len(), mesh.positions.len());
        for (triangle, _) in mesh.triangles.iter().zip(&mesh.materials).filter(|&(_, &material)| material == 0) {
            for &corner in triangle {
                let tangent = mesh.tangents[corner as usize];
                assert!(tangent.abs_diff_eq(glam::vec4(1.0, 0.0, 0.0, 1.0), 1e-6), "{tangent}: bitangent is up in the image");
            }
        }
    }
}
