//! One step of a plan, ready to run: kernels, drawings, bind groups, live parameters.

use crate::{
    Batch, Context, Error, Globals, Kernel, Pass, PassError, ResourceMemory,
    drawing::Drawing,
    limits::{covered, workgroups},
    params::{self, LIVE, LiveParams},
    pass::Job,
    pool::{self, Pool},
    program,
    registry::Known,
    stamps::{Stamp, Stamps},
    targets::Targets,
};
use aquifer_graph::{Direction, Plan, ResourceHalf, Step, Value, When};
use aquifer_shader::{Binding, Entry, Stage};

/// A pass with what it dispatches and draws.
pub(crate) struct Node {
    pub pass: Box<dyn Pass>,
    pub work: Work,
}

/// All of a node but its decisions.
pub(crate) struct Work {
    name: String,
    kernels: Vec<Ready<Kernel>>,
    drawings: Vec<Ready<Drawing>>,
    /// Workgroups that cover what each kernel writes.
    workgroups: Vec<[u32; 3]>,
    targets: Targets,
    live: Option<Live>,
    /// What the node writes in full.
    outputs: Vec<ResourceHalf>,
    /// What must be zeros when the node begins.
    cleared: Vec<ResourceHalf>,
    /// Of the globals that are bound.
    generation: Option<u64>,
}

/// A kernel or a drawing with its bind groups.
struct Ready<P> {
    program: P,
    globals: Option<wgpu::BindGroup>,
    /// By parity of the frame.
    own: [Option<wgpu::BindGroup>; 2],
}

struct Live {
    params: LiveParams,
    buffer: wgpu::Buffer,
}

/// Where ports find their buffers.
#[derive(Clone, Copy)]
pub(crate) struct Memory<'a> {
    pub pool: &'a Pool,
    pub size: [u32; 2],
}

impl<'a> Memory<'a> {
    /// What the port of that name is joined to: exactly the extent, or as many zeros.
    fn of(&self, step: &Step, binding: &Binding, parity: usize) -> Option<wgpu::BindingResource<'a>> {
        let port = step.contract.ports.iter().find(|port| port.name == binding.name)?;
        let part = match step.resource(&port.name) {
            Some(half) => self.pool.part(half, parity),
            None => self.pool.zeros(pool::bytes(&port.ty, self.size)),
        };
        Some(part.binding())
    }
}

/// What a step's shader was compiled to.
pub(crate) struct Compiled {
    kernels: Vec<Kernel>,
    drawings: Vec<Drawing>,
}

/// Compiles every compute and every fragment entry point of a step.
pub(crate) fn compile(context: &Context, step: &Step, known: &Known) -> Result<Compiled, Error> {
    let constants = params::constants(step, &known.composed.interface);
    let entries = |stage: Stage| known.composed.interface.entries.iter().filter(move |entry| entry.stage == stage);
    let kernel = |entry: &Entry| Kernel::compute(context, &step.node, &known.composed, &entry.name, &constants);
    let drawing = |entry: &Entry| Drawing::new(context, &step.node, &known.composed, entry, &constants);
    Ok(Compiled {
        kernels: entries(Stage::Compute).map(kernel).collect::<Result<_, Error>>()?,
        drawings: entries(Stage::Fragment).map(drawing).collect::<Result<_, Error>>()?,
    })
}

impl Work {
    /// Binds the kernels and drawings of step `index` to the pool's memory.
    pub fn new(context: &Context, plan: &Plan, index: usize, known: &Known, compiled: Compiled, memory: Memory<'_>) -> Result<Work, Error> {
        let (step, interface) = (&plan.steps[index], &known.composed.interface);
        let live = live(context, step, known)?;
        let targets = Targets::new(context, &step.node, interface, memory.size)?;
        let find = |binding: &Binding, parity| match &live {
            Some(live) if binding.name == LIVE => Some(live.buffer.as_entire_binding()),
            _ => memory.of(step, binding, parity).or_else(|| targets.view(&binding.name).map(wgpu::BindingResource::TextureView)),
        };
        let mut kernels = Vec::new();
        for program in compiled.kernels {
            let own = [0, 1].map(|parity| program.bind(context, 1, |binding| find(binding, parity)));
            kernels.push(Ready::new(program, own)?);
        }
        let mut drawings = Vec::new();
        for program in compiled.drawings {
            let own = [0, 1].map(|parity| program.program().bind(context, 1, |binding| find(binding, parity)));
            drawings.push(Ready::new(program, own)?);
        }
        let covering = |ready: &Ready<Kernel>| {
            let entry =
                interface.entries.iter().find(|entry| entry.name == ready.program.entry()).expect("kernels are made from these entries");
            workgroups(&covered(entry, interface, step), memory.size, ready.program.workgroup_size())
        };
        Ok(Work {
            name: step.node.clone(),
            workgroups: kernels.iter().map(covering).collect(),
            kernels,
            drawings,
            targets,
            live,
            outputs: outputs(step),
            cleared: cleared(plan, index),
            generation: None,
        })
    }

    /// Binds group 0, if it is not bound to these globals already.
    pub fn bind_globals(&mut self, context: &Context, globals: &dyn Globals) -> Result<(), Error> {
        let generation = Some(globals.generation());
        if self.generation == generation {
            return Ok(());
        }
        let find = |binding: &Binding| globals.resource(&binding.module, &binding.name);
        for ready in &mut self.kernels {
            ready.globals = ready.program.bind(context, 0, find)?;
        }
        for ready in &mut self.drawings {
            ready.globals = ready.program.program().bind(context, 0, find)?;
        }
        self.generation = generation;
        Ok(())
    }

    /// Globals that will come must be bound anew.
    pub fn forget_globals(&mut self) {
        self.generation = None;
    }

    /// Records what must happen to memory before the pass.
    pub fn record_before(&self, encoder: &mut wgpu::CommandEncoder, pool: &Pool, parity: usize) {
        for half in &self.outputs {
            pool.record_poison(encoder, pool.part(*half, parity));
        }
        for half in &self.cleared {
            pool.record_zeros(encoder, pool.part(*half, parity));
        }
    }

    /// Sends live parameters that changed.
    pub fn send_params(&mut self, queue: &wgpu::Queue) {
        if let Some(Live { params, buffer }) = &mut self.live
            && let Some(bytes) = params.take_changes()
        {
            queue.write_buffer(buffer, 0, bytes);
        }
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// Memory of the images that the node draws into.
    pub fn images(&self) -> impl Iterator<Item = ResourceMemory> {
        self.targets.memory()
    }

    pub fn entries(&self) -> impl Iterator<Item = &str> {
        self.kernels.iter().map(|ready| ready.program.entry())
    }

    pub fn fragments(&self) -> impl Iterator<Item = &str> {
        self.drawings.iter().map(|ready| ready.program.entry())
    }

    /// Every kernel, over what it writes.
    pub fn dispatch_all(&self) -> impl Iterator<Item = Job> {
        self.workgroups.iter().enumerate().map(|(kernel, &workgroups)| Job::Dispatch { kernel, workgroups })
    }

    /// One kernel; without a number of workgroups, over what it writes.
    pub fn dispatch(&self, entry: &str, workgroups: Option<[u32; 3]>) -> Result<Job, PassError> {
        let kernel = position(Stage::Compute, entry, self.entries())?;
        Ok(Job::Dispatch { kernel, workgroups: workgroups.unwrap_or(self.workgroups[kernel]) })
    }

    /// One drawing.
    pub fn draw(&self, entry: &str, batches: &[Batch]) -> Result<Job, PassError> {
        let drawing = position(Stage::Fragment, entry, self.fragments())?;
        Ok(Job::Draw { drawing, batches: batches.to_vec() })
    }

    /// Records what was asked for: neighbouring dispatches share a wgpu pass, each draw is one. The timestamps are those of node `index`.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, jobs: &[Job], parity: usize, stamps: Option<&Stamps>, index: usize) {
        let both_dispatch = |a: &Job, b: &Job| matches!((a, b), (Job::Dispatch { .. }, Job::Dispatch { .. }));
        // A node that asks for nothing is timed all the same.
        let groups: Vec<&[Job]> = if jobs.is_empty() { vec![&[]] } else { jobs.chunk_by(both_dispatch).collect() };
        for (at, group) in groups.iter().enumerate() {
            let stamp = stamps.and_then(|stamps| stamps.of(index, at == 0, at + 1 == groups.len()));
            match group {
                [Job::Draw { drawing, batches }] => {
                    let ready = &self.drawings[*drawing];
                    ready.program.record(encoder, &self.targets, &ready.groups(parity), batches, stamp);
                }
                dispatches => self.compute(encoder, dispatches, parity, stamp),
            }
        }
    }

    fn compute(&self, encoder: &mut wgpu::CommandEncoder, jobs: &[Job], parity: usize, stamp: Option<Stamp<'_>>) {
        let descriptor = wgpu::ComputePassDescriptor { label: Some(&self.name), timestamp_writes: stamp.map(Stamp::compute) };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        for job in jobs {
            if let Job::Dispatch { kernel, workgroups } = job {
                let ready = &self.kernels[*kernel];
                ready.program.dispatch(&mut pass, &ready.groups(parity), *workgroups);
            }
        }
    }

    /// Names of the live parameters.
    pub fn live(&self) -> Vec<String> {
        self.live.as_ref().map_or_else(Vec::new, |live| live.params.names())
    }

    pub fn set(&mut self, name: &str, value: Value) -> Result<(), PassError> {
        let known = self.live();
        match &mut self.live {
            Some(live) if live.params.has(name) => live.params.set(name, value).map_err(|error| PassError::WrongValue(error.to_string())),
            _ => Err(PassError::NotLive { name: name.to_owned(), known }),
        }
    }
}

impl<P> Ready<P> {
    fn new(program: P, [even, odd]: [Result<Option<wgpu::BindGroup>, Error>; 2]) -> Result<Self, Error> {
        Ok(Ready { program, globals: None, own: [even?, odd?] })
    }

    /// Bind groups of a frame of this parity.
    fn groups(&self, parity: usize) -> [Option<&wgpu::BindGroup>; 2] {
        [self.globals.as_ref(), self.own[parity].as_ref()]
    }
}

fn position<'a>(stage: Stage, entry: &str, known: impl Iterator<Item = &'a str>) -> Result<usize, PassError> {
    let known: Vec<&str> = known.collect();
    known.iter().position(|&name| name == entry).ok_or_else(|| PassError::NoEntry {
        stage: program::name(stage),
        entry: entry.to_owned(),
        known: known.iter().map(|&name| name.to_owned()).collect(),
    })
}

fn live(context: &Context, step: &Step, known: &Known) -> Result<Option<Live>, Error> {
    let Some(layout) = params::live_layout(&known.composed.interface) else { return Ok(None) };
    let params = LiveParams::new(layout, &step.params)?;
    let label = format!("{} {LIVE}", step.node);
    let buffer = context.guard(&step.node, || {
        context.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some(&label),
            size: params.size(),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })?;
    Ok(Some(Live { params, buffer }))
}

fn outputs(step: &Step) -> Vec<ResourceHalf> {
    let out = |name: &str| step.contract.ports.iter().any(|port| port.name == name && port.direction == Direction::Out);
    let halves = step.bindings.iter().filter(|wire| out(&wire.port)).filter_map(|wire| wire.resource);
    halves.filter(|half| half.when == When::This).collect()
}

/// Resources that begin a frame as zeros, and whose first step this is.
fn cleared(plan: &Plan, index: usize) -> Vec<ResourceHalf> {
    let halves = |step: &Step| step.bindings.iter().filter_map(|wire| wire.resource).collect::<Vec<_>>();
    let earlier: Vec<ResourceHalf> = plan.steps[..index].iter().flat_map(halves).collect();
    let mut own = halves(&plan.steps[index]);
    own.retain(|half| half.when == When::This && plan.resources[half.resource].clear && !earlier.contains(half));
    own
}
