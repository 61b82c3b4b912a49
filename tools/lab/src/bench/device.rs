//! Tracing on the device.

use super::rays::{Ray, RayKind};
use aquifer_graph::Slots;
use aquifer_render::{Context, Data, Error, Globals, Job, Once, Registry};
use aquifer_shader::Library;

/// Name of the kernel among the passes.
const KERNEL: &str = "bench_trace";

/// Puts the kernel into the library, unless a folder of the user's has its own.
pub fn add_kernel(library: &mut Library) {
    let path = format!("pass/{KERNEL}");
    if library.text(&path).is_none() {
        library.insert(path, include_str!("trace.wgsl"), "bench/trace.wgsl");
    }
}

/// Every filling of slot `trace` that needs no port of its own, the default first.
pub fn tracers(registry: &Registry) -> Vec<String> {
    use aquifer_graph::Contracts as _;
    let default = registry.library().default_slots().remove("trace");
    let mut all = registry.slots().remove("trace").unwrap_or_default();
    // The kernel's are the rays and their hits. One that does not compose is kept, so that its error shows.
    all.retain(|name| registry.known(KERNEL, &filled(name)).map_or(true, |known| known.contract.ports.len() <= 2));
    all.sort_by_key(|name| Some(name) != default.as_ref());
    all
}

fn filled(tracer: &str) -> Slots {
    Slots::from([("trace".to_owned(), tracer.to_owned())])
}

/// What a ray hit: instance (`u32::MAX` for nothing), triangle among all of the scene's, bits of t, 1 where the stack ran over.
pub type Answer = [u32; 4];

/// The kernel with `tracer` in slot `trace`, on rays that stand `width` in a row; `globals` must have been advanced to a frame.
///
/// # Errors
/// As [`Registry::known`] and [`Job::new`].
pub fn job(
    context: &Context,
    registry: &Registry,
    globals: &dyn Globals,
    tracer: &str,
    kind: RayKind,
    (rays, width): (&[Ray], u32),
) -> Result<Job, Error> {
    let known = registry.known(KERNEL, &filled(tracer)).map_err(|source| Error::Contract { pass: tracer.to_owned(), source })?;
    let entry = if kind == RayKind::Shadow { "any" } else { "nearest" };
    let groups = known.composed.interface.entries.iter().find(|known| known.name == entry).map_or([8, 8, 1], |entry| entry.workgroup_size);
    let height = (rays.len() as u32).div_ceil(width);
    let once = Once {
        shader: &known.composed,
        entry,
        constants: &[("width", f64::from(width))],
        buffers: &[("rays", Data::In(bytemuck::cast_slice(rays))), ("hits", Data::Out((rays.len() * size_of::<Answer>()) as u64))],
        workgroups: [width.div_ceil(groups[0]), height.div_ceil(groups[1]), 1],
    };
    Job::new(context, &once, globals)
}

/// One a ray, after a run.
///
/// # Errors
/// As [`Job::results`].
pub fn answers(job: &Job) -> Result<Vec<Answer>, Error> {
    let results = job.results()?;
    Ok(results.iter().flat_map(|bytes| bytemuck::pod_collect_to_vec::<u8, Answer>(bytes)).collect())
}
