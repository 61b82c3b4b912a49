//! A scene in words and numbers.

use crate::failure::Failure;
use aquifer_scene::{Features, Scene};
use serde::Serialize;
use std::{collections::BTreeSet, fmt};

/// What a scene holds.
#[derive(Debug, Serialize)]
pub struct Description {
    name: String,
    meshes: usize,
    /// Each mesh counted once.
    triangles: usize,
    instances: usize,
    /// Each instance counted.
    placed_triangles: usize,
    materials: usize,
    images: usize,
    cameras: Vec<String>,
    punctual_lights: usize,
    environment: Option<[u32; 2]>,
    /// Seconds until the last key.
    animation_seconds: Option<f32>,
    /// Corners of the world-space bounding box, metres.
    bounds: Option<[[f32; 3]; 2]>,
    features: BTreeSet<&'static str>,
    warnings: Vec<String>,
}

impl Description {
    /// Looks at a finished scene at time 0.
    pub fn of(scene: &Scene) -> Result<Self, Failure> {
        let world = scene.world_transforms(0.0)?;
        let placed = || scene.nodes.iter().zip(&world).filter_map(|(node, world)| Some((&scene.meshes[node.mesh? as usize], world)));
        let corners = placed().flat_map(|(mesh, world)| mesh.positions.iter().map(|position| world.transform_point3(*position)));
        let bounds = corners.fold(None, |bounds, point| {
            let (low, high) = bounds.unwrap_or((point, point));
            Some((low.min(point), high.max(point)))
        });
        let last_keys = scene.animation.iter().filter_map(|channel| channel.times.last().copied());
        Ok(Self {
            name: scene.name.clone(),
            meshes: scene.meshes.len(),
            triangles: scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum(),
            instances: placed().count(),
            placed_triangles: placed().map(|(mesh, _)| mesh.triangles.len()).sum(),
            materials: scene.materials.len(),
            images: scene.images.len(),
            cameras: scene.camera_names(),
            punctual_lights: scene.nodes.iter().filter(|node| node.light.is_some()).count(),
            environment: scene.environment.as_ref().map(|environment| [environment.width, environment.height]),
            animation_seconds: last_keys.reduce(f32::max),
            bounds: bounds.map(|(low, high)| [low.to_array(), high.to_array()]),
            features: Features::of(scene).names(),
            warnings: scene.warnings.clone(),
        })
    }
}

impl fmt::Display for Description {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.name)?;
        writeln!(f, "  meshes       {}, of {} triangles", self.meshes, self.triangles)?;
        writeln!(f, "  instances    {}, of {} triangles", self.instances, self.placed_triangles)?;
        writeln!(f, "  materials    {}, with {} images", self.materials, self.images)?;
        writeln!(f, "  cameras      {}", self.cameras.join(", "))?;
        writeln!(f, "  lights       {} punctual", self.punctual_lights)?;
        if let Some([width, height]) = self.environment {
            writeln!(f, "  environment  {width}×{height}")?;
        }
        if let Some(seconds) = self.animation_seconds {
            writeln!(f, "  animation    {seconds} s")?;
        }
        if let Some([low, high]) = self.bounds {
            writeln!(f, "  bounds       {} to {} m", Point(low), Point(high))?;
        }
        write!(f, "  features     {}", self.features.iter().copied().collect::<Vec<_>>().join(", "))?;
        self.warnings.iter().try_for_each(|warning| write!(f, "\n  warning: {warning}"))
    }
}

struct Point([f32; 3]);

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "({x:.3}, {y:.3}, {z:.3})")
    }
}
