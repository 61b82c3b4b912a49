//! What the pixels of the last frame see, from a graph's g-buffer: base colour, normal and depth beside the radiance.
//!
//! Like running means the g-buffer is found, not configured: the output nearest to the graph's whose elements are called [`RECORD`]. It holds one film
//! sample a pixel, so that edges are not smooth.

use crate::{
    capture::{CaptureError, Record, upstream},
    film::Film,
};
use aquifer_graph::{Direction, Graph, PortId};
use aquifer_render::Renderer;
use aquifer_scene::Camera;
use glam::Vec3;
use half::f16;

/// Element of a g-buffer.
pub const RECORD: &str = "SurfaceRecord";
/// `instance` of a pixel that sees nothing, as `scene/geometry::NONE`.
const NONE: u32 = u32::MAX;

/// Where a graph keeps what its pixels see.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirstSurface(Option<String>);

impl FirstSurface {
    /// Finds the g-buffer nearest to the graph's output.
    pub fn of(graph: &Graph) -> Self {
        let record = |node: usize| {
            let is_record = |port: &aquifer_graph::Port| port.ty.element == RECORD && port.direction != Direction::In;
            Some(PortId { node, port: graph.nodes()[node].contract.ports.iter().position(is_record)? })
        };
        Self(upstream(graph).into_iter().find_map(record).map(|port| graph.port_name(port)))
    }

    /// Resources that the plan must keep.
    pub fn keep(&self) -> Vec<&str> {
        self.0.iter().map(String::as_str).collect()
    }

    /// The film with albedo, normal and depth, where the graph has a g-buffer; `camera` is the last frame's.
    pub fn add_to(&self, film: Film, renderer: &mut Renderer, camera: &Camera) -> Result<Film, CaptureError> {
        let Some(name) = &self.0 else { return Ok(film) };
        let of = Record::of(renderer.plan(), name);
        let [position, instance, normal, base] = [of.place("position")?, of.place("instance")?, of.place("normal")?, of.place("base")?];
        let stride = of.stride();
        let words = renderer.read_f32(name)?;
        let seen: Vec<Option<&[f32]>> =
            words.chunks_exact(stride).map(|record| (record[instance].to_bits() != NONE).then_some(record)).collect();
        let forward = -Vec3::from(camera.to_world.matrix3.z_axis);
        let depth = |record: &[f32]| (Vec3::from_slice(&record[position..]) - camera.position()).dot(forward);
        Ok(Film {
            albedo: Some(seen.iter().map(|seen| seen.map_or([0.0; 3], |record| halves(&record[base..]))).collect()),
            normal: Some(seen.iter().map(|seen| seen.map_or([0.0; 3], |record| unit(record[normal].to_bits()))).collect()),
            depth: Some(seen.iter().map(|seen| seen.map_or(f32::INFINITY, depth)).collect()),
            ..film
        })
    }
}

/// The first three of four halves, as `base/pack::unpack_half4`.
fn halves(words: &[f32]) -> [f32; 3] {
    let (xy, z) = (words[0].to_bits(), words[1].to_bits());
    [xy as u16, (xy >> 16) as u16, z as u16].map(|bits| f16::from_bits(bits).to_f32())
}

/// As `base/pack::unpack_unit`.
fn unit(bits: u32) -> [f32; 3] {
    let [x, y] = [bits as u16 as i16, (bits >> 16) as u16 as i16].map(|s| (f32::from(s) / 32767.0).max(-1.0));
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    Vec3::new(x - fold.copysign(x), y - fold.copysign(y), z).normalize().into()
}
