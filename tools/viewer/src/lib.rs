//! Two live graphs in a window: one scene, one camera, equal time.
//!
//! A [`session::Session`] renders in a thread of its own, without any window: messages go in, and what it last did lies on its
//! [board](session::Board). [`window`] shows the board and sends messages; it never waits for a device, a compiler or a file.

pub mod camera;
pub mod develop;
pub mod opening;
pub mod record;
pub mod save;
pub mod session;
pub mod testimony;
pub mod window;

pub use opening::{Loaded, Opening, Recipe};
pub use window::{ViewError, run};
