//! One file for every subcommand.

pub mod adapters;
pub mod bench;
pub mod check;
pub mod compare;
pub mod completions;
pub mod diff;
pub mod dot;
pub mod explain;
pub mod graphs;
pub mod man;
pub mod merge;
pub mod passes;
pub mod regress;
pub mod render;
pub mod report;
pub mod scenes;
pub mod schema;
pub mod stress;
#[cfg(feature = "viewer")]
pub mod view;
