//! What every pass shares: group 0, found by qualified name.

use crate::{Batch, Context, Error};
use aquifer_scene::Camera;

/// Where a frame stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameInfo {
    /// Number of the frame; random numbers are drawn from it and the seed.
    pub index: u32,
    /// Seed of the render.
    pub seed: u64,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Last frame's resources hold last frame, not zeros.
    pub history_valid: bool,
}

/// The owner of the frame's and the scene's resources.
pub trait Globals: Send {
    /// Brings uniforms, transforms and whatever else moves up to this frame; called once before its first pass.
    ///
    /// # Errors
    /// Any; the frame is then not rendered.
    fn advance(&mut self, context: &Context, frame: &FrameInfo) -> Result<(), Error>;

    /// What is bound to `name` of `module` (`triangles` of `scene/geometry`); `None` where this scene has no such thing.
    fn resource(&self, module: &str, name: &str) -> Option<wgpu::BindingResource<'_>>;

    /// Goes to another time of what moves, from the next frame on: seconds at frame 0, and from one frame to the next.
    fn set_time(&mut self, _time: f32, _step: f32) {}

    /// Looks from there, from the next frame on; `None`: through the camera that was named.
    fn set_camera(&mut self, _camera: Option<Camera>) {}

    /// The triangles that [`crate::Frame::scene`] gives to passes that draw.
    fn batches(&self) -> &[Batch] {
        &[]
    }

    /// A number that changes whenever [`Globals::resource`] begins to answer with other resources: bind groups are then made anew.
    fn generation(&self) -> u64 {
        0
    }
}

/// Globals for passes that use none.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoGlobals;

impl Globals for NoGlobals {
    fn advance(&mut self, _: &Context, _: &FrameInfo) -> Result<(), Error> {
        Ok(())
    }

    fn resource(&self, _: &str, _: &str) -> Option<wgpu::BindingResource<'_>> {
        None
    }
}
