//! Meshes: one primitive a material, each with the vertices it uses and no others.

use super::buffer::{Buffer, Usage};
use super::{ExportError, error, named};
use aquifer_scene::Mesh;
use serde_json::{Map, Value, json};

/// The number of each mesh in the file. glTF has no empty meshes: those that are get none.
pub(super) fn numbers(meshes: &[Mesh]) -> Vec<Option<usize>> {
    let mut next = 0..;
    meshes.iter().map(|mesh| if mesh.triangles.is_empty() { None } else { next.next() }).collect()
}

pub(super) fn mesh(mesh: &Mesh, material_count: usize, buffer: &mut Buffer) -> Result<Value, ExportError> {
    check(mesh, material_count)?;
    let mut used = mesh.materials.clone();
    used.sort_unstable();
    used.dedup();
    let primitives = used.into_iter().map(|material| primitive(mesh, material, buffer));
    let mut object = named(&mesh.name);
    object.insert("primitives".into(), primitives.collect::<Result<Vec<_>, _>>()?.into());
    Ok(object.into())
}

fn check(mesh: &Mesh, material_count: usize) -> Result<(), ExportError> {
    let what = |part: &str| format!("{part} of mesh '{}'", mesh.name);
    error::length(mesh.materials.len(), mesh.triangles.len(), || what("the material list"))?;
    let vertices = mesh.positions.len();
    let attributes = [
        ("the normals", mesh.normals.len()),
        ("the tangents", mesh.tangents.len()),
        ("the first texture coordinates", mesh.uvs[0].len()),
        ("the second texture coordinates", mesh.uvs[1].len()),
        ("the colours", mesh.colors.len()),
    ];
    for (name, found) in attributes.into_iter().filter(|(_, found)| *found > 0) {
        error::length(found, vertices, || what(name))?;
    }
    for corner in mesh.triangles.as_flattened() {
        error::index(*corner, vertices, || what("a triangle"))?;
    }
    mesh.materials.iter().try_for_each(|material| error::index(*material, material_count, || what("a triangle")))
}

fn primitive(mesh: &Mesh, material: u32, buffer: &mut Buffer) -> Result<Value, ExportError> {
    let (vertices, indices) = compact(mesh, material);
    let attributes = attributes(mesh, &vertices, buffer)?;
    let indices = buffer.indices(&indices, vertices.len());
    Ok(json!({ "attributes": attributes, "indices": indices, "material": material }))
}

/// The mesh vertices that triangles of one material use, in order of first use, and those triangles in terms of them.
fn compact(mesh: &Mesh, material: u32) -> (Vec<u32>, Vec<u32>) {
    let mut vertices = Vec::new();
    let mut place = vec![u32::MAX; mesh.positions.len()];
    let triangles = mesh.triangles.iter().zip(&mesh.materials).filter(|(_, own)| **own == material);
    let corners = triangles.flat_map(|(triangle, _)| *triangle);
    let indices = corners
        .map(|corner| {
            let place = &mut place[corner as usize];
            if *place == u32::MAX {
                *place = vertices.len() as u32;
                vertices.push(corner);
            }
            *place
        })
        .collect();
    (vertices, indices)
}

fn attributes(mesh: &Mesh, vertices: &[u32], buffer: &mut Buffer) -> Result<Map<String, Value>, ExportError> {
    let what = |part: &str| format!("{part} of mesh '{}'", mesh.name);
    let mut attributes = Map::new();
    let positions = pick(&mesh.positions, vertices);
    attributes.insert("POSITION".into(), buffer.bounded_floats(&positions, Usage::Vertices, || what("a position"))?.into());
    let mut add = |name: &str, accessor: usize| attributes.insert(name.into(), accessor.into());
    if !mesh.normals.is_empty() {
        let normals = pick(&mesh.normals, vertices);
        add("NORMAL", buffer.floats(&normals, Usage::Vertices, || what("a normal"))?);
    }
    if !mesh.tangents.is_empty() {
        let tangents = pick(&mesh.tangents, vertices);
        add("TANGENT", buffer.floats(&tangents, Usage::Vertices, || what("a tangent"))?);
    }
    for (uvs, name) in mesh.uvs.iter().zip(["TEXCOORD_0", "TEXCOORD_1"]) {
        if !uvs.is_empty() {
            let uvs = pick(uvs, vertices);
            add(name, buffer.floats(&uvs, Usage::Vertices, || what("a texture coordinate"))?);
        }
    }
    if !mesh.colors.is_empty() {
        let colors = pick(&mesh.colors, vertices);
        add("COLOR_0", buffer.floats(&colors, Usage::Vertices, || what("a colour"))?);
    }
    Ok(attributes)
}

fn pick<const N: usize, V: Copy + Into<[f32; N]>>(values: &[V], vertices: &[u32]) -> Vec<[f32; N]> {
    vertices.iter().map(|vertex| values[*vertex as usize].into()).collect()
}
