//! One dispatch on buffers made for it: for tests of shader functions.

use crate::{Context, Error, Kernel, readback};
use aquifer_shader::{Composed, ResourceKind};

/// What a buffer of [`run_once`] holds.
#[derive(Clone, Copy, Debug)]
pub enum Data<'a> {
    /// Read by the shader.
    In(&'a [u8]),
    /// This many bytes of zeros, returned as the shader leaves them.
    Out(u64),
    /// Read, and returned as the shader leaves it.
    InOut(&'a [u8]),
}

impl Data<'_> {
    fn role(self) -> &'static str {
        match self {
            Data::In(_) => "input",
            Data::Out(_) => "output",
            Data::InOut(_) => "input and output",
        }
    }
}

/// A dispatch to run once.
#[derive(Clone, Copy, Debug)]
pub struct Once<'a> {
    /// The shader.
    pub shader: &'a Composed,
    /// Its compute entry point.
    pub entry: &'a str,
    /// `override`s by name.
    pub constants: &'a [(&'a str, f64)],
    /// Every binding that the entry point reaches, by declared or qualified name.
    pub buffers: &'a [(&'a str, Data<'a>)],
    /// Workgroups across, down and deep.
    pub workgroups: [u32; 3],
}

/// Runs one dispatch, and returns the bytes of every [`Data::Out`] and [`Data::InOut`], in the order given.
///
/// # Errors
/// As [`Kernel::compute`], [`Kernel::record`] and [`Context::wait`].
pub fn run_once(context: &Context, once: &Once<'_>) -> Result<Vec<Vec<u8>>, Error> {
    let kernel = Kernel::compute(context, once.entry, once.shader, once.entry, once.constants)?;
    let made: Result<Vec<_>, Error> = once.buffers.iter().map(|(name, data)| buffer(context, &kernel, name, *data)).collect();
    let made = made?;
    let named: Vec<_> = once.buffers.iter().zip(&made).map(|((name, _), buffer)| (*name, buffer)).collect();
    let mut encoder = context.device().create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(once.entry) });
    kernel.record(context, &mut encoder, &named, once.workgroups)?;
    let submission = context.guard(once.entry, || context.queue().submit([encoder.finish()]))?;
    context.wait(&submission, once.entry)?;
    let wanted = once.buffers.iter().zip(&made).filter(|((_, data), _)| !matches!(data, Data::In(_)));
    wanted.map(|((name, data), buffer)| readback::read(context, name, buffer, 0, length(*data))).collect()
}

fn length(data: Data<'_>) -> u64 {
    match data {
        Data::In(bytes) | Data::InOut(bytes) => bytes.len() as u64,
        Data::Out(length) => length,
    }
}

fn buffer(context: &Context, kernel: &Kernel, name: &str, data: Data<'_>) -> Result<wgpu::Buffer, Error> {
    let usage = match kernel.binding(name)?.resource {
        ResourceKind::Uniform { .. } => wgpu::BufferUsages::UNIFORM,
        _ => wgpu::BufferUsages::STORAGE,
    };
    let what = format!("{} `{name}`", data.role());
    context.guard(&what, || {
        let buffer = context.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: length(data).next_multiple_of(4).max(4),
            usage: usage | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        if let Data::In(bytes) | Data::InOut(bytes) = data {
            let mut padded = bytes.to_vec();
            padded.resize(bytes.len().next_multiple_of(4), 0);
            context.queue().write_buffer(&buffer, 0, &padded);
        }
        buffer
    })
}
