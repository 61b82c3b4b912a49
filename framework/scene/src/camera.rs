//! The pinhole camera in the world.

use glam::{Affine3A, Mat3A, Vec3};

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

    /// The same lens at `from`, looking at `at` with a level horizon; `None` where the two leave no direction.
    pub fn looking(self, from: Vec3, at: Vec3) -> Option<Camera> {
        let back = (from - at).try_normalize()?;
        let right = Vec3::Y.cross(back).try_normalize()?;
        let matrix3 = Mat3A::from_cols(right.into(), back.cross(right).into(), back.into());
        Some(Camera { to_world: Affine3A { matrix3, translation: from.into() }, ..self })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looking_there_puts_it_in_the_middle() {
        let lens = Camera { to_world: Affine3A::IDENTITY, vertical_fov: 0.8, near: 0.1 };
        let (from, at) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-2.0, 0.5, 1.0));
        let camera = lens.looking(from, at).unwrap();
        assert_eq!(camera.position(), from);
        assert!((camera.ray([32.0, 18.0], [64, 36]) - (at - from).normalize()).length() < 1e-6);
        assert!(camera.to_world.matrix3.x_axis.y.abs() < 1e-6 && camera.to_world.matrix3.determinant() > 0.99);
        assert_eq!((lens.looking(from, from), lens.looking(from, from + Vec3::Y)), (None, None));
    }
}
