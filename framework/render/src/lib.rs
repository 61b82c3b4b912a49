//! The only room that names wgpu: runs plans on an adapter.
//!
//! A [`Context`] is an open device. A [`Registry`] composes the shaders of every kind of pass and tells the graph their contracts. A
//! [`Renderer`] takes a plan, a registry and [`Globals`], and renders frames. Shaders meet the host by name: layouts, numbers and offsets
//! come from reflection. A [`Kernel`] by itself runs one entry point on any buffers; [`run_once`] does so in one call, for tests, and a [`Job`] again and again, for timing.
//!
//! What is absent: this crate knows no pass, no domain, no file format and no window.

mod adapter;
mod cache;
mod context;
mod contract;
mod counters;
mod drawing;
mod error;
mod executor;
mod globals;
mod kernel;
mod layout;
mod limits;
mod node;
mod params;
mod pass;
mod pool;
mod program;
mod readback;
mod registry;
mod renderer;
mod run_once;
mod scene;
mod stamps;
mod targets;
mod timing;
mod workgroup_memory;

pub use adapter::{AdapterReport, adapters};
pub use context::{Context, ContextOptions, LimitChoice};
pub use counters::PortCounts;
pub use drawing::Batch;
pub use error::Error;
pub use globals::{FrameInfo, Globals, NoGlobals};
pub use kernel::Kernel;
pub use limits::{BINDING_SIZE, BUFFER_SIZE, Need};
pub use pass::{Frame, KernelPass, Pass, PassError, PassKind};
pub use pool::{MemoryReport, ResourceMemory};
pub use readback::read;
pub use registry::{Known, Registry};
pub use renderer::{Renderer, RendererOptions};
pub use run_once::{Data, Job, Once, run_once};
pub use scene::{SceneGlobals, View};
pub use timing::{Clock, PassTime, Startup, Timings};
