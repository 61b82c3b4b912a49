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

    /// For a wgpu pass of node `index`: the node's first writes the beginning, its last the end.
    pub fn of(&self, index: usize, first: bool, last: bool) -> Option<Stamp<'_>> {
        let begin = 2 * index as u32;
        (first || last).then(|| Stamp { queries: &self.queries, begin: first.then_some(begin), end: last.then_some(begin + 1) })
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

/// Which timestamps one wgpu pass writes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stamp<'a> {
    queries: &'a wgpu::QuerySet,
    begin: Option<u32>,
    end: Option<u32>,
}

impl<'a> Stamp<'a> {
    pub fn compute(self) -> wgpu::ComputePassTimestampWrites<'a> {
        let Stamp { queries, begin, end } = self;
        wgpu::ComputePassTimestampWrites { query_set: queries, beginning_of_pass_write_index: begin, end_of_pass_write_index: end }
    }

    pub fn render(self) -> wgpu::RenderPassTimestampWrites<'a> {
        let Stamp { queries, begin, end } = self;
        wgpu::RenderPassTimestampWrites { query_set: queries, beginning_of_pass_write_index: begin, end_of_pass_write_index: end }
    }
}
