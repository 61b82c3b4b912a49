//! The camera that the user moves: flies like a body, orbits like a hand.

use aquifer_scene::Camera;
use glam::{Affine3A, Mat3A, Quat, Vec3};

/// Radians that the whole height of the picture turns the view by.
const TURN: f32 = 2.5;
/// How much nearer a notch of the wheel brings what is orbited.
const NOTCH: f32 = 0.9;
/// The steepest look up or down, as the sine of the angle.
const STEEPEST: f32 = 0.995;

/// A camera with what it turns around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// Where it stands.
    pub camera: Camera,
    /// Distance to what it orbits.
    pub distance: f32,
    /// Metres a second.
    pub speed: f32,
}

impl Mover {
    /// Begins at a camera in a scene of that extent.
    pub fn new(camera: Camera, extent: f32) -> Self {
        let extent = if extent.is_finite() && extent > 0.0 { extent } else { 1.0 };
        Self { camera, distance: 0.5 * extent, speed: 0.2 * extent }
    }

    /// Goes along its own axes (right, up, back) for so many seconds.
    pub fn fly(&mut self, axes: Vec3, seconds: f32) {
        let step = self.camera.to_world.transform_vector3(axes) * self.speed * seconds;
        self.camera.to_world.translation += glam::Vec3A::from(step);
    }

    /// Looks elsewhere: drags in heights of the picture.
    pub fn look(&mut self, [right, down]: [f32; 2]) {
        self.turn(-right * TURN, -down * TURN);
    }

    /// Turns around what lies at [`Mover::distance`] before it.
    pub fn orbit(&mut self, [right, down]: [f32; 2]) {
        let centre = self.centre();
        self.turn(-right * TURN, -down * TURN);
        self.camera.to_world.translation = (centre + self.back() * self.distance).into();
    }

    /// Shifts across the view: drags in heights of the picture, so that what lies at [`Mover::distance`] follows the hand.
    pub fn pan(&mut self, [right, down]: [f32; 2]) {
        let height = 2.0 * (0.5 * self.camera.vertical_fov).tan() * self.distance;
        let step = self.camera.to_world.transform_vector3(Vec3::new(-right, down, 0.0)) * height;
        self.camera.to_world.translation += glam::Vec3A::from(step);
    }

    /// Goes nearer to what it orbits, by notches of the wheel.
    pub fn dolly(&mut self, notches: f32) {
        let centre = self.centre();
        self.distance *= NOTCH.powf(notches);
        self.camera.to_world.translation = (centre + self.back() * self.distance).into();
    }

    fn back(&self) -> Vec3 {
        self.camera.to_world.matrix3.z_axis.into()
    }

    fn centre(&self) -> Vec3 {
        self.camera.position() - self.back() * self.distance
    }

    /// Turns around the world's up, then up and down around its own axis, short of the poles.
    fn turn(&mut self, around: f32, up: f32) {
        let now = Quat::from_mat3a(&self.camera.to_world.matrix3);
        let turned = Quat::from_rotation_y(around) * now;
        let tilted = turned * Quat::from_rotation_x(up);
        let steep = |rotation: Quat| (rotation * Vec3::Z).y.abs();
        let rotation = if steep(tilted) > STEEPEST.max(steep(turned)) { turned } else { tilted };
        let matrix3 = Mat3A::from_quat(rotation.normalize());
        self.camera.to_world = Affine3A { matrix3, translation: self.camera.to_world.translation };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mover() -> Mover {
        let to_world = Affine3A::from_translation(Vec3::new(0.0, 1.0, 5.0));
        Mover::new(Camera { to_world, vertical_fov: 0.7, near: 0.1 }, 4.0)
    }

    #[test]
    fn orbiting_keeps_the_centre_and_the_distance() {
        let mut orbiting = mover();
        let centre = orbiting.centre();
        for step in 0..40 {
            orbiting.orbit([0.13, 0.07 * (step as f32).sin()]);
        }
        assert!((orbiting.centre() - centre).length() < 1e-4);
        assert!((orbiting.camera.position() - centre).length() - orbiting.distance < 1e-4);
        assert!((orbiting.camera.position() - mover().camera.position()).length() > 0.1, "it moved");
    }

    #[test]
    fn the_view_stays_level_and_short_of_the_poles() {
        let mut looking = mover();
        for _ in 0..100 {
            looking.look([0.03, -0.1]);
            let right = Vec3::from(looking.camera.to_world.matrix3.x_axis);
            assert!(right.y.abs() < 1e-4, "the horizon is level: {right}");
            assert!(looking.back().y.abs() <= STEEPEST);
        }
    }

    #[test]
    fn flying_goes_along_the_cameras_axes() {
        let mut flying = mover();
        flying.fly(Vec3::NEG_Z, 2.0);
        assert!((flying.camera.position() - Vec3::new(0.0, 1.0, 5.0 - 2.0 * flying.speed)).length() < 1e-5);
        let mut near = mover();
        near.dolly(1.0);
        assert!(near.camera.position().z < 5.0 && (near.centre() - mover().centre()).length() < 1e-4);
    }
}
