//! Dispatches on buffers made for them: for tests of shader functions, and for timing a kernel by itself.

use crate::{Context, Error, Globals, Kernel, NoGlobals, kernel::names, readback};
use aquifer_shader::{Binding, Composed, ResourceKind};

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
    /// Bindings that the entry point reaches, by declared or qualified name: all that globals do not give.
    pub buffers: &'a [(&'a str, Data<'a>)],
    /// Workgroups across, down and deep.
    pub workgroups: [u32; 3],
}

/// Runs one dispatch, and returns the bytes of every [`Data::Out`] and [`Data::InOut`], in the order given.
///
/// # Errors
/// As [`Job::new`], [`Job::run`] and [`Job::results`].
pub fn run_once(context: &Context, once: &Once<'_>) -> Result<Vec<Vec<u8>>, Error> {
    let job = Job::new(context, once, &NoGlobals)?;
    job.run(1)?;
    job.results()
}

/// A dispatch that can be run again and again.
pub struct Job {
    context: Context,
    kernel: Kernel,
    groups: Vec<Option<wgpu::BindGroup>>,
    workgroups: [u32; 3],
    /// Name, buffer and bytes of what is returned.
    returned: Vec<(String, wgpu::Buffer, u64)>,
}

impl Job {
    /// Compiles and uploads. What is not among the job's buffers is asked of `globals`.
    ///
    /// # Errors
    /// As [`Kernel::compute`] and [`Kernel::bind`].
    pub fn new(context: &Context, once: &Once<'_>, globals: &dyn Globals) -> Result<Job, Error> {
        let kernel = Kernel::compute(context, once.entry, once.shader, once.entry, once.constants)?;
        let made: Result<Vec<_>, Error> = once.buffers.iter().map(|(name, data)| buffer(context, &kernel, name, *data)).collect();
        let made = made?;
        let find = |binding: &Binding| {
            let own = once.buffers.iter().zip(&made).find(|((name, _), _)| names(binding, name));
            own.map(|(_, buffer)| buffer.as_entire_binding()).or_else(|| globals.resource(&binding.module, &binding.name))
        };
        let groups = kernel.bind_all(context, find)?;
        let returned = once.buffers.iter().zip(made).filter(|((_, data), _)| !matches!(data, Data::In(_)));
        let returned = returned.map(|((name, data), buffer)| ((*name).to_owned(), buffer, length(*data))).collect();
        Ok(Job { context: context.clone(), kernel, groups, workgroups: once.workgroups, returned })
    }

    /// Runs it so many times in one submission, and waits.
    ///
    /// # Errors
    /// What [`Context::guard`] and [`Context::wait`] find.
    pub fn run(&self, times: u32) -> Result<(), Error> {
        let label = self.kernel.entry();
        let groups: Vec<_> = self.groups.iter().map(Option::as_ref).collect();
        let submission = self.context.guard(label, || {
            let mut encoder = self.context.device().create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) });
            for _ in 0..times {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None });
                self.kernel.dispatch(&mut pass, &groups, self.workgroups);
            }
            self.context.queue().submit([encoder.finish()])
        })?;
        self.context.wait(&submission, label)
    }

    /// The bytes of every [`Data::Out`] and [`Data::InOut`], in the order given.
    ///
    /// # Errors
    /// As [`crate::read`].
    pub fn results(&self) -> Result<Vec<Vec<u8>>, Error> {
        self.returned.iter().map(|(name, buffer, bytes)| readback::read(&self.context, name, buffer, 0, *bytes)).collect()
    }
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
