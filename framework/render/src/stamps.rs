//! Timestamps at the beginning and the end of every pass.

use crate::{Context, Error};

/// Frames that may be under way at once, each with a buffer of its own for its timestamps.
pub(crate) const FRAMES_IN_FLIGHT: usize = 2;

/// Two queries a pass. One set serves all frames: the queue resolves a frame's queries before the next frame writes them again.
#[derive(Debug)]
pub(crate) struct Stamps {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readbacks: [wgpu::Buffer; FRAMES_IN_FLIGHT],
    nanoseconds_per_tick: f64,
}

impl Stamps {
    /// `None` where the device cannot time passes.
    pub fn new(context: &Context, passes: usize) -> Result<Option<Stamps>, Error> {
        let (Some(nanoseconds_per_tick), true) = (context.tick(), passes > 0) else { return Ok(None) };
        let count = 2 * passes as u32;
        let size = u64::from(count) * u64::from(wgpu::QUERY_SIZE);
        let device = context.device();
        let buffer = |usage| {
            let label = Some("timestamps");
            device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
        };
        context.guard("timestamps", || {
            let kind = wgpu::QueryType::Timestamp;
            Some(Stamps {
                queries: device.create_query_set(&wgpu::QuerySetDescriptor { label: Some("timestamps"), ty: kind, count }),
                resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
                readbacks: [(); FRAMES_IN_FLIGHT].map(|()| buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ)),
                nanoseconds_per_tick,
            })
        })
    }

    /// What the descriptor of pass `index` takes.
    pub fn writes(&self, index: usize) -> wgpu::ComputePassTimestampWrites<'_> {
        let first = 2 * index as u32;
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        }
    }

    /// Records the copy of all timestamps into the frame's buffer.
    pub fn record_resolve(&self, encoder: &mut wgpu::CommandEncoder, slot: usize) {
        encoder.resolve_query_set(&self.queries, 0..self.queries.count(), &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readbacks[slot], 0, self.resolved.size());
    }

    pub fn readback(&self, slot: usize) -> &wgpu::Buffer {
        &self.readbacks[slot]
    }

    pub fn nanoseconds_per_tick(&self) -> f64 {
        self.nanoseconds_per_tick
    }
}
