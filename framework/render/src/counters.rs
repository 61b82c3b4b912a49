//! How many NaNs and infinities each pass leaves behind: a kernel of our own looks at what a node wrote, after it wrote it.
//!
//! The passes' own kernels stay as they are, so that a picture is the same to the bit with and without counting; without it, nothing of this is
//! compiled.

use crate::{
    Context, Error, Kernel, Known,
    pool::{self, Pool},
    readback,
};
use aquifer_graph::{Direction, Plan, Port, Step};
use aquifer_shader::{Binding, Interface, Layout, Library, ResourceKind, Specialisation};
use serde::Serialize;
use std::sync::Arc;

/// Name of the kernel's module and of its file.
const KERNEL: &str = "counters";
/// Invocations of a workgroup of the kernel.
const WORKGROUP: u32 = 64;
/// 32-bit words of one array's counts.
const COUNTS: usize = 4;

/// What one output of one pass held since the renderer was made: elements, over all frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PortCounts {
    /// The node.
    pub pass: String,
    /// Its port.
    pub port: String,
    /// Elements that hold a NaN.
    pub nan: u64,
    /// Elements that hold an infinity.
    pub infinite: u64,
}

/// The kernel, bound to everything that steps write.
pub(crate) struct Counters {
    kernel: Kernel,
    watches: Vec<Watch>,
    found: wgpu::Buffer,
}

/// One array that a step writes.
struct Watch {
    step: usize,
    pass: String,
    port: String,
    workgroups: [u32; 3],
    /// By parity of the frame.
    groups: [Option<wgpu::BindGroup>; 2],
}

impl Counters {
    /// Watches every port that a step writes and that holds floats.
    pub fn new(context: &Context, plan: &Plan, known: &[Arc<Known>], pool: &Pool, size: [u32; 2]) -> Result<Counters, Error> {
        let kernel = kernel(context)?;
        let written: Vec<(usize, &Port, Vec<u32>)> = plan
            .steps
            .iter()
            .zip(known)
            .enumerate()
            .flat_map(|(index, (step, known))| written(index, step, &known.composed.interface))
            .collect();
        let found = pool::allocate(context, KERNEL, (written.len() * COUNTS * size_of::<u32>()) as u64)?;
        let mut watches = Vec::new();
        for (at, (index, port, floats)) in written.into_iter().enumerate() {
            let (step, elements) = (&plan.steps[index], port.ty.extent.elements(size) as u32);
            let workgroups = rectangle(elements.div_ceil(WORKGROUP), context.limits().max_compute_workgroups_per_dimension);
            let shape = [port.ty.stride / 4, elements, workgroups[0] * WORKGROUP, at as u32];
            let [shape, floats] = [(&shape[..], wgpu::BufferUsages::UNIFORM), (&floats[..], wgpu::BufferUsages::STORAGE)]
                .map(|(words, usage)| filled(context, words, usage));
            let (shape, floats) = (shape?, floats?);
            let bind = |parity| {
                kernel.bind(context, 1, |binding: &Binding| match binding.name.as_str() {
                    "shape" => Some(shape.as_entire_binding()),
                    "floats" => Some(floats.as_entire_binding()),
                    "found" => Some(found.as_entire_binding()),
                    _ => step.resource(&port.name).map(|half| pool.part(half, parity).binding()),
                })
            };
            let groups = [bind(0)?, bind(1)?];
            watches.push(Watch { step: index, pass: step.node.clone(), port: port.name.clone(), workgroups, groups });
        }
        Ok(Counters { kernel, watches, found })
    }

    /// Records the counting of what step `index` has written.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, index: usize, parity: usize) {
        for watch in self.watches.iter().filter(|watch| watch.step == index) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(KERNEL), timestamp_writes: None });
            self.kernel.dispatch(&mut pass, &[None, watch.groups[parity].as_ref()], watch.workgroups);
        }
    }

    /// What was found so far, in order of execution.
    pub fn read(&self, context: &Context) -> Result<Vec<PortCounts>, Error> {
        let bytes = readback::read(context, KERNEL, &self.found, 0, (self.watches.len() * COUNTS * size_of::<u32>()) as u64)?;
        let words: Vec<u64> =
            bytes.chunks_exact(8).map(|half| u64::from_le_bytes(half.try_into().expect("chunks are of 8 bytes"))).collect();
        let counts = |(watch, counts): (&Watch, &[u64])| PortCounts {
            pass: watch.pass.clone(),
            port: watch.port.clone(),
            nan: counts[0],
            infinite: counts[1],
        };
        Ok(self.watches.iter().zip(words.chunks_exact(2)).map(counts).collect())
    }
}

fn kernel(context: &Context) -> Result<Kernel, Error> {
    let mut library = Library::new();
    library.insert(KERNEL, include_str!("counters.wgsl"), "counters.wgsl");
    let what = Specialisation { entry: KERNEL.to_owned(), ..Specialisation::default() };
    let composed = library.compose(&what).map_err(|error| Error::Internal { pass: KERNEL.to_owned(), message: error.to_string() })?;
    Kernel::compute(context, KERNEL, &composed, "count", &[])
}

/// Workgroups in rows, so that none is longer than allowed.
fn rectangle(count: u32, longest: u32) -> [u32; 3] {
    let across = count.clamp(1, longest);
    [across, count.div_ceil(across), 1]
}

fn filled(context: &Context, words: &[u32], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, Error> {
    context.guard(KERNEL, || {
        let buffer = context.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some(KERNEL),
            size: size_of_val(words) as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        context.queue().write_buffer(&buffer, 0, bytemuck::cast_slice(words));
        buffer
    })
}

/// Ports that a step writes to a resource, with the words of their elements that are floats; without those that have none.
fn written<'a>(index: usize, step: &'a Step, interface: &Interface) -> Vec<(usize, &'a Port, Vec<u32>)> {
    let ports = step.contract.ports.iter().filter(|port| port.direction != Direction::In && step.resource(&port.name).is_some());
    let floats = |port: &Port| {
        let binding = interface.bindings.iter().find(|binding| binding.group == 1 && binding.name == port.name);
        let mut words = Vec::new();
        if let Some(ResourceKind::StorageArray { ty, .. } | ResourceKind::Storage { ty, .. }) = binding.map(|binding| &binding.resource) {
            add_floats(ty, 0, &mut words);
        }
        words
    };
    ports.map(|port| (index, port, floats(port))).filter(|(.., floats)| !floats.is_empty()).collect()
}

/// Adds the places of the floats in a type that begins at byte `at`, in words.
fn add_floats(ty: &Layout, at: u32, words: &mut Vec<u32>) {
    for member in &ty.members {
        add_floats(&member.ty, at + member.offset, words);
    }
    let first = at / 4;
    match ty.name.as_str() {
        "f32" => words.push(first),
        "vec2<f32>" => words.extend(first..first + 2),
        "vec3<f32>" => words.extend(first..first + 3),
        "vec4<f32>" => words.extend(first..first + 4),
        // Of the arrays and matrices of floats, these have no padding between their elements.
        name if name.starts_with("array<f32,")
            || name.starts_with("array<vec4<f32>,")
            || name.starts_with("mat") && name.contains("x4<f32>") =>
        {
            words.extend(first..first + ty.size / 4);
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use aquifer_shader::Member;

    fn layout(name: &str, size: u32, members: Vec<Member>) -> Layout {
        Layout { name: name.to_owned(), size, align: 4, members }
    }

    fn member(name: &str, offset: u32, ty: Layout) -> Member {
        Member { name: name.to_owned(), offset, ty, doc: String::new(), tags: vec![] }
    }

    #[test]
    fn floats_are_found_in_nested_elements_and_nothing_else_is() {
        let inner =
            layout("Sample<di>", 12, vec![member("light", 0, layout("u32", 4, vec![])), member("uv", 4, layout("vec2<f32>", 8, vec![]))]);
        let outer = layout("Reservoir<di>", 20, vec![member("sample", 4, inner), member("weight", 16, layout("f32", 4, vec![]))]);
        let mut words = Vec::new();
        add_floats(&outer, 0, &mut words);
        assert_eq!(words, [2, 3, 4]);
    }

    #[test]
    fn no_row_is_too_long_and_all_is_covered() {
        assert_eq!(rectangle(0, 65535), [1, 0, 1]);
        assert_eq!(rectangle(9, 65535), [9, 1, 1]);
        assert_eq!(rectangle(129_600, 65535), [65535, 2, 1]);
    }
}
