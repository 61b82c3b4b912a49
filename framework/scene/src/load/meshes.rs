//! Primitives to meshes: one [`Mesh`] for each glTF mesh, with a material for each triangle.

use super::{
    LoadError, Loader, MAX_TRIANGLES,
    accessor::{Elements, Wanted},
    limits::spend,
    named,
};
use crate::{Material, Mesh, finish};
use glam::{Vec2, Vec3, Vec4};
use gltf::{
    Semantic, json,
    json::{accessor::Type, mesh::Mode, mesh::Primitive, validation::Checked},
};
use std::collections::HashMap;

const TEXCOORD: Wanted = Wanted::unit(Type::Vec2);

impl Loader<'_> {
    /// All meshes, in the file's order.
    pub(super) fn read_meshes(&mut self) -> Result<(), LoadError> {
        for index in 0..self.document.as_json().meshes.len() {
            let mesh = self.read_mesh(index)?;
            self.scene.meshes.push(mesh);
        }
        Ok(())
    }

    fn read_mesh(&mut self, index: usize) -> Result<Mesh, LoadError> {
        let mesh = self.document.as_json().meshes[index].clone();
        let name = named("mesh", index, mesh.name.as_deref());
        let mut parts = Vec::new();
        let (mut morphs, mut other_modes) = (0, 0);
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            morphs += usize::from(primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()));
            match self.read_primitive(primitive, &format!("/meshes/{index}/primitives/{number}"))? {
                Some(part) => parts.push(part),
                None => other_modes += 1,
            }
        }
        if morphs > 0 {
            self.warn(format!("{name}: morph targets are not applied, its rest pose is shown"));
        }
        if other_modes > 0 {
            self.warn(format!("{name}: {other_modes} primitives of points or lines left out"));
        }
        Ok(merge(parts, mesh.name.unwrap_or_default(), &self.scene.materials))
    }

    /// `None` for points and lines.
    fn read_primitive(&mut self, primitive: &Primitive, pointer: &str) -> Result<Option<Mesh>, LoadError> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(LoadError::invalid(format!("{pointer}/mode"), "unknown mode"));
        };
        let Some(positions) = accessor(primitive, Semantic::Positions) else {
            return Err(LoadError::invalid(format!("{pointer}/attributes/POSITION"), "missing"));
        };
        let positions = self.elements(positions, Wanted::floats(Type::Vec3))?;
        let corners = match primitive.indices {
            Some(indices) => self.elements(indices.value(), Wanted::INDEX)?.indices(positions.count)?,
            None => (0..positions.count as u32).collect(),
        };
        let Some(triangles) = triangles(mode, &corners) else { return Ok(None) };
        spend(&self.budget.triangles, triangles.len() as u64, MAX_TRIANGLES, "triangles")?;
        let (used, triangles) = compact(triangles);
        let mut mesh = Mesh { positions: gather(&positions, &used)?.into_iter().map(Vec3::from_array).collect(), ..Mesh::default() };
        self.read_attributes(&mut mesh, primitive, positions.count, &used, pointer)?;
        let material = self.material_of(primitive);
        mesh.materials = vec![material; triangles.len()];
        mesh.triangles = triangles;
        Ok(Some(mesh))
    }

    fn read_attributes(&self, mesh: &mut Mesh, primitive: &Primitive, count: usize, used: &[u32], pointer: &str) -> Result<(), LoadError> {
        let attribute = |semantic: Semantic, wanted: Wanted| -> Result<Option<Elements<'_>>, LoadError> {
            let Some(index) = accessor(primitive, semantic.clone()) else { return Ok(None) };
            let elements = self.elements(index, wanted)?;
            if elements.count == count {
                return Ok(Some(elements));
            }
            let name = Checked::Valid(semantic).to_string();
            Err(LoadError::invalid(format!("{pointer}/attributes/{name}"), format!("{} elements for {count} vertices", elements.count)))
        };
        if let Some(normals) = attribute(Semantic::Normals, Wanted::floats(Type::Vec3))? {
            mesh.normals = gather(&normals, used)?.into_iter().map(Vec3::from_array).collect();
        }
        if let Some(tangents) = attribute(Semantic::Tangents, Wanted::floats(Type::Vec4))? {
            mesh.tangents = gather(&tangents, used)?.into_iter().map(Vec4::from_array).collect();
        }
        for set in 0..mesh.uvs.len() {
            if let Some(uvs) = attribute(Semantic::TexCoords(set as u32), TEXCOORD)? {
                mesh.uvs[set] = gather(&uvs, used)?.into_iter().map(Vec2::from_array).collect();
            }
        }
        if let Some(index) = accessor(primitive, Semantic::Colors(0)) {
            mesh.colors = match self.document.as_json().accessors[index].type_ {
                Checked::Valid(Type::Vec3) => {
                    let colors = attribute(Semantic::Colors(0), Wanted::unit(Type::Vec3))?;
                    let colors = colors.map_or(Ok(Vec::new()), |colors| gather(&colors, used))?;
                    colors.into_iter().map(|color| Vec3::from_array(color).extend(1.0)).collect()
                }
                _ => {
                    let colors = attribute(Semantic::Colors(0), Wanted::unit(Type::Vec4))?;
                    let colors = colors.map_or(Ok(Vec::new()), |colors| gather(&colors, used))?;
                    colors.into_iter().map(Vec4::from_array).collect()
                }
            };
        }
        Ok(())
    }

    /// The file's material, or glTF's default one, which is made when first asked for.
    fn material_of(&mut self, primitive: &Primitive) -> u32 {
        let count = self.document.as_json().materials.len();
        if let Some(material) = primitive.material {
            return material.value() as u32;
        }
        if self.scene.materials.len() == count {
            self.scene.materials.push(Material::default());
        }
        count as u32
    }
}

fn accessor(primitive: &Primitive, semantic: Semantic) -> Option<usize> {
    primitive.attributes.get(&Checked::Valid(semantic)).map(json::Index::value)
}

/// Corners in glTF's order (3.7.2.1); a remainder that makes no triangle is ignored. `None` for points and lines.
fn triangles(mode: Mode, corners: &[u32]) -> Option<Vec<[u32; 3]>> {
    let last = corners.len().saturating_sub(2);
    match mode {
        Mode::Triangles => Some(corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()),
        Mode::TriangleStrip => Some((0..last).map(|i| [corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]]).collect()),
        Mode::TriangleFan => Some((0..last).map(|i| [corners[i + 1], corners[i + 2], corners[0]]).collect()),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
    }
}

/// Keeps only the vertices that are used, in the order of first use: many primitives may share one long vertex buffer.
fn compact(mut triangles: Vec<[u32; 3]>) -> (Vec<u32>, Vec<[u32; 3]>) {
    let mut used = Vec::new();
    let mut new: HashMap<u32, u32> = HashMap::new();
    for corner in triangles.iter_mut().flatten() {
        *corner = *new.entry(*corner).or_insert_with(|| {
            used.push(*corner);
            used.len() as u32 - 1
        });
    }
    (used, triangles)
}

fn gather<const N: usize>(elements: &Elements<'_>, used: &[u32]) -> Result<Vec<[f32; N]>, LoadError> {
    used.iter().map(|&index| elements.floats(index as usize)).collect()
}

/// Puts primitives into one mesh. What only some of them have is made up for the others.
fn merge(mut parts: Vec<Mesh>, name: String, materials: &[Material]) -> Mesh {
    let any = |has: fn(&Mesh) -> bool| parts.iter().any(has);
    let (normals, tangents) = (any(|part| !part.normals.is_empty()), any(|part| !part.tangents.is_empty() && !part.normals.is_empty()));
    let (uv0, uv1, colors) =
        (any(|part| !part.uvs[0].is_empty()), any(|part| !part.uvs[1].is_empty()), any(|part| !part.colors.is_empty()));
    let mut mesh = Mesh { name, ..Mesh::default() };
    for part in &mut parts {
        finish::complete_part(part, materials, normals, tangents);
        fill(&mut part.uvs[0], uv0, part.positions.len(), Vec2::ZERO);
        fill(&mut part.uvs[1], uv1, part.positions.len(), Vec2::ZERO);
        fill(&mut part.colors, colors, part.positions.len(), Vec4::ONE);
        append(&mut mesh, part);
    }
    mesh
}

fn fill<T: Copy>(values: &mut Vec<T>, wanted: bool, count: usize, value: T) {
    if wanted && values.is_empty() {
        values.resize(count, value);
    }
}

fn append(mesh: &mut Mesh, part: &mut Mesh) {
    let base = mesh.positions.len() as u32;
    mesh.positions.append(&mut part.positions);
    mesh.normals.append(&mut part.normals);
    mesh.tangents.append(&mut part.tangents);
    for (all, own) in mesh.uvs.iter_mut().zip(&mut part.uvs) {
        all.append(own);
    }
    mesh.colors.append(&mut part.colors);
    mesh.triangles.extend(part.triangles.iter().map(|triangle| triangle.map(|corner| corner + base)));
    mesh.materials.append(&mut part.materials);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_wind_as_gltf_says() {
        let corners = [10, 11, 12, 13, 14];
        assert_eq!(triangles(Mode::TriangleStrip, &corners).unwrap(), [[10, 11, 12], [11, 13, 12], [12, 13, 14]]);
        assert_eq!(triangles(Mode::TriangleFan, &corners).unwrap(), [[11, 12, 10], [12, 13, 10], [13, 14, 10]]);
        assert_eq!(triangles(Mode::Triangles, &corners).unwrap(), [[10, 11, 12]]);
        assert_eq!(triangles(Mode::LineLoop, &corners), None);
        assert_eq!(triangles(Mode::TriangleStrip, &corners[..1]).unwrap(), [[0_u32; 3]; 0]);
    }

    #[test]
    fn unused_vertices_go() {
        assert_eq!(compact(vec![[7, 3, 9], [9, 3, 100]]), (vec![7, 3, 9, 100], vec![[0, 1, 2], [2, 1, 3]]));
    }
}
