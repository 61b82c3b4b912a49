//! Height fields as meshes.

use super::normals::smooth_normals;
use aquifer_scene::Mesh;
use glam::{Vec2, Vec3, Vec4};

/// A square height field centred on the origin, `side` metres across, of `cells` × `cells` × 2 triangles, all of material 0, with
/// smooth normals. `color` gives a vertex colour from position and normal, if wanted.
pub fn height_field(name: &str, side: f32, cells: u32, height: impl Fn(Vec2) -> f32, color: Option<&dyn Fn(Vec3, Vec3) -> Vec3>) -> Mesh {
    let row = cells + 1;
    let step = side / cells as f32;
    let place = |column: u32, line: u32| Vec2::new(column as f32, line as f32) * step - Vec2::splat(0.5 * side);
    let grid = || (0..row).flat_map(|line| (0..row).map(move |column| (column, line)));
    let positions: Vec<Vec3> = grid()
        .map(|(column, line)| {
            let at = place(column, line);
            Vec3::new(at.x, height(at), at.y)
        })
        .collect();
    let triangles = grid_triangles(cells);
    let normals = smooth_normals(&positions, &triangles);
    let colors = color.map_or(Vec::new(), |color| {
        positions.iter().zip(&normals).map(|(position, normal)| Vec4::from((color(*position, *normal), 1.0))).collect()
    });
    let materials = vec![0; triangles.len()];
    Mesh { name: name.into(), positions, normals, colors, triangles, materials, ..Mesh::default() }
}

fn grid_triangles(cells: u32) -> Vec<[u32; 3]> {
    let row = cells + 1;
    let mut triangles = Vec::with_capacity(2 * (cells * cells) as usize);
    for line in 0..cells {
        for column in 0..cells {
            let a = line * row + column;
            let (b, c, d) = (a + 1, a + row, a + row + 1);
            triangles.push([a, c, b]);
            triangles.push([b, c, d]);
        }
    }
    triangles
}
