//! Measuring: image files, statistics, references. No command line, no window.
//!
//! [`film`] holds rendered images and their files, [`capture`] takes them off a renderer that [`stage`] made ready, [`metrics`] says how far
//! they are from a reference, [`stats`] decides what differences between them mean; [`compare`] holds graphs against each other, and [`page`]
//! tells people what that gave; [`explain`] says what a scene made superfluous; [`stress`] tries graphs on scenes at the ends of what numbers can
//! bear; [`watch`] tells when the files of an experiment change.
//! Everything here is deterministic: the same images give the same verdicts.

pub mod atomic;
pub mod bench;
pub mod capture;
pub mod compare;
pub mod explain;
pub mod film;
pub mod first_surface;
pub mod metrics;
pub mod page;
pub mod rays;
pub mod regress;
pub mod stage;
pub mod stats;
pub mod stress;
pub mod watch;
