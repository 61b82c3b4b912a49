//! Resampling: combination rules against closed forms, planted bugs, and direct and indirect light against path tracing.

#[path = "restir/candidates.rs"]
mod candidates;
#[path = "restir/combine.rs"]
mod combine;
#[path = "restir/direct.rs"]
mod direct;
#[path = "restir/drawn.rs"]
mod drawn;
#[path = "restir/full.rs"]
mod full;
#[path = "restir/indirect.rs"]
mod indirect;
#[path = "restir/magnitude.rs"]
mod magnitude;
#[path = "restir/options.rs"]
mod options;
#[path = "restir/own_rule.rs"]
mod own_rule;
#[path = "restir/partition.rs"]
mod partition;
#[path = "restir/passes.rs"]
mod passes;
#[path = "restir/path_shift.rs"]
mod path_shift;
#[path = "restir/planted.rs"]
mod planted;
#[path = "restir/reconnection.rs"]
mod reconnection;
#[path = "restir/reproject.rs"]
mod reproject;
#[path = "restir/shading.rs"]
mod shading;
#[path = "restir/toy.rs"]
mod toy;
#[path = "restir/vanishing.rs"]
mod vanishing;
#[path = "restir/wires.rs"]
mod wires;
