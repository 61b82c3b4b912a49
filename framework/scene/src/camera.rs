//! The pinhole camera in the world.

use glam::{Affine3A, Vec3};

/// A placed pinhole camera: it looks down −Z of `to_world`, +Y up, no scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Camera to world; rigid.
    pub to_world: Affine3A,
    /// Full vertical field of view, radians.
    pub vertical_fov: f32,
    /// Near plane in metres, as the file has it: no pass cuts anything off there.
    pub near: f32,
}

impl Camera {
    /// World position of the pinhole.
    pub fn position(&self) -> Vec3 {
        self.to_world.translation.into()
    }

    /// Unit direction through the film point (x, y) in pixels from the top left, for a film of `size` pixels.
    pub fn ray(&self, film: [f32; 2], size: [u32; 2]) -> Vec3 {
        let half = (self.vertical_fov * 0.5).tan();
        let (w, h) = (size[0] as f32, size[1] as f32);
        let x = (2.0 * film[0] - w) / h * half;
        let y = (h - 2.0 * film[1]) / h * half;
        self.to_world.transform_vector3(Vec3::new(x, y, -1.0)).normalize()
    }
}
