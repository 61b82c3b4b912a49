//! A plan on a device: one submission a step, so that each can be timed, and named when it hangs.

use crate::{
    Context, Error, Frame, FrameInfo, Globals, MemoryReport, PortCounts, Registry, RendererOptions, Startup, Timings,
    counters::Counters,
    limits, node,
    node::{Memory, Node, Work},
    pool::{Part, Pool},
    readback::Mapping,
    stamps::{FRAMES_IN_FLIGHT, Stamps},
    timing::{Clock, Stopwatch, elapsed},
};
use aquifer_graph::{Life, Plan, ResourceHalf, Step, Value, When};
use std::{collections::VecDeque, time::Instant};

/// A plan with its kernels and memory, at one size.
pub(crate) struct Executor {
    context: Context,
    plan: Plan,
    nodes: Vec<Node>,
    pool: Pool,
    memory: MemoryReport,
    counters: Option<Counters>,
    stamps: Option<Stamps>,
    watch: Stopwatch,
    flights: VecDeque<Flight>,
    frames: u64,
    /// Which halves of the history pairs are this frame's.
    parity: usize,
    startup: Startup,
}

/// A frame under way.
struct Flight {
    /// By step.
    submissions: Vec<wgpu::SubmissionIndex>,
    stamps: Option<Mapping>,
    /// Counts for the timings.
    timed: bool,
}

impl Executor {
    /// Composes, checks limits, compiles, allocates, binds: in this order, so that nothing is allocated for a plan that cannot run.
    pub fn new(context: &Context, registry: &Registry, plan: Plan, options: &RendererOptions) -> Result<Executor, Error> {
        let (begin, size) = (Instant::now(), options.size);
        let contract = |pass: &str, source| Error::Contract { pass: pass.to_owned(), source };
        let known = plan.steps.iter().map(|step| registry.known(&step.kind, &step.slots).map_err(|source| contract(&step.node, source)));
        let known = known.collect::<Result<Vec<_>, Error>>()?;
        let composed = Instant::now();
        limits::check(&plan, known.iter().map(|known| &known.composed), size, context.limits())?;
        let programs = plan.steps.iter().zip(&known).map(|(step, known)| node::compile(context, step, known));
        let programs = programs.collect::<Result<Vec<_>, Error>>()?;
        let compiled = Instant::now();
        let pool = Pool::new(context, &plan, size, options.poison)?;
        let mut nodes = Vec::new();
        for (index, (known, programs)) in known.iter().zip(programs).enumerate() {
            let (step, memory) = (&plan.steps[index], Memory { pool: &pool, size });
            let kind = registry.kind(&step.kind).map_err(|source| contract(&step.node, source))?;
            let pass = (kind.build)(step).map_err(|source| Error::Pass { pass: step.node.clone(), source })?;
            nodes.push(Node { pass, work: Work::new(context, &plan, index, known, programs, memory)? });
        }
        let memory = pool.report().with(nodes.iter().flat_map(|node: &Node| node.work.images()));
        let counters = options.counters.then(|| Counters::new(context, &plan, &known, &pool, size)).transpose()?;
        let stamps = Stamps::new(context, nodes.len())?;
        let clock = if stamps.is_some() { Clock::Timestamps } else { Clock::Wall };
        let names = plan.steps.iter().map(|step| step.node.clone()).collect();
        let startup = Startup { compose: composed - begin, pipelines: compiled - composed, memory: compiled.elapsed(), first_frame: None };
        Ok(Executor {
            context: context.clone(),
            plan,
            nodes,
            pool,
            memory,
            counters,
            stamps,
            watch: Stopwatch::new(clock, names),
            flights: VecDeque::new(),
            frames: 0,
            parity: 0,
            startup,
        })
    }

    /// Renders one frame. Returns when it is submitted; the first frame, which drivers compile in, is waited for.
    pub fn frame(&mut self, info: &FrameInfo, globals: &mut dyn Globals) -> Result<(), Error> {
        let begin = Instant::now();
        while self.flights.len() >= FRAMES_IN_FLIGHT {
            self.land()?;
        }
        globals.advance(&self.context, info)?;
        self.parity ^= 1;
        let first = self.frames == 0;
        let mut flight = Flight { submissions: Vec::new(), stamps: None, timed: !first };
        let mut walls = Vec::new();
        for index in 0..self.nodes.len() {
            let submitted = Instant::now();
            let submission = self.step(index, info, globals)?;
            if self.watch.clock() == Clock::Wall {
                self.context.wait(&submission, self.nodes[index].work.name())?;
                walls.push(Some(submitted.elapsed().as_secs_f64() * 1e9));
            }
            flight.submissions.push(submission);
        }
        flight.stamps = self.stamps.as_ref().map(|stamps| {
            let buffer = stamps.readback(self.slot());
            Mapping::begin(buffer, buffer.size())
        });
        if self.watch.clock() == Clock::Wall && !first {
            self.watch.frame(walls);
        }
        self.flights.push_back(flight);
        self.frames += 1;
        if first {
            self.finish()?;
            self.startup.first_frame = Some(begin.elapsed());
        }
        Ok(())
    }

    fn slot(&self) -> usize {
        (self.frames % FRAMES_IN_FLIGHT as u64) as usize
    }

    fn step(&mut self, index: usize, info: &FrameInfo, globals: &dyn Globals) -> Result<wgpu::SubmissionIndex, Error> {
        let (slot, parity) = (self.slot(), self.parity);
        let resolve = index + 1 == self.nodes.len();
        let Executor { context, nodes, pool, counters, stamps, .. } = self;
        let Node { pass, work } = &mut nodes[index];
        work.bind_globals(context, globals)?;
        let name = work.name().to_owned();
        let label = Some(name.as_str());
        let recorded = context.guard(&name, || {
            let mut encoder = context.device().create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
            work.record_before(&mut encoder, pool, parity);
            let mut frame = Frame { info, work, scene: globals.batches(), jobs: Vec::new() };
            let outcome = pass.record(&mut frame);
            let jobs = frame.jobs;
            work.record(&mut encoder, &jobs, parity, stamps.as_ref(), index);
            if let Some(counters) = counters {
                counters.record(&mut encoder, index, parity);
            }
            if let (Some(stamps), true) = (stamps, resolve) {
                stamps.record_resolve(&mut encoder, slot);
            }
            let commands = encoder.finish();
            outcome.map(|()| {
                work.send_params(context.queue());
                context.queue().submit([commands])
            })
        })?;
        recorded.map_err(|source| Error::Pass { pass: name, source })
    }

    /// Waits for the oldest frame under way.
    fn land(&mut self) -> Result<(), Error> {
        let Some(flight) = self.flights.pop_front() else { return Ok(()) };
        for (submission, node) in flight.submissions.iter().zip(&self.nodes) {
            self.context.wait(submission, node.work.name())?;
        }
        let (Some(mapping), Some(stamps)) = (flight.stamps, &self.stamps) else { return Ok(()) };
        let mut ticks = Vec::new();
        mapping.end(&self.context, "timestamps", |bytes| ticks.extend(bytes.chunks_exact(8).map(to_u64)))?;
        if flight.timed {
            self.watch.frame(elapsed(&ticks, stamps.nanoseconds_per_tick()));
        }
        Ok(())
    }

    /// Waits for every frame under way.
    pub fn finish(&mut self) -> Result<(), Error> {
        while !self.flights.is_empty() {
            self.land()?;
        }
        Ok(())
    }

    /// Zeros in all memory, beginnings in all passes.
    pub fn restart(&mut self) -> Result<(), Error> {
        let (context, pool) = (&self.context, &self.pool);
        context.guard("restart", || {
            let mut encoder = context.device().create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("restart") });
            pool.record_clear(&mut encoder);
            context.queue().submit([encoder.finish()])
        })?;
        self.nodes.iter_mut().for_each(|node| node.pass.restart());
        Ok(())
    }

    /// Globals that will come must be bound anew.
    pub fn forget_globals(&mut self) {
        self.nodes.iter_mut().for_each(|node| node.work.forget_globals());
    }

    /// Sets a live parameter of a pass, in all its rounds.
    pub fn set(&mut self, pass: &str, name: &str, value: Value) -> Result<(), Error> {
        let known = || self.plan.steps.iter().map(|step| step.node.clone()).collect();
        let is_meant = |step: &Step| step.pass == pass || step.node == pass;
        let rounds: Vec<usize> = (0..self.nodes.len()).filter(|&index| is_meant(&self.plan.steps[index])).collect();
        if rounds.is_empty() {
            return Err(Error::NoPass { pass: pass.to_owned(), known: known() });
        }
        for index in rounds {
            self.nodes[index].work.set(name, value).map_err(|source| Error::Pass { pass: pass.to_owned(), source })?;
            // Whoever builds the plan anew, at another size, finds the value.
            self.plan.steps[index].params.insert(name.to_owned(), value);
        }
        Ok(())
    }

    /// A resource as the last frame left it, by a name that was kept, its own name, or any `pass.port` that it is wired to.
    pub fn part(&self, name: &str) -> Result<Part<'_>, Error> {
        let half = match self.plan.kept.iter().find(|kept| kept.name == name) {
            Some(kept) => kept.resource.ok_or_else(|| Error::LeftOut { name: name.to_owned() })?,
            None => self.find(name).ok_or_else(|| Error::NoResource { name: name.to_owned(), known: self.readable() })?,
        };
        match self.plan.resources[half.resource].life {
            Life::Transient { .. } => Err(Error::NotKept { name: name.to_owned() }),
            Life::History | Life::Output => Ok(self.pool.part(half, self.parity)),
        }
    }

    fn find(&self, name: &str) -> Option<ResourceHalf> {
        if let Some(resource) = self.plan.resources.iter().position(|resource| resource.name == name) {
            return Some(ResourceHalf { resource, when: When::This });
        }
        let (pass, port) = name.rsplit_once('.')?;
        // The name of a repeated pass means its last round.
        let step = self.plan.steps.iter().rfind(|step| step.node == pass || step.pass == pass)?;
        step.resource(port)
    }

    fn readable(&self) -> Vec<String> {
        self.plan.resources.iter().map(|resource| resource.name.clone()).collect()
    }

    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    pub fn startup(&self) -> Startup {
        self.startup
    }

    pub fn timings(&self) -> Timings {
        self.watch.timings()
    }

    pub fn memory(&self) -> &MemoryReport {
        &self.memory
    }

    /// What the passes' outputs held; nothing where nobody counts.
    pub fn counts(&self) -> Result<Vec<PortCounts>, Error> {
        self.counters.as_ref().map_or(Ok(Vec::new()), |counters| counters.read(&self.context))
    }

    /// What passes have to say, by name.
    pub fn reports(&self) -> Vec<(String, String)> {
        let report = |node: &Node| Some((node.work.name().to_owned(), node.pass.report()?));
        self.nodes.iter().filter_map(report).collect()
    }
}

fn to_u64(bytes: &[u8]) -> u64 {
    u64::from_le_bytes(bytes.try_into().expect("chunks are of 8 bytes"))
}
