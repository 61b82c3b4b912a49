//! WGSL modules to composed, reflected shaders.
//!
//! This crate knows neither wgpu nor graph files. A [`Library`] holds modules by path; [`Library::compose`] links one entry module with
//! what it imports, fills its slots, and gives a naga module with an [`Interface`] that says by name what the host must bind.
//!
//! Modules are WGSL with WESL's imports and conditions. A module imports an open module, a **slot**, as `package::slot::domain`;
//! the [`Specialisation`] says which file stands there. Binding numbers in the text mean nothing: the composer gives its own.
//!
//! The linker is WESL, behind the one file `compose.rs`: it gives text (so names stay readable and naga reflects it as any WGSL), a slot is
//! one rewritten import path, and no construct of the language is out of bounds in a module. What it costs is that naga's type errors point
//! into the linked text; `locate.rs` finds the source line again.

mod comments;
mod compose;
mod cuts;
mod error;
mod facts;
mod imports;
mod interface;
mod library;
mod locate;
mod near;
mod reflect;
mod slots;
mod source;

pub use comments::BiasLine;
pub use compose::{Composed, Specialisation};
pub use cuts::{Cut, Piece};
pub use error::ShaderError;
pub use interface::*;
pub use library::{Library, PASSES};
