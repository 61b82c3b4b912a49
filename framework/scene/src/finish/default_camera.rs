//! A camera for scenes that bring none.

use crate::{
    Lens, Node, Scene, SceneError,
    tlas::{transformed, within_reach},
};
use glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};
use obvhs::aabb::Aabb;

const NAME: &str = "default";
/// Full vertical field of view, radians (40°).
const VERTICAL_FOV: f32 = 40.0 * std::f32::consts::PI / 180.0;

/// Frames the bounding sphere of the scene at time 0 from the front, a little above and to the right.
pub(super) fn add_if_missing(scene: &mut Scene) -> Result<(), SceneError> {
    if scene.nodes.iter().any(|node| node.camera.is_some()) {
        return Ok(());
    }
    let bounds = world_bounds(scene)?;
    let radius = (bounds.diagonal().length() * 0.5).max(1e-3);
    let towards_viewer = Vec3A::new(0.4, 0.3, 1.0).normalize();
    let distance = radius / (VERTICAL_FOV * 0.5).sin();
    let right = Vec3A::Y.cross(towards_viewer).normalize();
    let axes = Mat3A::from_cols(right, towards_viewer.cross(right), towards_viewer);
    scene.nodes.push(Node {
        name: NAME.to_owned(),
        translation: Vec3::from(bounds.center() + towards_viewer * distance),
        rotation: Quat::from_mat3a(&axes),
        camera: Some(scene.cameras.len() as u32),
        ..Node::default()
    });
    scene.cameras.push(Lens { name: NAME.to_owned(), vertical_fov: VERTICAL_FOV, aspect: None, near: radius * 1e-3 });
    scene.warnings.push(format!("no camera in the scene: `{NAME}` frames it"));
    Ok(())
}

/// Box of what can be hit; of a unit sphere when that is nothing.
fn world_bounds(scene: &Scene) -> Result<Aabb, SceneError> {
    let world = scene.world_transforms(0.0)?;
    let placed = |(node, transform): (&Node, &Affine3A)| {
        let local = scene.meshes[node.mesh? as usize].bvh.bounds()?;
        Some(transformed(&local, transform)).filter(within_reach)
    };
    let boxes = scene.nodes.iter().zip(&world).filter_map(placed);
    Ok(boxes.reduce(|a, b| a.union(&b)).unwrap_or(Aabb::new(-Vec3A::ONE, Vec3A::ONE)))
}
