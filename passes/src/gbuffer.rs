//! Pass `gbuffer`: draws the scene, then looks up what each pixel sees. All else is in its shader.

use aquifer_graph::Step;
use aquifer_render::{Frame, Pass, PassError, PassKind};

/// For the list of kinds.
pub const KIND: PassKind = PassKind { name: "gbuffer", about: "", shader: "pass/gbuffer", build };

struct Gbuffer;

fn build(_: &Step) -> Result<Box<dyn Pass>, PassError> {
    Ok(Box::new(Gbuffer))
}

impl Pass for Gbuffer {
    fn record(&mut self, frame: &mut Frame<'_>) -> Result<(), PassError> {
        frame.draw("nearest", frame.scene())?;
        frame.run("resolve")
    }
}
