//! Buffers back to the host: bounded waits, a piece at a time, so that no mapping is ever large.

use crate::{Context, Error};

/// Bytes of one piece.
const PIECE: u64 = 16 << 20;

/// Copies `size` bytes from `offset` of a buffer that can be copied from; `what` names it in errors. Copies go by words of 4 bytes, so
/// the buffer must hold the last word in full.
///
/// # Errors
/// What [`Context::guard`] and [`Context::wait`] find.
pub fn read(context: &Context, what: &str, buffer: &wgpu::Buffer, offset: u64, size: u64) -> Result<Vec<u8>, Error> {
    let staging = context.guard(what, || {
        context.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: PIECE.min(size.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT)).max(wgpu::COPY_BUFFER_ALIGNMENT),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    })?;
    let mut bytes = Vec::with_capacity(size as usize);
    let padded = size.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
    let mut done = 0;
    while done < padded {
        let length = PIECE.min(padded - done);
        read_piece(context, what, (buffer, offset + done), &staging, length, &mut bytes)?;
        done += length;
    }
    bytes.truncate(size as usize);
    Ok(bytes)
}

fn read_piece(
    context: &Context,
    what: &str,
    (buffer, offset): (&wgpu::Buffer, u64),
    staging: &wgpu::Buffer,
    length: u64,
    bytes: &mut Vec<u8>,
) -> Result<(), Error> {
    let submission = context.guard(what, || {
        let mut encoder = context.device().create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("readback") });
        encoder.copy_buffer_to_buffer(buffer, offset, staging, 0, length);
        context.queue().submit([encoder.finish()])
    })?;
    let mapping = Mapping::begin(staging, length);
    context.wait(&submission, what)?;
    mapping.end(context, what, |view| bytes.extend_from_slice(view))
}

/// A mapping asked for; it is there when the submission before it is done.
#[derive(Debug)]
pub(crate) struct Mapping {
    buffer: wgpu::Buffer,
    length: u64,
    answer: std::sync::mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl Mapping {
    /// Asks for the first `length` bytes.
    pub fn begin(buffer: &wgpu::Buffer, length: u64) -> Self {
        let (sender, answer) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, ..length, move |result| {
            // Nobody waits any more when the receiver is gone.
            let _ = sender.send(result);
        });
        Mapping { buffer: buffer.clone(), length, answer }
    }

    /// Shows the bytes and unmaps; to be called after [`Context::wait`] for the submission that filled them.
    pub fn end(self, context: &Context, what: &str, show: impl FnOnce(&[u8])) -> Result<(), Error> {
        let refused = |message: String| Error::Internal { pass: what.to_owned(), message };
        // The wait for the submission has run the callback, save for a driver that reports late: one more look settles that.
        let _ = context.device().poll(wgpu::PollType::Poll);
        context.health()?;
        self.answer
            .try_recv()
            .map_err(|error| refused(format!("mapping did not finish: {error}")))?
            .map_err(|error| refused(error.to_string()))?;
        let view = self.buffer.get_mapped_range(..self.length).map_err(|error| refused(error.to_string()))?;
        show(&view);
        drop(view);
        self.buffer.unmap();
        Ok(())
    }
}
