//! What the passes of a graph cost: time, rays, and bytes.

use crate::Parts;
use aquifer_graph::{Direction, Life, Plan};
use aquifer_render::{Context, Renderer};
use serde_json::{Value, json};

/// Frames that are run; times are medians over them. Rays are means over as many, after these.
const FRAMES: u32 = 12;

/// What only shows the picture.
const SHOWING: [&str; 2] = ["accumulate", "tonemap"];

/// The costs of every pass that makes the picture, and what a pixel's reservoirs take. Rays are counted in a run of its own, since
/// counting takes time.
///
/// # Panics
/// When anything is wrong.
pub fn costs(context: &Context, parts: &Parts<'_>) -> Value {
    let mut renderer = parts.renderer(context);
    run(&mut renderer);
    let timings = renderer.timings();
    let plan = renderer.plan();
    // Rounds of a repeated pass are steps of their own.
    let mut passes: Vec<(&str, Vec<String>)> = Vec::new();
    for step in plan.steps.iter().filter(|step| !SHOWING.contains(&step.kind.as_str())) {
        match passes.last_mut() {
            Some((pass, nodes)) if *pass == step.pass => nodes.push(step.node.clone()),
            _ => passes.push((&step.pass, vec![step.node.clone()])),
        }
    }
    let ms = |node: &String| timings.passes.iter().find(|time| time.pass == *node).and_then(|time| time.median_ms).unwrap_or_default();
    let every: Vec<String> = passes.iter().flat_map(|(_, nodes)| nodes).cloned().collect();
    let rays = rays_of_frames(context, parts, &every);
    let mean_of = |node: &String| every.iter().position(|it| it == node).map_or(0.0, |i| rays[i].iter().sum::<f64>() / f64::from(FRAMES));
    let of_pass = |(pass, nodes): &(&str, Vec<String>)| {
        let rays: f64 = nodes.iter().map(mean_of).sum();
        json!({ "pass": pass, "ms": rounded(nodes.iter().map(ms).sum(), 100.0), "rays a pixel": rounded(rays, 1000.0) })
    };
    let all: f64 = passes.iter().flat_map(|(_, nodes)| nodes).map(ms).sum();
    let reservoir = plan.resources.iter().find(|resource| resource.name == "initial.reservoir").map(|resource| resource.ty.stride);
    json!({
        "passes": passes.iter().map(of_pass).collect::<Vec<_>>(), "ms": rounded(all, 100.0),
        "reservoir bytes": reservoir, "bytes a pixel": Traffic::of(plan).told(),
    })
}

fn rounded(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps
}

fn run(renderer: &mut Renderer) {
    (0..FRAMES).for_each(|_| renderer.frame().unwrap_or_else(|error| panic!("{error}")));
    renderer.finish().unwrap_or_else(|error| panic!("{error}"));
}

/// Rays a pixel of every node, in each of the frames after as many others.
///
/// # Panics
/// When anything is wrong.
pub fn rays_of_frames(context: &Context, parts: &Parts<'_>, nodes: &[String]) -> Vec<Vec<f64>> {
    let keep: Vec<String> = nodes.iter().map(|node| format!("{node}.traced")).collect();
    let keep: Vec<&str> = keep.iter().map(String::as_str).collect();
    let settings: Vec<&str> = parts.settings.iter().copied().chain(["slots.trace=counted"]).collect();
    let mut renderer = Parts { settings: &settings, keep: &keep, ..parts.clone() }.renderer(context);
    run(&mut renderer);
    let pixels = f64::from(parts.size[0] * parts.size[1]);
    let mut found = vec![Vec::new(); nodes.len()];
    for _ in 0..FRAMES {
        renderer.frame().unwrap_or_else(|error| panic!("{error}"));
        for (rays, port) in found.iter_mut().zip(&keep) {
            let words = renderer.read_f32(port).unwrap_or_else(|error| panic!("{error}"));
            rays.push(f64::from(words[0].to_bits()) / pixels);
        }
    }
    found
}

/// Bytes a pixel. Every wired port counts once, and neighbours' records not at all: the least that a pass must move.
#[derive(Default)]
struct Traffic {
    read: u32,
    written: u32,
    /// Of what a frame leaves to the next, both halves.
    history: u32,
}

impl Traffic {
    fn of(plan: &Plan) -> Self {
        let mut traffic = Self::default();
        for step in &plan.steps {
            for (port, binding) in step.contract.ports.iter().zip(&step.bindings) {
                let Some(half) = binding.resource else { continue };
                let bytes = plan.resources[half.resource].ty.stride;
                traffic.read += if port.direction == Direction::Out { 0 } else { bytes };
                traffic.written += if port.direction == Direction::In { 0 } else { bytes };
            }
        }
        traffic.history =
            plan.resources.iter().filter(|resource| resource.life == Life::History).map(|resource| 2 * resource.ty.stride).sum();
        traffic
    }

    fn told(&self) -> Value {
        json!({ "history": self.history, "read": self.read, "written": self.written })
    }
}
