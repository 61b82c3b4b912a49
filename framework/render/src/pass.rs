//! Kinds of passes: what is known without a device, and what runs on it.

use crate::{Batch, FrameInfo, node::Work};
use aquifer_graph::{Step, Value};

/// The static half of a kind of pass: listed, documented and checked without a device. Its ports and parameters are not said here: they
/// are those of its shader.
#[derive(Clone, Copy, Debug)]
pub struct PassKind {
    /// As a graph file names it.
    pub name: &'static str,
    /// One sentence; empty takes the first sentence of the shader's manual page.
    pub about: &'static str,
    /// Module path of the shader, e.g. `pass/temporal`.
    pub shader: &'static str,
    /// Makes the half that runs.
    pub build: fn(&Step) -> Result<Box<dyn Pass>, PassError>,
}

/// The half of a pass that runs: it decides what to dispatch and what to draw. Memory, bindings, parameters and timing are the executor's.
pub trait Pass: Send {
    /// Records one frame.
    ///
    /// # Errors
    /// See [`PassError`]; the frame is then not rendered.
    fn record(&mut self, frame: &mut Frame<'_>) -> Result<(), PassError>;

    /// All memory has become zeros; host state goes back to its beginning too.
    fn restart(&mut self) {}

    /// What the pass has to say about its last frames.
    fn report(&self) -> Option<String> {
        None
    }
}

/// Why a pass does not run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PassError {
    /// Its shader has no such entry point.
    #[error("no {stage} entry point `{entry}`; there are: {}", known.join(", "))]
    NoEntry {
        /// `compute` or `fragment`.
        stage: &'static str,
        /// As asked.
        entry: String,
        /// All there are.
        known: Vec<String>,
    },
    /// Its shader has no such live parameter.
    #[error("no live parameter `{name}`; there are: {}", known.join(", "))]
    NotLive {
        /// As asked.
        name: String,
        /// All there are.
        known: Vec<String>,
    },
    /// A live parameter is of another type.
    #[error("{0}")]
    WrongValue(String),
    /// The pass itself refuses, in its own words.
    #[error("{0}")]
    Refused(String),
}

/// One frame of one pass, while it is recorded: what is asked for here becomes commands afterwards, in this order.
pub struct Frame<'a> {
    pub(crate) info: &'a FrameInfo,
    pub(crate) work: &'a mut Work,
    pub(crate) scene: &'a [Batch],
    pub(crate) jobs: Vec<Job>,
}

/// What a pass asked for.
#[derive(Clone, Debug)]
pub(crate) enum Job {
    /// A kernel, by its place among the compute entry points.
    Dispatch { kernel: usize, workgroups: [u32; 3] },
    /// A drawing, by its place among the fragment entry points.
    Draw { drawing: usize, batches: Vec<Batch> },
}

impl<'a> Frame<'a> {
    /// Where the frame stands.
    pub fn info(&self) -> &FrameInfo {
        self.info
    }

    /// Compute entry points of the shader, in order of declaration.
    pub fn entries(&self) -> impl Iterator<Item = &str> {
        self.work.entries()
    }

    /// Dispatches every entry point, in order of declaration, over what it writes.
    pub fn run_all(&mut self) {
        self.jobs.extend(self.work.dispatch_all());
    }

    /// Dispatches one entry point over what it writes.
    ///
    /// # Errors
    /// [`PassError::NoEntry`].
    pub fn run(&mut self, entry: &str) -> Result<(), PassError> {
        self.jobs.push(self.work.dispatch(entry, None)?);
        Ok(())
    }

    /// Dispatches one entry point with so many workgroups.
    ///
    /// # Errors
    /// [`PassError::NoEntry`].
    pub fn dispatch(&mut self, entry: &str, workgroups: [u32; 3]) -> Result<(), PassError> {
        self.jobs.push(self.work.dispatch(entry, Some(workgroups))?);
        Ok(())
    }

    /// The triangles of the scene, for [`Frame::draw`]: a batch's instances are the scene's by number, and its vertices those of their mesh.
    pub fn scene(&self) -> &'a [Batch] {
        self.scene
    }

    /// Draws with a fragment entry point, behind the shader's vertex entry point. What it gives lands in images of the size of the frame, which are
    /// zeros where nothing was drawn; compute entry points read them as textures of group 1 with the same names.
    ///
    /// # Errors
    /// [`PassError::NoEntry`].
    pub fn draw(&mut self, fragment: &str, batches: &[Batch]) -> Result<(), PassError> {
        self.jobs.push(self.work.draw(fragment, batches)?);
        Ok(())
    }

    /// Sets a live parameter, from this frame on. One frame sees one value: dispatches recorded before see it too.
    ///
    /// # Errors
    /// [`PassError::NotLive`], [`PassError::WrongValue`].
    pub fn set(&mut self, name: &str, value: Value) -> Result<(), PassError> {
        self.work.set(name, value)
    }
}

/// A pass that is nothing but its shader: every compute entry point, every frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct KernelPass;

impl KernelPass {
    /// For [`PassKind::build`].
    ///
    /// # Errors
    /// None.
    pub fn build(_: &Step) -> Result<Box<dyn Pass>, PassError> {
        Ok(Box::new(KernelPass))
    }
}

impl Pass for KernelPass {
    fn record(&mut self, frame: &mut Frame<'_>) -> Result<(), PassError> {
        if let Some(fragment) = frame.work.fragments().next() {
            let message =
                format!("fragment entry point `{fragment}` is drawn by nobody: that takes host code, see `aquifer_render::PassKind`");
            return Err(PassError::Refused(message));
        }
        frame.run_all();
        Ok(())
    }
}
