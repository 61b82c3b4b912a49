//! Render graphs: TOML text → [`Document`] → checked [`Graph`] → [`Plan`].
//!
//! This crate knows neither wgpu nor naga: what a pass offers reaches it as a [`Contract`], and files through [`Files`]. Everything that is
//! wrong with a graph comes at once, as [`Faults`].
//!
//! ```
//! use aquifer_graph::*;
//! use std::collections::BTreeMap;
//!
//! /// One kind of pass: `paint`, with one output.
//! struct Painter;
//!
//! impl Contracts for Painter {
//!     fn kinds(&self) -> Vec<String> {
//!         vec!["paint".into()]
//!     }
//!     fn slots(&self) -> BTreeMap<String, Vec<String>> {
//!         BTreeMap::new()
//!     }
//!     fn contract(&self, kind: &str, _: &Slots) -> Result<Contract, ContractError> {
//!         if kind != "paint" {
//!             return Err(ContractError::UnknownKind { kind: kind.into(), known: self.kinds() });
//!         }
//!         let ty = WireType { element: "u32".into(), layout: "u32".into(), stride: 4, extent: Extent::Pixels };
//!         let image = Port { name: "image".into(), direction: Direction::Out, ty, optional: false, doc: String::new() };
//!         Ok(Contract { ports: vec![image], ..Contract::default() })
//!     }
//! }
//!
//! let source = Source::new("paint.toml", "transport = 'emission'\noutput = 'paint.image'\n[pass.paint]");
//! let mut document = Document::parse(source, &FsFiles)?;
//! document.apply([Source::new("--set", "transport=direct")])?;
//! let plan = Graph::check(&document, &Painter)?.plan(&NeedsAll, &[])?;
//! assert_eq!(plan.steps.len(), 1);
//!
//! document.apply([Source::new("--set", "output=paint.imago")])?;
//! let faults = Graph::check(&document, &Painter).unwrap_err();
//! assert!(faults.to_string().contains("did you mean `image`?"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bias;
mod blocks;
mod cause;
mod check;
mod contract;
mod document;
mod dot;
mod edit;
mod excerpt;
mod extends;
mod fault;
mod files;
mod flow;
mod graph;
mod json;
mod literal;
mod nearest;
mod needs;
mod params;
mod plan;
mod planner;
mod read;
mod source;
mod transport;
mod tree;
mod verify;
mod wire;
mod write;

pub use bias::*;
pub use blocks::*;
pub use cause::*;
pub use contract::*;
pub use document::*;
pub use extends::MAX_FILES;
pub use fault::*;
pub use files::*;
pub use graph::*;
pub use literal::*;
pub use nearest::nearest;
pub use needs::*;
pub use params::*;
pub use plan::*;
pub use planner::PlanError;
pub use source::*;
pub use transport::*;
pub use verify::*;
