//! Resampling: combination rules against closed forms, planted bugs, and direct light against the path tracer.

#[path = "restir/combine.rs"]
mod combine;
#[path = "restir/direct.rs"]
mod direct;
#[path = "restir/own_rule.rs"]
mod own_rule;
#[path = "restir/partition.rs"]
mod partition;
#[path = "restir/passes.rs"]
mod passes;
#[path = "restir/planted.rs"]
mod planted;
#[path = "restir/toy.rs"]
mod toy;
#[path = "restir/wires.rs"]
mod wires;
