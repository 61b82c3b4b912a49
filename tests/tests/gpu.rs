//! Tests on the adapter, in one binary so that pipelines and device are shared.

#[path = "gpu/closed_forms.rs"]
mod closed_forms;
#[path = "gpu/determinism.rs"]
mod determinism;
#[path = "gpu/furnace.rs"]
mod furnace;
#[path = "gpu/gbuffer.rs"]
mod gbuffer;
#[path = "gpu/leaving_out.rs"]
mod leaving_out;
#[path = "gpu/light_grid.rs"]
mod light_grid;
#[path = "gpu/moving.rs"]
mod moving;
#[path = "gpu/sampling.rs"]
mod sampling;
#[path = "gpu/stage.rs"]
mod stage;
#[path = "gpu/traversal.rs"]
mod traversal;
