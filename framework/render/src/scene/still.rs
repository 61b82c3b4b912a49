//! What does not move: geometry, materials, textures, the environment.

use super::{
    mirror::{self, NONE, pack_half4, pack_unit},
    nodes,
    store::Store,
};
use crate::{Context, Error};
use aquifer_scene::{Emitters, Environment, EnvironmentDistribution, Features, Mesh, Scene, TextureRef};
use glam::Mat3;
use std::collections::BTreeMap;

/// Arrays by qualified name, and what moving data is made from.
pub struct Still {
    stores: BTreeMap<&'static str, Store>,
    /// Names of arrays, with the fact that the scene lacks.
    pub left_out: Vec<(&'static str, &'static str)>,
    /// One a mesh.
    pub places: Vec<Place>,
    pub emitters: Emitters,
    pub environment: Option<EnvironmentDistribution>,
}

/// Where a mesh begins in the shared arrays.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub first_node: u32,
    pub first_triangle: u32,
}

impl Still {
    pub fn upload(context: &Context, scene: &Scene, features: &Features) -> Result<Still, Error> {
        let emitters = Emitters::find(scene);
        let environment = scene.environment.as_ref().map(EnvironmentDistribution::new);
        let mut still = Still { stores: BTreeMap::new(), left_out: Vec::new(), places: places(scene), emitters, environment };
        still.add_geometry(context, scene, features)?;
        still.add_materials(context, scene, features)?;
        still.add_environment(context, scene, features)?;
        Ok(still)
    }

    pub fn store(&self, name: &str) -> Option<&Store> {
        self.stores.get(name)
    }

    pub fn arrays(&self) -> impl Iterator<Item = (&'static str, u64)> {
        self.stores.iter().map(|(name, store)| (*name, store.bytes()))
    }

    /// Adds an array that shaders have only with `fact`.
    fn add_with<T: bytemuck::Pod>(
        &mut self,
        context: &Context,
        features: &Features,
        fact: &'static str,
        name: &'static str,
        records: impl FnOnce() -> Vec<T>,
    ) -> Result<(), Error> {
        if features.names().contains(fact) {
            return self.add(context, name, &records());
        }
        self.left_out.push((name, fact));
        Ok(())
    }

    fn add<T: bytemuck::Pod>(&mut self, context: &Context, name: &'static str, records: &[T]) -> Result<(), Error> {
        self.stores.insert(name, Store::table(context, name, records)?);
        Ok(())
    }

    fn add_geometry(&mut self, context: &Context, scene: &Scene, features: &Features) -> Result<(), Error> {
        let placed = |mesh: usize| nodes::Placed {
            bvh: &scene.meshes[mesh].bvh,
            first_node: self.places[mesh].first_node,
            first_primitive: self.places[mesh].first_triangle,
        };
        let pairs: Vec<nodes::Pair> = (0..scene.meshes.len()).flat_map(|mesh| placed(mesh).pairs()).collect();
        let roots: Vec<nodes::Pair> = meshes_of_instances(scene).map(|mesh| placed(mesh).root()).collect();
        self.add(context, "trace/bvh2::nodes", &pairs)?;
        self.add(context, "trace/bvh2::roots", &roots)?;
        let all = |corner: fn(&Mesh, usize) -> mirror::Triangle| {
            scene.meshes.iter().flat_map(move |mesh| (0..mesh.triangles.len()).map(move |t| corner(mesh, t)))
        };
        self.add(context, "scene/geometry::triangles", &all(triangle).collect::<Vec<_>>())?;
        let infos: Vec<_> = scene
            .meshes
            .iter()
            .zip(&self.emitters.meshes)
            .flat_map(|(mesh, emitters)| {
                mesh.materials
                    .iter()
                    .enumerate()
                    .map(|(t, &material)| mirror::TriangleInfo { material, emissive: emitters.ordinal(t as u32).unwrap_or(NONE) })
            })
            .collect();
        self.add(context, "scene/geometry::triangle_infos", &infos)?;
        self.add_with(context, features, "textures", "scene/material::triangle_uvs", || per_triangle(scene, uvs))?;
        self.add_with(context, features, "normal_maps", "surface::triangle_tangents", || per_triangle(scene, tangents))?;
        self.add_with(context, features, "vertex_colors", "scene/material::triangle_colors", || per_triangle(scene, colors))
    }

    fn add_materials(&mut self, context: &Context, scene: &Scene, features: &Features) -> Result<(), Error> {
        let mut uses: Vec<TextureRef> = Vec::new();
        let mut index = |used: &Option<TextureRef>| {
            let Some(used) = used else { return NONE };
            let at = uses.iter().position(|known| known == used).unwrap_or_else(|| {
                uses.push(used.clone());
                uses.len() - 1
            });
            at as u32
        };
        let materials: Vec<_> = scene.materials.iter().map(|material| mirror::Material::new(material, &mut index)).collect();
        self.add(context, "scene/material::materials", &materials)?;
        let mut texels: Vec<[u8; 4]> = Vec::new();
        let firsts: Vec<u32> = scene
            .images
            .iter()
            .map(|image| {
                let first = texels.len() as u32;
                texels.extend_from_slice(&image.rgba);
                first
            })
            .collect();
        let textures: Vec<_> =
            uses.iter().map(|used| mirror::Texture::new(used, &scene.images[used.image as usize], firsts[used.image as usize])).collect();
        self.add_with(context, features, "textures", "scene/texture::textures", || textures)?;
        self.add_with(context, features, "textures", "scene/texture::texels", || texels)
    }

    /// Of a scene without one, where shaders ask for it all the same, a black one.
    fn add_environment(&mut self, context: &Context, scene: &Scene, features: &Features) -> Result<(), Error> {
        if !features.environment {
            self.left_out.extend(ENVIRONMENT.map(|name| (name, "environment")));
            return Ok(());
        }
        let black = Environment { name: String::new(), width: 1, height: 1, radiance: vec![[0.0; 3]], world_to_map: Mat3::IDENTITY };
        let environment = scene.environment.as_ref().unwrap_or(&black);
        let m = environment.world_to_map;
        let row = |i: usize| [m.x_axis[i], m.y_axis[i], m.z_axis[i]];
        let info = mirror::EnvironmentInfo {
            to_map_x: row(0),
            width: environment.width,
            to_map_y: row(1),
            height: environment.height,
            to_map_z: row(2),
            padding: 0,
        };
        let [info_name, texels_name, cdf_name] = ENVIRONMENT;
        let buffer = Store::buffer(context, info_name, &[info], wgpu::BufferUsages::UNIFORM)?;
        self.stores.insert(info_name, buffer);
        let texels: Vec<[f32; 4]> = environment.radiance.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect();
        self.add(context, texels_name, &texels)?;
        let pmf: Vec<f64> = self.environment.iter().flat_map(|d| d.table.entries.iter().map(|entry| f64::from(entry.pmf))).collect();
        self.add(context, cdf_name, &cumulative(&pmf, environment.width as usize, environment.height as usize))
    }
}

/// What stands for the environment.
const ENVIRONMENT: [&str; 3] =
    ["scene/environment::environment_info", "scene/environment::environment_texels", "scene/environment::environment_cdf"];

/// Instances are made from the nodes in their order, at every moment.
pub fn meshes_of_instances(scene: &Scene) -> impl Iterator<Item = usize> {
    scene.nodes.iter().filter_map(|node| node.mesh).map(|mesh| mesh as usize)
}

fn places(scene: &Scene) -> Vec<Place> {
    let (mut first_node, mut first_triangle) = (0, 0);
    let place = |mesh: &Mesh| {
        let place = Place { first_node, first_triangle };
        first_node += mesh.bvh.nodes.len() as u32 / 2;
        first_triangle += mesh.triangles.len() as u32;
        place
    };
    scene.meshes.iter().map(place).collect()
}

fn triangle(mesh: &Mesh, t: usize) -> mirror::Triangle {
    let [a, b, c] = mesh.corners(t).map(Into::into);
    let [na, nb, nc] = mesh.triangles[t].map(|vertex| pack_unit(mesh.normals[vertex as usize]));
    mirror::Triangle { a, na, b, nb, c, nc }
}

fn per_triangle<T>(scene: &Scene, record: fn(&Mesh, [u32; 3]) -> T) -> Vec<T> {
    scene.meshes.iter().flat_map(|mesh| mesh.triangles.iter().map(move |&corners| record(mesh, corners))).collect()
}

fn uvs(mesh: &Mesh, corners: [u32; 3]) -> mirror::TriangleUvs {
    let [a, b, c] = corners.map(|vertex| {
        let of = |set: usize| mesh.uvs[set].get(vertex as usize).map_or([0.0; 2], |uv| uv.to_array());
        let (first, second) = (of(0), of(1));
        [first[0], first[1], second[0], second[1]]
    });
    mirror::TriangleUvs { a, b, c }
}

fn tangents(mesh: &Mesh, corners: [u32; 3]) -> [[f32; 4]; 3] {
    corners.map(|vertex| mesh.tangents.get(vertex as usize).map_or([0.0; 4], |tangent| tangent.to_array()))
}

/// With a word's room at the end, for whole texels.
fn colors(mesh: &Mesh, corners: [u32; 3]) -> [[u32; 2]; 4] {
    let [a, b, c] = corners.map(|vertex| pack_half4(mesh.colors.get(vertex as usize).map_or([1.0; 4], |color| color.to_array())));
    [a, b, c, [0; 2]]
}

/// Cumulative sums of rows, then of the texels of each row, each ending at 1; of a black map all are 0.
fn cumulative(pmf: &[f64], width: usize, height: usize) -> Vec<f32> {
    if pmf.is_empty() {
        return vec![0.0; height + width * height];
    }
    let rows: Vec<f64> = pmf.chunks_exact(width).map(|row| row.iter().sum()).collect();
    let mut sums = running(&rows);
    pmf.chunks_exact(width).for_each(|row| sums.extend(running(row)));
    sums
}

fn running(weights: &[f64]) -> Vec<f32> {
    let total: f64 = weights.iter().sum();
    let mut sum = 0.0;
    let partial = weights.iter().map(|weight| {
        sum += weight;
        if total > 0.0 { (sum / total) as f32 } else { 0.0 }
    });
    let mut sums: Vec<f32> = partial.collect();
    // Rounding must not leave a gap below 1, nor give the entries after the last positive weight any share of it.
    if total > 0.0 {
        let end = weights.iter().rposition(|&weight| weight > 0.0).unwrap_or(0);
        sums[end..].fill(1.0);
    }
    sums
}
