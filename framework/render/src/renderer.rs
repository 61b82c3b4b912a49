//! A plan that renders frame after frame.

use crate::{Context, Error, FrameInfo, Globals, MemoryReport, PortCounts, Registry, Startup, Timings, executor::Executor, readback};
use aquifer_graph::{Plan, Value};
use aquifer_scene::Camera;

/// How to render.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RendererOptions {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of the first frame: renders of different frames are independent.
    pub first_frame: u32,
    /// Fills every output with NaN before the pass that must write it, so that what the pass leaves out shows.
    pub poison: bool,
    /// Counts the NaNs and infinities in what each pass writes, see [`Renderer::counts`]; this costs a dispatch for each output.
    pub counters: bool,
}

/// A plan on a device, with its globals and its place in time.
pub struct Renderer {
    context: Context,
    executor: Executor,
    globals: Box<dyn Globals>,
    options: RendererOptions,
    next: u32,
    history_valid: bool,
}

impl Renderer {
    /// Compiles a plan and allocates its memory.
    ///
    /// # Errors
    /// [`Error::EmptyImage`], [`Error::LimitTooSmall`] before anything is allocated, [`Error::Contract`], [`Error::Validation`],
    /// [`Error::OutOfMemory`].
    pub fn new(
        context: &Context,
        registry: &Registry,
        plan: Plan,
        globals: Box<dyn Globals>,
        options: RendererOptions,
    ) -> Result<Renderer, Error> {
        let executor = Executor::new(context, registry, plan, &options)?;
        Ok(Renderer { context: context.clone(), executor, globals, options, next: options.first_frame, history_valid: false })
    }

    /// Renders one frame. Returns when the frame is submitted; errors of the device may show in a later call.
    ///
    /// # Errors
    /// [`Error::Hung`] names the pass; [`Error::Pass`], [`Error::Unbound`], [`Error::Validation`], [`Error::DeviceLost`].
    pub fn frame(&mut self) -> Result<(), Error> {
        let RendererOptions { size, seed, .. } = self.options;
        let info = FrameInfo { index: self.next, seed, size, history_valid: self.history_valid };
        self.executor.frame(&info, &mut *self.globals)?;
        self.next = self.next.wrapping_add(1);
        self.history_valid = true;
        Ok(())
    }

    /// Waits until all frames are done.
    ///
    /// # Errors
    /// As [`Renderer::frame`].
    pub fn finish(&mut self) -> Result<(), Error> {
        self.executor.finish()
    }

    /// Begins anew at the first frame, with zeros for history.
    ///
    /// # Errors
    /// [`Error::DeviceLost`].
    pub fn restart(&mut self) -> Result<(), Error> {
        self.executor.restart()?;
        self.begin();
        Ok(())
    }

    /// Begins anew at another frame.
    ///
    /// # Errors
    /// As [`Renderer::restart`].
    pub fn restart_at(&mut self, first_frame: u32) -> Result<(), Error> {
        self.options.first_frame = first_frame;
        self.restart()
    }

    /// Begins anew with another seed, for independent renders of the same frames.
    ///
    /// # Errors
    /// As [`Renderer::restart`].
    pub fn reseed(&mut self, seed: u64) -> Result<(), Error> {
        self.options.seed = seed;
        self.restart()
    }

    fn begin(&mut self) {
        self.next = self.options.first_frame;
        self.history_valid = false;
    }

    /// Takes another plan, and begins anew. When the new plan does not compile, the old one goes on as if nothing had happened.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn replace_plan(&mut self, registry: &Registry, plan: Plan) -> Result<(), Error> {
        self.executor = Executor::new(&self.context, registry, plan, &self.options)?;
        self.begin();
        Ok(())
    }

    /// Takes another size, and begins anew. When there is no memory for it, the old size stays.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn resize(&mut self, registry: &Registry, size: [u32; 2]) -> Result<(), Error> {
        let plan = self.executor.plan().clone();
        let options = RendererOptions { size, ..self.options };
        self.executor = Executor::new(&self.context, registry, plan, &options)?;
        self.options = options;
        self.begin();
        Ok(())
    }

    /// Takes other globals, of the same scene features, and begins anew.
    ///
    /// # Errors
    /// As [`Renderer::restart`].
    pub fn replace_globals(&mut self, globals: Box<dyn Globals>) -> Result<(), Error> {
        self.globals = globals;
        self.executor.forget_globals();
        self.restart()
    }

    /// Goes to another time of the scene from the next frame on: seconds at frame 0, and from one frame to the next. History stays as it is.
    pub fn set_time(&mut self, time: f32, step: f32) {
        self.globals.set_time(time, step);
    }

    /// Looks from there, from the next frame on; `None`: through the camera that was named. History stays as it is.
    pub fn set_camera(&mut self, camera: Option<Camera>) {
        self.globals.set_camera(camera);
    }

    /// Sets a live parameter from the next frame on; history stays as it is.
    ///
    /// # Errors
    /// [`Error::NoPass`], [`Error::Pass`] for a parameter that is not live or a value of the wrong type.
    pub fn set_param(&mut self, pass: &str, name: &str, value: Value) -> Result<(), Error> {
        self.executor.set(pass, name, value)
    }

    /// The bytes of a resource after the last frame: by name (`accumulate.mean`), or by any `pass.port` that it is wired to.
    ///
    /// # Errors
    /// [`Error::NoResource`], [`Error::NotKept`], and what [`Renderer::frame`] may give.
    pub fn read(&mut self, name: &str) -> Result<Vec<u8>, Error> {
        self.finish()?;
        let part = self.executor.part(name)?;
        readback::read(&self.context, name, part.buffer, 0, part.bytes)
    }

    /// As [`Renderer::read`], for resources of floats.
    ///
    /// # Errors
    /// As [`Renderer::read`].
    pub fn read_f32(&mut self, name: &str) -> Result<Vec<f32>, Error> {
        let bytes = self.read(name)?;
        Ok(bytes.chunks_exact(4).map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect())
    }

    /// The buffer of a resource after the last frame with the bytes that count, for copies on the device. After the next frame it may
    /// hold something else.
    ///
    /// # Errors
    /// [`Error::NoResource`], [`Error::NotKept`].
    pub fn buffer(&self, name: &str) -> Result<(&wgpu::Buffer, u64), Error> {
        self.executor.part(name).map(|part| (part.buffer, part.bytes))
    }

    /// Name of the plan's output.
    pub fn output(&self) -> &str {
        &self.plan().resources[self.plan().output].name
    }

    /// What runs.
    pub fn plan(&self) -> &Plan {
        self.executor.plan()
    }

    /// How it renders.
    pub fn options(&self) -> &RendererOptions {
        &self.options
    }

    /// The device.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// The frame's and the scene's resources.
    pub fn globals(&self) -> &dyn Globals {
        &*self.globals
    }

    /// Number of the frame that comes next.
    pub fn next_frame(&self) -> u32 {
        self.next
    }

    /// Times of all passes, of frames that are done; [`Renderer::finish`] makes that all.
    pub fn timings(&self) -> Timings {
        self.executor.timings()
    }

    /// How long it took until the first frame.
    pub fn startup(&self) -> Startup {
        self.executor.startup()
    }

    /// Where memory goes.
    pub fn memory(&self) -> &MemoryReport {
        self.executor.memory()
    }

    /// NaNs and infinities in every output that holds floats, in order of execution, of all frames since plan and size are these: restarts do not
    /// forget. Nothing without [`RendererOptions::counters`].
    ///
    /// # Errors
    /// As [`Renderer::frame`].
    pub fn counts(&mut self) -> Result<Vec<PortCounts>, Error> {
        self.finish()?;
        self.executor.counts()
    }

    /// What passes have to say, by name.
    pub fn reports(&self) -> Vec<(String, String)> {
        self.executor.reports()
    }
}
