//! The command line as a program: what it prints where, how it exits, what it leaves on disk.

#[path = "cli/compare.rs"]
mod compare;
#[path = "cli/dark_triangle.rs"]
mod dark_triangle;
#[path = "cli/explain.rs"]
mod explain;
#[path = "cli/films.rs"]
mod films;
#[path = "cli/graphs.rs"]
mod graphs;
#[path = "cli/images.rs"]
mod images;
#[path = "cli/interrupted.rs"]
mod interrupted;
#[path = "cli/manners.rs"]
mod manners;
#[path = "cli/protocols.rs"]
mod protocols;
#[path = "cli/regress.rs"]
mod regress;
#[path = "cli/render.rs"]
mod render;
#[path = "cli/robust.rs"]
mod robust;
#[path = "cli/run.rs"]
mod run;
#[path = "cli/scenes.rs"]
mod scenes;
