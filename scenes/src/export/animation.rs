//! What moves, as one animation with a sampler a channel.

use super::buffer::{Buffer, Usage};
use super::{ExportError, error};
use aquifer_scene::{Channel, Interpolation, Scene, Track};
use serde_json::{Value, json};

pub(super) fn animations(scene: &Scene, buffer: &mut Buffer) -> Result<Vec<Value>, ExportError> {
    if scene.animation.is_empty() {
        return Ok(Vec::new());
    }
    let mut samplers = Vec::new();
    let mut channels = Vec::new();
    for channel in &scene.animation {
        error::index(channel.node, scene.nodes.len(), || "an animation channel".into())?;
        let (path, output) = values(channel, buffer)?;
        let times: Vec<[f32; 1]> = channel.times.iter().map(|time| [*time]).collect();
        let input = buffer.bounded_floats(&times, Usage::Other, || "a key time".into())?;
        let interpolation = match channel.interpolation {
            Interpolation::Step => "STEP",
            Interpolation::Linear => "LINEAR",
            Interpolation::CubicSpline => "CUBICSPLINE",
        };
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": channel.node, "path": path } }));
        samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
    }
    Ok(vec![json!({ "samplers": samplers, "channels": channels })])
}

/// glTF's name of the property, and the accessor of its key values.
fn values(channel: &Channel, buffer: &mut Buffer) -> Result<(&'static str, usize), ExportError> {
    let what = || format!("the animation of node {}", channel.node);
    let a_key = if channel.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let expected = channel.times.len().max(1) * a_key;
    Ok(match &channel.track {
        Track::Translation(values) => ("translation", vectors(buffer, values, expected, what)?),
        Track::Scale(values) => ("scale", vectors(buffer, values, expected, what)?),
        Track::Rotation(values) => ("rotation", vectors(buffer, values, expected, what)?),
    })
}

fn vectors<const N: usize, V: Copy + Into<[f32; N]>>(
    buffer: &mut Buffer,
    values: &[V],
    expected: usize,
    what: impl Fn() -> String,
) -> Result<usize, ExportError> {
    error::length(values.len(), expected, &what)?;
    let values: Vec<[f32; N]> = values.iter().map(|value| (*value).into()).collect();
    buffer.floats(&values, Usage::Other, what)
}
