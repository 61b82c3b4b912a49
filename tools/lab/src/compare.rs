//! Comparing graphs: how long each takes, how far from the truth it is then, and whether the difference is more than chance.

pub mod bench;
pub mod bias;
pub mod budget;
pub mod correlation;
pub mod error;
pub mod evaluate;
pub mod explain;
pub mod further;
pub mod judge;
pub mod observer;
pub mod reach;
pub mod reference;
pub mod report;
pub mod scene;
pub mod store;
pub mod subject;
pub mod summary;

#[cfg(test)]
mod known;
