//! Speed: contestants take turns in one run, so that what else the machine does falls on all alike; medians and ratios are told.

pub mod auto;
pub mod device;
pub mod host;
pub mod loading;
pub mod passes;
pub mod rays;
pub mod tracing;
pub mod turns;
