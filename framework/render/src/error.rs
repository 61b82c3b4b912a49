//! Why a plan does not run.

use std::time::Duration;

/// One variant per cause. A pass is named as the graph file names it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The machine offers no adapter at all.
    #[error(
        "no GPU adapter found. A software adapter needs no GPU: install Mesa's lavapipe and the Vulkan loader \
         (Debian, Ubuntu: `apt install mesa-vulkan-drivers libvulkan1`; Fedora: `dnf install mesa-vulkan-drivers vulkan-loader`; \
         Arch: `pacman -S vulkan-swrast`)"
    )]
    NoAdapter,
    /// There are adapters, but none of that name.
    #[error("no adapter matches `{wanted}`; there are: {}", found.join(", "))]
    NoSuchAdapter {
        /// As asked.
        wanted: String,
        /// Names of all adapters.
        found: Vec<String>,
    },
    /// The driver refuses to make a device.
    #[error("adapter `{adapter}` gives no device: {message}")]
    NoDevice {
        /// The adapter.
        adapter: String,
        /// The driver's words.
        message: String,
    },
    /// The adapter is too small for what is asked of it.
    #[error("{what} needs {needed} {unit}, but the adapter offers {offered} ({limit}){cure}")]
    LimitTooSmall {
        /// A pass, an entry point or a resource.
        what: String,
        /// wgpu's name of the limit.
        limit: &'static str,
        /// What is counted: `bytes`, `storage buffers`, ….
        unit: &'static str,
        /// How many are needed.
        needed: u64,
        /// How many there are.
        offered: u64,
        /// What to do about it, from `; `, or empty.
        cure: &'static str,
    },
    /// The image has no pixels.
    #[error("an image of {width}x{height} pixels is empty")]
    EmptyImage {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// The device's memory is full.
    #[error("out of device memory in {what}: {message}")]
    OutOfMemory {
        /// What was being made.
        what: String,
        /// The driver's words.
        message: String,
    },
    /// The driver took the device away.
    #[error("the device was lost: {message}")]
    DeviceLost {
        /// The driver's words.
        message: String,
    },
    /// A bounded wait ran out.
    #[error("pass `{pass}` did not finish within {} s", limit.as_secs_f64())]
    Hung {
        /// The pass that was running.
        pass: String,
        /// How long was waited for it.
        limit: Duration,
    },
    /// wgpu refuses a pipeline, a binding or a command.
    #[error("pass `{pass}`: {message}")]
    Validation {
        /// The pass.
        pass: String,
        /// What wgpu says.
        message: String,
    },
    /// wgpu or the driver failed inside.
    #[error("pass `{pass}`: internal error of the driver: {message}")]
    Internal {
        /// The pass.
        pass: String,
        /// What wgpu says.
        message: String,
    },
    /// A kind of pass or its shader cannot be had; for graphs that were checked against the same registry this does not happen.
    #[error("pass `{pass}`: {source}")]
    Contract {
        /// The pass.
        pass: String,
        /// Why.
        source: aquifer_graph::ContractError,
    },
    /// A kind refuses to be built, or to record a frame.
    #[error("pass `{pass}`: {source}")]
    Pass {
        /// The pass.
        pass: String,
        /// Why.
        source: crate::PassError,
    },
    /// The shader has no entry point of that stage and name.
    #[error("`{shader}` has no {stage} entry point `{entry}`; there are: {}", known.join(", "))]
    NoEntry {
        /// The shader's label.
        shader: String,
        /// `compute`, `vertex` or `fragment`.
        stage: &'static str,
        /// As asked.
        entry: String,
        /// All entry points of that stage.
        known: Vec<String>,
    },
    /// Nothing was given for a binding.
    #[error("pass `{pass}`: nothing is bound to `{binding}`")]
    Unbound {
        /// The pass.
        pass: String,
        /// Qualified name of the binding, e.g. `scene/geometry::triangles`.
        binding: String,
    },
    /// A name that the shader does not declare was given a buffer or a value.
    #[error("`{shader}` declares no `{name}`; there are: {}", known.join(", "))]
    NoName {
        /// The shader's label.
        shader: String,
        /// As asked.
        name: String,
        /// What it declares.
        known: Vec<String>,
    },
    /// The plan has no such resource.
    #[error("no resource `{name}`; there are: {}", known.join(", "))]
    NoResource {
        /// As asked, `pass.port`.
        name: String,
        /// Every `pass.port` that holds something.
        known: Vec<String>,
    },
    /// The resource's memory is another's by the end of the frame.
    #[error("`{name}` is not kept after the frame: name it among what the plan keeps")]
    NotKept {
        /// The resource.
        name: String,
    },
    /// The resource is zeros that nobody stores.
    #[error("`{name}` holds only zeros: the pass that makes it was left out")]
    LeftOut {
        /// The resource.
        name: String,
    },
    /// The plan has no such pass.
    #[error("no pass `{pass}`; there are: {}", known.join(", "))]
    NoPass {
        /// As asked.
        pass: String,
        /// Every pass that runs.
        known: Vec<String>,
    },
    /// The value is of another type than the parameter.
    #[error("parameter `{name}` takes {expected}, not {value}")]
    WrongValue {
        /// The parameter.
        name: String,
        /// The type, as WGSL names it.
        expected: &'static str,
        /// The value given.
        value: String,
    },
    /// The host could not prepare the frame's globals.
    #[error("{0}")]
    Globals(String),
}

impl Error {
    /// Trying again later, or on a quieter machine, may help.
    pub fn is_temporary(&self) -> bool {
        matches!(self, Error::OutOfMemory { .. } | Error::DeviceLost { .. })
    }
}
