//! Scenes made in code: deterministic, and exportable as glTF.
//!
//! [`all`] lists the scenes that come with Aquifer, each a function without arguments that returns a plain [`Scene`]. [`build`] is what
//! they are made with, open to tests and to scenes of your own; [`export()`] writes any scene as `.glb`.
//!
//! Nothing here reads a clock, a file or a global random state: the same code gives the same scene, to the bit. This crate knows no GPU and
//! no graph files, and it leaves checking and hierarchies to `aquifer-scene`: the scenes come as a careful author would have typed them.
//!
//! ```
//! let cornell = aquifer_scenes::by_name("cornell").expect("it is in the list");
//! let scene = (cornell.make)();
//! let file = aquifer_scenes::export(&scene)?;
//! assert_eq!(&file.glb[..4], b"glTF");
//! # Ok::<(), aquifer_scenes::ExportError>(())
//! ```

pub mod build;
mod export;
pub mod gallery;

pub use aquifer_scene::Scene;
pub use export::{ExportError, Exported, export};
pub use gallery::{Generator, all, by_name};
