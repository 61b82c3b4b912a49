//! The hierarchies of `trace/cwbvh`, made when a shader first asks for them.

use super::{still::meshes_of_instances, store::Store};
use crate::{Context, Error};
use aquifer_scene::{BvhQuality, Scene, WideBvh};

/// Its tables.
pub struct Wide {
    nodes: Store,
    order: Store,
    roots: Store,
}

impl Wide {
    /// Builds and uploads them.
    pub fn upload(context: &Context, scene: &Scene) -> Result<Wide, Error> {
        let (mut nodes, mut order) = (Vec::new(), Vec::new());
        let mut first = Vec::new();
        for mesh in &scene.meshes {
            first.push([nodes.len() as u32, order.len() as u32, 0, 0]);
            let wide = WideBvh::of(mesh, BvhQuality::Medium);
            nodes.extend(wide.nodes);
            order.extend(wide.order);
        }
        let roots: Vec<[u32; 4]> = meshes_of_instances(scene).map(|mesh| first[mesh]).collect();
        Ok(Wide {
            nodes: Store::table(context, "trace/cwbvh::wide_nodes", &nodes)?,
            order: Store::table(context, "trace/cwbvh::wide_order", &order)?,
            roots: Store::table(context, "trace/cwbvh::wide_roots", &roots)?,
        })
    }

    pub fn store(&self, name: &str) -> Option<&Store> {
        match name {
            "wide_nodes" => Some(&self.nodes),
            "wide_order" => Some(&self.order),
            "wide_roots" => Some(&self.roots),
            _ => None,
        }
    }
}
