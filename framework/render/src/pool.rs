//! Memory of a plan: pairs for history, shared blocks for transients, zeros for what is not wired.

use crate::{Context, Error};
use aquifer_graph::{Blocks, Life, Plan, ResourceHalf, Step, When, WireType};
use serde::Serialize;
use std::iter;

/// Bytes of one half of what a wire carries.
pub(crate) fn bytes(ty: &WireType, size: [u32; 2]) -> u64 {
    ty.extent.elements(size) * u64::from(ty.stride)
}

/// Where memory goes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct MemoryReport {
    /// In the plan's order, then the images that passes draw into.
    pub resources: Vec<ResourceMemory>,
    /// All bytes allocated, zeros and debugging aids included.
    pub allocated: u64,
    /// Bytes that sharing saved.
    pub saved: u64,
}

impl MemoryReport {
    /// With what nodes hold beside the pool.
    pub(crate) fn with(&self, images: impl Iterator<Item = ResourceMemory>) -> MemoryReport {
        let mut report = self.clone();
        report.resources.extend(images);
        report.allocated += report.resources[self.resources.len()..].iter().map(|image| image.bytes).sum::<u64>();
        report
    }
}

/// Memory of one resource.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ResourceMemory {
    /// `pass.port` of its first writer.
    pub name: String,
    /// Bytes, both halves of a history pair counted.
    pub bytes: u64,
    /// `transient`, `history`, `output` or `image`.
    pub life: &'static str,
    /// Number of the block that a transient shares.
    pub block: Option<usize>,
}

/// Buffers of one plan at one size.
#[derive(Debug)]
pub(crate) struct Pool {
    buffers: Vec<wgpu::Buffer>,
    homes: Vec<Home>,
    /// Bytes of one half, by resource.
    bytes: Vec<u64>,
    zeros: wgpu::Buffer,
    poison: Option<wgpu::Buffer>,
    report: MemoryReport,
}

/// Indices into [`Pool::buffers`].
#[derive(Clone, Copy, Debug)]
enum Home {
    One(usize),
    /// The halves swap their roles from frame to frame.
    Pair(usize, usize),
}

/// Part of a buffer, from its start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    pub buffer: &'a wgpu::Buffer,
    pub bytes: u64,
}

impl<'a> Part<'a> {
    /// Exactly this part, so that `arrayLength` is the extent also in a shared block.
    pub fn binding(self) -> wgpu::BindingResource<'a> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: self.buffer, offset: 0, size: wgpu::BufferSize::new(self.bytes) })
    }
}

impl Pool {
    /// Allocates zeros for everything.
    pub fn new(context: &Context, plan: &Plan, size: [u32; 2], poisoned: bool) -> Result<Pool, Error> {
        let bytes: Vec<u64> = plan.resources.iter().map(|resource| resource.bytes(size)).collect();
        let blocks = plan.blocks(size);
        let (homes, sizes) = settle(plan, &bytes, &blocks);
        let buffers: Result<Vec<_>, Error> = sizes.iter().map(|(name, bytes)| allocate(context, name, *bytes)).collect();
        let unwired = plan.steps.iter().flat_map(|step| unwired_inputs(step, size)).max().unwrap_or(0);
        let zeros = allocate(context, "zeros", unwired)?;
        let largest = bytes.iter().copied().max().unwrap_or(0);
        let poison = poisoned.then(|| poison(context, largest)).transpose()?;
        let extra = zeros.size() + poison.as_ref().map_or(0, wgpu::Buffer::size);
        let allocated = sizes.iter().map(|(_, bytes)| bytes).sum::<u64>() + extra;
        let report = MemoryReport { resources: report(plan, &homes, &bytes, &blocks), allocated, saved: blocks.unshared - blocks.total() };
        Ok(Pool { buffers: buffers?, homes, bytes, zeros, poison, report })
    }

    /// A resource's half in a frame of the given parity.
    pub fn part(&self, half: ResourceHalf, parity: usize) -> Part<'_> {
        let index = match (self.homes[half.resource], half.when) {
            (Home::One(index), _) => index,
            (Home::Pair(even, odd), when) => {
                if (parity == 0) == (when == When::This) {
                    even
                } else {
                    odd
                }
            }
        };
        Part { buffer: &self.buffers[index], bytes: self.bytes[half.resource] }
    }

    /// So many zeros.
    pub fn zeros(&self, bytes: u64) -> Part<'_> {
        Part { buffer: &self.zeros, bytes }
    }

    /// Records the poisoning of one part, if this pool poisons.
    pub fn record_poison(&self, encoder: &mut wgpu::CommandEncoder, part: Part<'_>) {
        if let Some(poison) = &self.poison {
            encoder.copy_buffer_to_buffer(poison, 0, part.buffer, 0, part.bytes);
        }
    }

    /// Records zeros for one part.
    pub fn record_zeros(&self, encoder: &mut wgpu::CommandEncoder, part: Part<'_>) {
        encoder.clear_buffer(part.buffer, 0, Some(part.bytes));
    }

    /// Records zeros for everything.
    pub fn record_clear(&self, encoder: &mut wgpu::CommandEncoder) {
        for buffer in &self.buffers {
            encoder.clear_buffer(buffer, 0, None);
        }
    }

    pub fn report(&self) -> &MemoryReport {
        &self.report
    }
}

/// Homes of all resources, and name and size of every buffer.
fn settle(plan: &Plan, bytes: &[u64], blocks: &Blocks) -> (Vec<Home>, Vec<(String, u64)>) {
    let mut sizes: Vec<(String, u64)> = blocks.sizes.iter().enumerate().map(|(block, bytes)| (format!("block {block}"), *bytes)).collect();
    let mut homes = Vec::new();
    for ((resource, &bytes), block) in plan.resources.iter().zip(bytes).zip(&blocks.of) {
        let mut own = |suffix: &str| {
            sizes.push((format!("{}{suffix}", resource.name), bytes));
            sizes.len() - 1
        };
        homes.push(match (block, resource.life) {
            (Some(block), _) => Home::One(*block),
            (None, Life::History) => Home::Pair(own(" (even frames)"), own(" (odd frames)")),
            (None, _) => Home::One(own("")),
        });
    }
    (homes, sizes)
}

/// Bytes of every port of a step that reads zeros.
fn unwired_inputs(step: &Step, size: [u32; 2]) -> impl Iterator<Item = u64> {
    let contract = &step.contract;
    let unwired = contract.ports.iter().filter(|port| !contract.absent.contains_key(&port.name) && step.resource(&port.name).is_none());
    unwired.map(move |port| bytes(&port.ty, size))
}

fn report(plan: &Plan, homes: &[Home], bytes: &[u64], blocks: &Blocks) -> Vec<ResourceMemory> {
    let resource = |index: usize| ResourceMemory {
        name: plan.resources[index].name.clone(),
        bytes: if matches!(homes[index], Home::Pair(..)) { 2 * bytes[index] } else { bytes[index] },
        life: match plan.resources[index].life {
            Life::Transient { .. } => "transient",
            Life::History => "history",
            Life::Output => "output",
        },
        block: blocks.of[index],
    };
    (0..homes.len()).map(resource).collect()
}

/// A storage buffer; wgpu fills it with zeros before its first use.
pub(crate) fn allocate(context: &Context, name: &str, bytes: u64) -> Result<wgpu::Buffer, Error> {
    context.guard(&format!("`{name}` ({bytes} bytes)"), || {
        context.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: bytes.max(wgpu::COPY_BUFFER_ALIGNMENT),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })
}

/// All bits set: NaN as a float, out of every range as an index.
fn poison(context: &Context, bytes: u64) -> Result<wgpu::Buffer, Error> {
    let buffer = allocate(context, "poison", bytes)?;
    let piece: Vec<u8> = iter::repeat_n(0xff, bytes.min(1 << 20) as usize).collect();
    context.guard("poison", || {
        for offset in (0..bytes).step_by(piece.len().max(1)) {
            let length = (bytes - offset).min(piece.len() as u64);
            context.queue().write_buffer(&buffer, offset, &piece[..length as usize]);
        }
    })?;
    Ok(buffer)
}
