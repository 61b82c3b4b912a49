//! One step of a plan, ready to run: kernels, bind groups, live parameters.

use crate::{
    Context, Error, Globals, Kernel, Pass, PassError,
    limits::{covered, workgroups},
    params::{self, LIVE, LiveParams},
    pool::{self, Pool},
    registry::Known,
};
use aquifer_graph::{Direction, Plan, ResourceHalf, Step, Value, When};
use aquifer_shader::{Binding, Stage};

/// A pass with what it dispatches.
pub(crate) struct Node {
    pub pass: Box<dyn Pass>,
    pub work: Work,
}

/// All of a node but its decisions.
pub(crate) struct Work {
    name: String,
    kernels: Vec<Ready>,
    live: Option<Live>,
    /// What the node writes in full.
    outputs: Vec<ResourceHalf>,
    /// What must be zeros when the node begins.
    cleared: Vec<ResourceHalf>,
    /// Of the globals that are bound.
    generation: Option<u64>,
}

struct Ready {
    kernel: Kernel,
    workgroups: [u32; 3],
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

/// Compiles every compute entry point of a step.
pub(crate) fn compile(context: &Context, step: &Step, known: &Known) -> Result<Vec<Kernel>, Error> {
    let constants = params::constants(step, &known.composed.interface);
    let compute = known.composed.interface.entries.iter().filter(|entry| entry.stage == Stage::Compute);
    compute.map(|entry| Kernel::compute(context, &step.node, &known.composed, &entry.name, &constants)).collect()
}

impl Work {
    /// Binds the kernels of step `index` to the pool's memory.
    pub fn new(
        context: &Context,
        plan: &Plan,
        index: usize,
        known: &Known,
        kernels: Vec<Kernel>,
        memory: Memory<'_>,
    ) -> Result<Work, Error> {
        let (step, interface) = (&plan.steps[index], &known.composed.interface);
        let live = live(context, step, known)?;
        let ready = |kernel: Kernel| {
            let entry = interface.entries.iter().find(|entry| entry.name == kernel.entry()).expect("kernels are made from these entries");
            let workgroups = workgroups(&covered(entry, interface, step), memory.size, kernel.workgroup_size());
            let bind = |parity| {
                kernel.bind(context, 1, |binding| match &live {
                    Some(live) if binding.name == LIVE => Some(live.buffer.as_entire_binding()),
                    _ => memory.of(step, binding, parity),
                })
            };
            let own = [bind(0)?, bind(1)?];
            Ok(Ready { kernel, workgroups, globals: None, own })
        };
        Ok(Work {
            name: step.node.clone(),
            kernels: kernels.into_iter().map(ready).collect::<Result<_, Error>>()?,
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
        for ready in &mut self.kernels {
            ready.globals = ready.kernel.bind(context, 0, |binding| globals.resource(&binding.module, &binding.name))?;
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

    pub fn entries(&self) -> impl Iterator<Item = &str> {
        self.kernels.iter().map(|ready| ready.kernel.entry())
    }

    pub fn run_all(&self, compute: &mut wgpu::ComputePass<'_>, parity: usize) {
        for ready in &self.kernels {
            ready.dispatch(compute, parity, ready.workgroups);
        }
    }

    pub fn run(
        &self,
        compute: &mut wgpu::ComputePass<'_>,
        parity: usize,
        entry: &str,
        workgroups: Option<[u32; 3]>,
    ) -> Result<(), PassError> {
        let ready = self
            .kernels
            .iter()
            .find(|ready| ready.kernel.entry() == entry)
            .ok_or_else(|| PassError::NoEntry { entry: entry.to_owned(), known: self.entries().map(str::to_owned).collect() })?;
        ready.dispatch(compute, parity, workgroups.unwrap_or(ready.workgroups));
        Ok(())
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

impl Ready {
    fn dispatch(&self, compute: &mut wgpu::ComputePass<'_>, parity: usize, workgroups: [u32; 3]) {
        self.kernel.dispatch(compute, &[self.globals.as_ref(), self.own[parity].as_ref()], workgroups);
    }
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
