//! From a renderer to films.
//!
//! What a graph shows (its output) is display-referred. What it measures lies further up its wires: the running mean of radiance, kept with
//! its sum of squares by a pass whose output has elements called [`MOMENTS`]. Both are found in the graph, not assumed.

use crate::film::{Film, FilmError};
use aquifer_graph::{Graph, Plan, PortId, Value, When, WireType};
use aquifer_render::Renderer;
use std::collections::{BTreeSet, VecDeque};

/// Element of the resource that holds running means: members `mean`, `count` and `squares`.
pub const MOMENTS: &str = "Moments";

/// Why no film can be taken.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// The renderer cannot give the pixels.
    #[error(transparent)]
    Render(#[from] aquifer_render::Error),
    /// The pixels do not fit the image.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// The output is nothing that can be seen.
    #[error("output `{name}` holds `{element}`, which is no picture: vec3<f32> or vec4<f32> is")]
    NoPicture {
        /// The resource.
        name: String,
        /// What it holds.
        element: String,
    },
    /// The elements of a resource lack a member.
    #[error("`{name}` has no member `{member}`")]
    NoMember {
        /// The resource.
        name: String,
        /// The member.
        member: &'static str,
    },
}

/// What of a graph makes a film.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capture {
    moments: Option<String>,
    /// What `moments` is the mean of.
    frame: Option<PortId>,
    /// Frames do not share samples, so that their spread tells the variance of their mean.
    independent: bool,
}

impl Capture {
    /// Finds the running mean nearest to the graph's output.
    pub fn of(graph: &Graph) -> Self {
        let averaging = upstream(graph).into_iter().find_map(|node| Some((node, moments_of(graph, node)?)));
        let frame = averaging.as_ref().and_then(|(node, _)| frame_of(graph, *node));
        let moments = averaging.map(|(_, name)| name);
        let remembers = |(index, node): (usize, &aquifer_graph::Node)| {
            let averages = moments_of(graph, index).is_some();
            !averages && node.wires.iter().flatten().any(|wire| wire.when == When::Previous)
        };
        Self { moments, frame, independent: !graph.nodes().iter().enumerate().any(remembers) }
    }

    /// Resources that the plan must keep.
    pub fn keep(&self) -> Vec<&str> {
        self.moments.iter().map(String::as_str).collect()
    }

    /// Frames share no samples: their mean gets better with their number, and its variance shows in their spread.
    pub fn independent(&self) -> bool {
        self.independent
    }

    /// The resource that holds the radiance of a single frame: what is averaged, or the output where nothing is.
    pub fn frame_port(&self, graph: &Graph) -> PortId {
        self.frame.unwrap_or(graph.output())
    }

    /// Names of the nodes that the radiance of a frame needs, in this frame or in frames before: what only shows or averages is not among them.
    pub fn makers(&self, graph: &Graph) -> BTreeSet<String> {
        let mut open = vec![self.frame_port(graph).node];
        let mut needed = BTreeSet::new();
        while let Some(node) = open.pop() {
            let node = &graph.nodes()[node];
            if needed.insert(node.name.clone()) {
                open.extend(node.wires.iter().flatten().map(|wire| wire.from.node));
            }
        }
        needed
    }

    /// Radiance of the last frame alone, from the resource that [`Capture::frame_port`] names.
    pub fn last_frame(&self, graph: &Graph, renderer: &mut Renderer) -> Result<Film, CaptureError> {
        let port = self.frame_port(graph);
        let ty = &graph.nodes()[port.node].port(port.port).ty;
        picture(renderer, graph.port_name(port), &ty.element, ty.stride)
    }

    /// Samples that every pixel gets in a frame: passes that can take several have a parameter called `samples`.
    pub fn samples_per_frame(graph: &Graph) -> u32 {
        let samples = graph.nodes().iter().filter_map(|node| match node.params.get("samples") {
            Some(&Value::U32(samples)) => Some(samples),
            _ => None,
        });
        samples.max().unwrap_or(1)
    }

    /// Does the film hold the mean over frames, or only the last frame's output?
    pub fn averages(&self) -> bool {
        self.moments.is_some()
    }

    /// The mean over frames, with its variance where frames are independent; the last frame's output where nothing is averaged.
    pub fn radiance(&self, renderer: &mut Renderer) -> Result<Film, CaptureError> {
        let Some(name) = &self.moments else { return self.display(renderer) };
        let members = Members::of(renderer.plan(), name)?;
        let words = renderer.read_f32(name)?;
        let records = || words.chunks_exact(members.stride);
        let color = records().map(|record| three(record, members.mean)).collect();
        let counted = self.independent && records().all(|record| record[members.count].to_bits() >= 2);
        let variance = |record: &[f32]| {
            let n = f64::from(record[members.count].to_bits());
            three(record, members.squares).map(|squares| (f64::from(squares) / (n * (n - 1.0))) as f32)
        };
        let film = Film::new(renderer.options().size, color)?;
        Ok(Film { variance: counted.then(|| records().map(variance).collect()), ..film })
    }

    /// What the graph shows: linear and display-referred.
    pub fn display(&self, renderer: &mut Renderer) -> Result<Film, CaptureError> {
        let output = &renderer.plan().resources[renderer.plan().output];
        let (name, element, stride) = (output.name.clone(), output.ty.element.clone(), output.ty.stride);
        picture(renderer, name, &element, stride)
    }
}

/// A resource of colours as a film.
fn picture(renderer: &mut Renderer, name: String, element: &str, stride: u32) -> Result<Film, CaptureError> {
    if !matches!(element, "vec3<f32>" | "vec4<f32>") {
        return Err(CaptureError::NoPicture { name, element: element.to_owned() });
    }
    let words = renderer.read_f32(&name)?;
    let color = words.chunks_exact(stride as usize / size_of::<f32>()).map(|pixel| three(pixel, 0)).collect();
    Ok(Film::new(renderer.options().size, color)?)
}

fn three(words: &[f32], at: usize) -> [f32; 3] {
    [words[at], words[at + 1], words[at + 2]]
}

/// Nodes from the output upwards, the nearest first.
pub(crate) fn upstream(graph: &Graph) -> Vec<usize> {
    let mut found = vec![graph.output().node];
    let mut next = VecDeque::from(found.clone());
    while let Some(node) = next.pop_front() {
        for wire in graph.nodes()[node].wires.iter().flatten() {
            if !found.contains(&wire.from.node) {
                found.push(wire.from.node);
                next.push_back(wire.from.node);
            }
        }
    }
    found
}

/// The node's output of running means, as `node.port`.
fn moments_of(graph: &Graph, node: usize) -> Option<String> {
    let ports = &graph.nodes()[node].contract.ports;
    let port = ports.iter().position(|port| port.ty.element == MOMENTS && port.direction != aquifer_graph::Direction::In)?;
    Some(graph.port_name(PortId { node, port }))
}

/// What a node averages: its input of colours.
fn frame_of(graph: &Graph, node: usize) -> Option<PortId> {
    let node = &graph.nodes()[node];
    let colors = |port: &aquifer_graph::Port| matches!(port.ty.element.as_str(), "vec3<f32>" | "vec4<f32>");
    let wires = node.contract.ports.iter().zip(&node.wires);
    wires.filter(|(port, _)| colors(port)).find_map(|(_, wire)| wire.filter(|wire| wire.when == When::This)).map(|wire| wire.from)
}

/// Inputs that carry a running mean over from the frame before, as (pass, input).
pub fn running_means(graph: &Graph) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (index, node) in graph.nodes().iter().enumerate() {
        for (port, wire) in node.wires.iter().enumerate() {
            let carries = |wire: &aquifer_graph::Wire| wire.from.node == index && wire.when == When::Previous;
            if wire.as_ref().is_some_and(carries) && node.port(port).ty.element == MOMENTS {
                found.push((node.pass.clone(), node.port(port).name.clone()));
            }
        }
    }
    found
}

/// Places of the members in units of 4 bytes.
struct Members {
    mean: usize,
    count: usize,
    squares: usize,
    stride: usize,
}

impl Members {
    fn of(plan: &Plan, name: &str) -> Result<Self, CaptureError> {
        let record = Record::of(plan, name);
        Ok(Self { mean: record.place("mean")?, count: record.place("count")?, squares: record.place("squares")?, stride: record.stride() })
    }
}

/// The elements of a kept resource. Places are in units of 4 bytes.
pub(crate) struct Record<'a> {
    name: &'a str,
    ty: Option<&'a WireType>,
}

impl<'a> Record<'a> {
    pub fn of(plan: &'a Plan, name: &'a str) -> Self {
        let kept = plan.kept.iter().find(|kept| kept.name == name).and_then(|kept| kept.resource);
        Self { name, ty: kept.map(|half| &plan.resources[half.resource].ty) }
    }

    pub fn place(&self, member: &'static str) -> Result<usize, CaptureError> {
        let offset = self.ty.and_then(|ty| offset(&ty.layout, member));
        offset.map(|bytes| bytes / size_of::<f32>()).ok_or_else(|| CaptureError::NoMember { name: self.name.to_owned(), member })
    }

    pub fn stride(&self) -> usize {
        self.ty.map_or(1, |ty| ty.stride as usize / size_of::<f32>())
    }
}

/// Offset of a member, from a layout's canonical text: `Moments{mean@0:vec3<f32>,count@12:u32}/16`.
fn offset(layout: &str, member: &str) -> Option<usize> {
    let members = layout.split_once('{')?.1;
    let start = members.split(',').find_map(|text| text.strip_prefix(member)?.strip_prefix('@'))?;
    start.split(':').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_are_found_by_name() {
        let layout = "Moments{mean@0:vec3<f32>,count@12:u32,mean_rest@16:vec3<f32>,squares@32:vec3<f32>,squares_rest@48:vec3<f32>}/64";
        assert_eq!(["mean", "count", "squares", "rest"].map(|name| offset(layout, name)), [Some(0), Some(12), Some(32), None]);
        assert_eq!(offset("f32", "mean"), None);
    }
}
