//! A device, with what must be known when it misbehaves.

use crate::{AdapterReport, Error, adapter, cache::PipelineCache, limits};
use std::{
    mem,
    sync::{Arc, Mutex, OnceLock, PoisonError},
    time::{Duration, Instant},
};

/// How to open a device.
#[derive(Clone, Debug)]
pub struct ContextOptions {
    /// Part of the adapter's name or backend; `None` takes the best.
    pub adapter: Option<String>,
    /// Which of the adapter's limits to ask for.
    pub limits: LimitChoice,
    /// How long to wait for one pass before it counts as hung.
    pub patience: Duration,
}

impl Default for ContextOptions {
    fn default() -> Self {
        ContextOptions { adapter: None, limits: LimitChoice::Adapter, patience: Duration::from_secs(120) }
    }
}

/// Which limits to ask a device for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LimitChoice {
    /// All that the adapter offers.
    #[default]
    Adapter,
    /// What WebGPU guarantees everywhere: shows whether a graph would run on any device.
    WebGpu,
}

/// An open device. Clones share it.
#[derive(Clone, Debug)]
pub struct Context {
    inner: Arc<Inner>,
    patience: Duration,
}

#[derive(Debug)]
struct Inner {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: AdapterReport,
    limits: wgpu::Limits,
    trouble: Arc<Trouble>,
    pipelines: PipelineCache,
    opened_in: Duration,
}

/// What callbacks saw. After a loss calls may claim success, so the word of the first callback stands.
#[derive(Debug, Default)]
struct Trouble {
    lost: OnceLock<String>,
    hung: OnceLock<String>,
    uncaptured: Mutex<Option<wgpu::Error>>,
}

impl Context {
    /// Opens a device on the adapter that the options choose.
    ///
    /// # Errors
    /// [`Error::NoAdapter`], [`Error::NoSuchAdapter`], [`Error::NoDevice`].
    pub fn new(options: &ContextOptions) -> Result<Context, Error> {
        let begin = Instant::now();
        Self::open(&adapter::choose(options.adapter.as_deref())?, options, begin)
    }

    /// A device of the given size and no optional feature that checks every call and executes none: for trying pipelines, bindings and limits without a driver.
    ///
    /// # Errors
    /// [`Error::NoDevice`], for limits that contradict each other.
    pub fn noop(limits: wgpu::Limits) -> Result<Context, Error> {
        Self::open(&adapter::noop(limits)?, &ContextOptions::default(), Instant::now())
    }

    fn open(adapter: &wgpu::Adapter, options: &ContextOptions, begin: Instant) -> Result<Context, Error> {
        let report = AdapterReport::new(adapter);
        let offered = adapter.limits();
        let wanted = match options.limits {
            LimitChoice::Adapter => limits::raised_to(&offered),
            LimitChoice::WebGpu => wgpu::Limits::default().or_worse_values_from(&offered),
        };
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("aquifer"),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: wanted,
            ..Default::default()
        });
        let (device, queue) =
            pollster::block_on(request).map_err(|error| Error::NoDevice { adapter: report.name.clone(), message: error.to_string() })?;
        let trouble = Arc::new(Trouble::default());
        listen(&device, &trouble);
        tracing::debug!(adapter = report.name, backend = report.backend, driver = report.driver, "device opened");
        Ok(Context {
            inner: Arc::new(Inner {
                limits: device.limits(),
                device,
                queue,
                adapter: report,
                trouble,
                pipelines: PipelineCache::default(),
                opened_in: begin.elapsed(),
            }),
            patience: options.patience,
        })
    }

    /// The same device, whose passes are waited for so long before they count as hung.
    pub fn with_patience(&self, patience: Duration) -> Context {
        Context { patience, ..self.clone() }
    }

    /// The device.
    pub fn device(&self) -> &wgpu::Device {
        &self.inner.device
    }

    /// Its queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.inner.queue
    }

    /// The adapter that it was opened on.
    pub fn adapter(&self) -> &AdapterReport {
        &self.inner.adapter
    }

    /// What was granted.
    pub fn limits(&self) -> &wgpu::Limits {
        &self.inner.limits
    }

    /// Bytes that the device's buffers and textures take now; `None` where the backend does not tell.
    pub fn device_bytes(&self) -> Option<u64> {
        self.inner.device.generate_allocator_report().map(|report| report.total_allocated_bytes)
    }

    /// How long it took to find the adapter and open the device.
    pub fn opened_in(&self) -> Duration {
        self.inner.opened_in
    }

    pub(crate) fn pipelines(&self) -> &PipelineCache {
        &self.inner.pipelines
    }

    /// Nanoseconds of one tick of a timestamp; `None` where passes cannot be timed on the device.
    pub(crate) fn tick(&self) -> Option<f64> {
        let offered = self.inner.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        offered.then(|| f64::from(self.inner.queue.get_timestamp_period()))
    }

    /// Does `work`, and turns what wgpu reports meanwhile into an error that names `what`.
    ///
    /// # Errors
    /// [`Error::Validation`], [`Error::Internal`], [`Error::OutOfMemory`], [`Error::DeviceLost`].
    pub fn guard<T>(&self, what: &str, work: impl FnOnce() -> T) -> Result<T, Error> {
        self.health()?;
        let [memory, internal, validation] = [wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::Validation]
            .map(|filter| self.inner.device.push_error_scope(filter));
        let value = work();
        // Scopes close in the reverse order of their opening.
        let caught = [validation, internal, memory].map(|scope| pollster::block_on(scope.pop()));
        self.health()?;
        match caught.into_iter().flatten().next() {
            None => Ok(value),
            Some(error) => Err(named(what, error)),
        }
    }

    /// Waits until a submission is done.
    ///
    /// # Errors
    /// [`Error::Hung`] names `pass` when the context's patience runs out; [`Error::DeviceLost`].
    pub fn wait(&self, submission: &wgpu::SubmissionIndex, pass: &str) -> Result<(), Error> {
        let poll = wgpu::PollType::Wait { submission_index: Some(submission.clone()), timeout: Some(self.patience) };
        match self.inner.device.poll(poll) {
            Ok(_) => self.health(),
            Err(wgpu::PollError::Timeout) => Err(self.give_up(pass)),
            Err(error @ wgpu::PollError::WrongSubmissionIndex(..)) => {
                Err(Error::Internal { pass: pass.to_owned(), message: error.to_string() })
            }
        }
    }

    /// An error when the device can no longer be trusted.
    ///
    /// # Errors
    /// [`Error::DeviceLost`], [`Error::Hung`], or what no [`Context::guard`] caught.
    pub fn health(&self) -> Result<(), Error> {
        let trouble = &self.inner.trouble;
        if let Some(pass) = trouble.hung.get() {
            return Err(Error::Hung { pass: pass.clone(), limit: self.patience });
        }
        if let Some(message) = trouble.lost.get() {
            return Err(Error::DeviceLost { message: message.clone() });
        }
        let uncaptured = trouble.uncaptured.lock().unwrap_or_else(PoisonError::into_inner).take();
        uncaptured.map_or(Ok(()), |error| Err(named("(outside any pass)", error)))
    }

    fn give_up(&self, pass: &str) -> Error {
        let pass = self.inner.trouble.hung.get_or_init(|| pass.to_owned()).clone();
        // Dropping a queue waits for its work without bound, which would hang the process here.
        mem::forget(self.clone());
        Error::Hung { pass, limit: self.patience }
    }
}

fn listen(device: &wgpu::Device, trouble: &Arc<Trouble>) {
    let lost = Arc::downgrade(trouble);
    device.set_device_lost_callback(move |_, message| {
        if let Some(trouble) = lost.upgrade() {
            // Only the first loss says why.
            trouble.lost.get_or_init(|| message);
        }
    });
    let uncaptured = Arc::downgrade(trouble);
    device.on_uncaptured_error(Arc::new(move |error| {
        tracing::error!(%error, "uncaptured error of the device");
        if let Some(trouble) = uncaptured.upgrade() {
            trouble.uncaptured.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        }
    }));
}

fn named(what: &str, error: wgpu::Error) -> Error {
    let what = what.to_owned();
    match error {
        wgpu::Error::OutOfMemory { source } => Error::OutOfMemory { what, message: source.to_string() },
        wgpu::Error::Validation { description, .. } => Error::Validation { pass: what, message: description },
        wgpu::Error::Internal { description, .. } => Error::Internal { pass: what, message: description },
    }
}
