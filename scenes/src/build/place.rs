//! Where a node stands.

use glam::{Affine3A, Mat3, Quat, Vec3};

/// Translation, rotation and scale of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Metres.
    pub translation: Vec3,
    /// Unit quaternion.
    pub rotation: Quat,
    /// By axis.
    pub scale: Vec3,
}

impl Place {
    /// The origin, unturned, unscaled.
    pub const ORIGIN: Self = Self { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE };

    /// At a point, unturned, unscaled.
    pub fn at(x: f32, y: f32, z: f32) -> Self {
        Self { translation: Vec3::new(x, y, z), ..Self::ORIGIN }
    }

    /// Turned about +Y by an angle in degrees, counter-clockwise seen from above.
    pub fn turned(self, degrees: f32) -> Self {
        self.rotated(Quat::from_rotation_y(degrees.to_radians()))
    }

    /// With another rotation.
    pub fn rotated(self, rotation: Quat) -> Self {
        Self { rotation, ..self }
    }

    /// With another scale, the same on all axes.
    pub fn sized(self, scale: f32) -> Self {
        self.stretched(Vec3::splat(scale))
    }

    /// With another scale.
    pub fn stretched(self, scale: Vec3) -> Self {
        Self { scale, ..self }
    }

    /// Own space to the parent's.
    pub fn affine(&self) -> Affine3A {
        Affine3A::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// The rotation that points −Z along `direction` with +Y as far up as it goes: for cameras, spots and suns.
pub fn facing(direction: Vec3) -> Quat {
    let back = -direction.normalize();
    let up = if back.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
    let right = up.cross(back).normalize();
    Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facing_points_minus_z_along_the_direction_and_keeps_the_horizon_level() {
        for direction in [Vec3::new(0.3, -0.5, -2.0), Vec3::X, Vec3::Z, Vec3::NEG_Y, Vec3::Y, Vec3::new(-1.0, 4.0, 0.2)] {
            let rotation = facing(direction);
            assert!((rotation * Vec3::NEG_Z).distance(direction.normalize()) < 1e-6, "{direction}");
            assert!((rotation * Vec3::X).y.abs() < 1e-6, "{direction}");
            assert!((rotation * Vec3::Y).y >= -1e-6, "{direction}");
        }
    }
}
