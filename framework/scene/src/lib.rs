//! glTF to plain arrays and bounding volume hierarchies.
//!
//! This crate knows no wgpu and no graph files. A [`Scene`] is everything that can be drawn, in plain arrays; a [`Moment`] is
//! that scene at one time: world transforms, world lights, one camera. A [`Bvh`] in each [`Mesh`] and a [`Tlas`] for each moment make
//! the two-level hierarchy; [`LightList`] says what can be sampled as a light; [`Features`] are the facts of the
//! loaded scene that decide what the renderer may leave out.

mod alias;
mod animation;
mod bvh;
mod camera;
mod emission;
mod environment;
mod error;
mod features;
mod finish;
mod lights;
mod load;
mod mesh;
mod moment;
mod scene;
mod tlas;
mod trace;
mod unit;
mod wide;

pub use alias::{AliasEntry, AliasTable};
pub use bvh::{Bvh, BvhNode, BvhOptions, BvhQuality};
pub use camera::Camera;
pub use emission::{Emitters, MeshEmitters};
pub use environment::EnvironmentDistribution;
pub use error::SceneError;
pub use features::Features;
pub use lights::{EmissiveTriangle, Light, LightList};
pub use load::*;
pub use scene::*;
pub use tlas::Tlas;
pub use trace::{CpuTracer, Hit};
pub use wide::WideBvh;
