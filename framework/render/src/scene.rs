//! A scene on the device: group 0 of every pass.
//!
//! Geometry, materials and textures are uploaded once. What moves is written anew for each frame, this frame's beside the last's.

mod mirror;
mod moving;
mod nodes;
mod still;
mod store;
mod wide;

use crate::{Batch, Context, Error, FrameInfo, Globals};
use aquifer_scene::{Camera, Features, Scene};
use moving::{Moving, State};
use std::sync::{Arc, OnceLock};
use still::Still;
use wide::Wide;

/// Which camera, and how time goes by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Name of the camera; `None` is the scene's first.
    pub camera: Option<String>,
    /// Looks from here, whatever the named camera does.
    pub free: Option<Camera>,
    /// Seconds at frame 0.
    pub time: f32,
    /// Seconds from one frame to the next; 0 stands still.
    pub step: f32,
    /// Film samples stay at the middle of the pixel.
    pub centred: bool,
}

impl View {
    /// Seconds at a frame.
    pub fn time_at(&self, frame: u32) -> f32 {
        // In f64: after 10⁶ frames an f32 product is milliseconds off.
        (f64::from(self.time) + f64::from(self.step) * f64::from(frame)) as f32
    }
}

/// The scene's resources on a device, seen through one camera.
pub struct SceneGlobals {
    scene: Arc<Scene>,
    view: View,
    still: Still,
    moving: Moving,
    batches: Vec<Batch>,
    last: Option<State>,
    /// What passes find as the frame before is `last` itself.
    before_is_last: bool,
    context: Context,
    /// `None` inside where it could not be made, which was told.
    wide: OnceLock<Option<Wide>>,
}

impl SceneGlobals {
    /// Uploads a finished scene.
    ///
    /// # Errors
    /// [`Error::LimitTooSmall`] names the array that the adapter cannot bind; [`Error::Globals`] for an unknown camera;
    /// [`Error::OutOfMemory`].
    pub fn new(context: &Context, scene: Arc<Scene>, view: View) -> Result<SceneGlobals, Error> {
        let features = Features::of(&scene);
        Self::keeping(context, scene, view, &features)
    }

    /// As [`SceneGlobals::new`], with what shaders of these features ask for, be they facts of the scene or not.
    ///
    /// # Errors
    /// As [`SceneGlobals::new`].
    pub fn keeping(context: &Context, scene: Arc<Scene>, view: View, features: &Features) -> Result<SceneGlobals, Error> {
        let still = Still::upload(context, &scene, features)?;
        let first = State::of(&scene, &still, &view, 0).map_err(refused)?;
        let room = if features.moving_objects { upper_levels(&scene, features)? } else { first.depth };
        let moving = Moving::new(context, &scene, features, &first, room)?;
        Ok(SceneGlobals {
            batches: batches(&scene),
            scene,
            view,
            still,
            moving,
            last: None,
            before_is_last: false,
            context: context.clone(),
            wide: OnceLock::new(),
        })
    }

    /// Entries of the traversal stack that a scene needs; the trace shaders take it as `scene/limits::STACK`.
    ///
    /// # Errors
    /// [`Error::Globals`] for a scene that was not finished.
    pub fn stack_depth(scene: &Scene, features: &Features) -> Result<u32, Error> {
        let lower = scene.meshes.iter().map(|mesh| mesh.bvh.depth).max().unwrap_or(0);
        // A multiple of 8, so that similar scenes share pipelines; not none, which no array may have, where there is nothing to hit.
        Ok((upper_levels(scene, features)? + lower).next_multiple_of(8).max(8))
    }

    fn wide(&self) -> Option<&Wide> {
        let make = || Wide::upload(&self.context, &self.scene);
        self.wide.get_or_init(|| make().inspect_err(|error| tracing::error!(%error, "no wide hierarchies")).ok()).as_ref()
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.arrays().map(|(_, bytes)| bytes).sum()
    }

    /// Every array by qualified name, with its bytes on the device.
    pub fn arrays(&self) -> impl Iterator<Item = (&'static str, u64)> {
        self.still.arrays().chain(self.moving.arrays())
    }

    /// Arrays that shaders of other features would have, each with the fact for want of which it is not there.
    pub fn left_out(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        self.still.left_out.iter().chain(&self.moving.left_out).copied()
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Looks through another camera, or at another time, from the next frame on.
    pub fn set_view(&mut self, view: View) {
        self.view = view;
    }
}

/// Neighbouring instances of one mesh make one batch.
fn batches(scene: &Scene) -> Vec<Batch> {
    let meshes: Vec<u32> = scene.nodes.iter().filter_map(|node| node.mesh).collect();
    let mut next = 0;
    let batch = |group: &[u32]| {
        let first = next;
        next += group.len() as u32;
        Batch { vertices: 0..3 * scene.meshes[group[0] as usize].triangles.len() as u32, instances: first..next }
    };
    meshes.chunk_by(|a, b| a == b).map(batch).collect()
}

/// Levels of the upper hierarchy that there is room for. That of a moving scene is rebuilt for every frame and may grow by 16 from what it is
/// at second 0, whatever moment comes first.
fn upper_levels(scene: &Scene, features: &Features) -> Result<u32, Error> {
    let moment = scene.at(0.0, None).map_err(refused)?;
    let slack = if features.moving_objects { 16 } else { 0 };
    Ok(aquifer_scene::Tlas::build(scene, &moment).bvh.depth + slack)
}

fn refused(error: aquifer_scene::SceneError) -> Error {
    Error::Globals(error.to_string())
}

impl Globals for SceneGlobals {
    fn advance(&mut self, context: &Context, frame: &FrameInfo) -> Result<(), Error> {
        let time = self.view.time_at(frame.index);
        let state = match self.last.take() {
            Some(last) if last.is_at(&self.view, time) => {
                // The frame before was of this moment too.
                if !std::mem::replace(&mut self.before_is_last, true) {
                    self.moving.write_before(context, &last)?;
                }
                last
            }
            last => {
                let new = State::of(&self.scene, &self.still, &self.view, frame.index).map_err(refused)?;
                self.moving.write_now(context, &new)?;
                // History starts as a copy of now, never as zeros.
                let last = last.filter(|_| frame.history_valid);
                self.before_is_last = last.is_none();
                self.moving.write_before(context, last.as_ref().unwrap_or(&new))?;
                new
            }
        };
        self.moving.write_frame(context, frame, &state, self.view.centred);
        self.last = Some(state);
        Ok(())
    }

    fn set_time(&mut self, time: f32, step: f32) {
        (self.view.time, self.view.step) = (time, step);
    }

    fn set_camera(&mut self, camera: Option<Camera>) {
        self.view.free = camera;
    }

    fn batches(&self) -> &[Batch] {
        &self.batches
    }

    fn resource(&self, module: &str, name: &str) -> Option<wgpu::BindingResource<'_>> {
        if module == "trace/cwbvh" {
            return self.wide()?.store(name).map(store::Store::binding);
        }
        let name = format!("{module}::{name}");
        self.moving.store(&name).or_else(|| self.still.store(&name)).map(store::Store::binding)
    }
}
