//! Tangents where a normal map needs them.

use crate::{Material, Mesh, unit};
use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec3, Vec4};
use std::collections::HashMap;

/// Makes missing tangents and repairs unusable ones; gives the number of the latter.
pub(super) fn complete(mesh: &mut Mesh, materials: &[Material]) -> usize {
    if mesh.tangents.is_empty() {
        generate(mesh, materials);
        0
    } else {
        repair(mesh)
    }
}

/// MikkTSpace over the triangles that have a normal map, with the texture coordinates of that map (before KHR_texture_transform).
/// A vertex whose corners get different tangents is split.
fn generate(mesh: &mut Mesh, materials: &[Material]) {
    let uv_set = |material: u32| materials[material as usize].normal_texture.as_ref().map(|texture| texture.uv_set as usize);
    let faces: Vec<Face> =
        (0..mesh.triangles.len()).filter_map(|triangle| uv_set(mesh.materials[triangle]).map(|uv_set| Face { triangle, uv_set })).collect();
    if faces.is_empty() {
        return;
    }
    let tangents = vec![[None; 3]; faces.len()];
    let mut geometry = Corners { mesh, faces, tangents };
    // Its error type has no values yet; corners it could not do get some tangent in `split`.
    generate_tangents(&mut geometry).ok();
    let Corners { faces, tangents, .. } = geometry;
    split(mesh, &faces, &tangents);
}

struct Face {
    triangle: usize,
    uv_set: usize,
}

struct Corners<'a> {
    mesh: &'a Mesh,
    faces: Vec<Face>,
    tangents: Vec<[Option<Vec4>; 3]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[self.faces[face].triangle][corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.faces.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.mesh.uvs[self.faces[face].uv_set][self.vertex(face, corner)].to_array()
    }

    /// MikkTSpace takes v upwards, glTF downwards: the bitangent `cross(normal, tangent) * w` must point up in the image.
    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let encoded = space.map(|space| Vec4::from_array(space.tangent_encoded()) * Vec4::new(1.0, 1.0, 1.0, -1.0));
        self.tangents[face][corner] = encoded;
    }
}

fn split(mesh: &mut Mesh, faces: &[Face], tangents: &[[Option<Vec4>; 3]]) {
    let mut sources: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    let mut of_vertex: Vec<Option<Vec4>> = vec![None; sources.len()];
    let mut copies: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    for (face, corners) in faces.iter().zip(tangents) {
        for (corner, tangent) in corners.iter().enumerate() {
            let vertex = mesh.triangles[face.triangle][corner];
            let tangent = tangent.and_then(usable).unwrap_or_else(|| any_tangent(mesh.normals[vertex as usize]));
            let key = (vertex, tangent.to_array().map(f32::to_bits));
            let own = *copies.entry(key).or_insert_with(|| match of_vertex[vertex as usize] {
                None => vertex,
                Some(_) => {
                    sources.push(vertex);
                    sources.len() as u32 - 1
                }
            });
            if own as usize == of_vertex.len() {
                of_vertex.push(Some(tangent));
            } else {
                of_vertex[own as usize] = Some(tangent);
            }
            mesh.triangles[face.triangle][corner] = own;
        }
    }
    mesh.gather(&sources);
    mesh.normals = sources.iter().map(|&vertex| mesh.normals[vertex as usize]).collect();
    mesh.tangents = of_vertex.iter().zip(&mesh.normals).map(|(tangent, &normal)| tangent.unwrap_or_else(|| any_tangent(normal))).collect();
}

/// Some tangent for every vertex, where nothing needs a particular one.
pub(super) fn fill_missing(mesh: &mut Mesh) {
    if mesh.tangents.is_empty() {
        mesh.tangents = mesh.normals.iter().map(|&normal| any_tangent(normal)).collect();
    }
}

fn repair(mesh: &mut Mesh) -> usize {
    let mut repaired = 0;
    for (tangent, &normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
        *tangent = usable(*tangent).unwrap_or_else(|| {
            repaired += 1;
            any_tangent(normal)
        });
    }
    repaired
}

/// A unit direction and a sign, or nothing.
fn usable(tangent: Vec4) -> Option<Vec4> {
    let direction = unit::direction(tangent.truncate())?;
    (tangent.w.is_finite() && tangent.w != 0.0).then(|| direction.extend(tangent.w.signum()))
}

fn any_tangent(normal: Vec3) -> Vec4 {
    normal.any_orthonormal_vector().extend(1.0)
}
