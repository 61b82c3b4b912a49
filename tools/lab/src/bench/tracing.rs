//! How fast rays are traced: every filling of slot `trace` on the device, beside obvhs on the CPU, on the same rays.

use super::{
    device, host,
    rays::{Range, Ray, RayKind},
    turns::{Contestant, Middle, turns},
};
use crate::stage::{self, StageError};
use aquifer_render::{Context, Error, FrameInfo, Globals as _, Job, SceneGlobals, View};
use aquifer_scene::{CpuTracer, Moment, Scene, Tlas};
use serde::Serialize;
use std::{path::PathBuf, sync::Arc};

/// What to measure.
#[derive(Clone, Debug)]
pub struct TraceOptions {
    /// Fillings of slot `trace`; empty for all.
    pub tracers: Vec<String>,
    /// Pixels across and down, with one ray of each kind.
    pub size: [u32; 2],
    /// Rounds that count.
    pub rounds: u32,
    /// Times that the device traces the rays in a round: so many that submitting and waiting cost nothing beside it.
    pub repeats: u32,
    /// Folders of shaders over the built-in ones.
    pub shaders: Vec<PathBuf>,
}

/// Speeds on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct TraceReport {
    /// Who traced.
    pub adapter: String,
    /// Threads of obvhs.
    pub threads: usize,
    /// In the scene's meshes.
    pub triangles: usize,
    /// Placed meshes.
    pub instances: usize,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Rounds that counted.
    pub rounds: u32,
    /// One a kind of rays.
    pub kinds: Vec<KindReport>,
}

/// Speeds for one kind of rays.
#[derive(Clone, Debug, Serialize)]
pub struct KindReport {
    /// What for.
    pub kind: RayKind,
    /// How many.
    pub rays: usize,
    /// The share that hits something.
    pub hits: f64,
    /// In the order of their turns.
    pub tracers: Vec<TracerReport>,
}

/// One contestant.
#[derive(Clone, Debug, Serialize)]
pub struct TracerReport {
    /// A filling of slot `trace`, or obvhs and its threads.
    pub name: String,
    /// Million rays a second.
    pub mrays_per_second: Middle,
    /// Speed as a share of obvhs's on all threads in the same round.
    pub of_obvhs: Middle,
    /// Share of the rays whose hit is another than obvhs's, on the device: ties and edges.
    pub differing: Option<f64>,
}

/// A scene made ready.
struct Target<'a> {
    context: &'a Context,
    globals: SceneGlobals,
    registry: aquifer_render::Registry,
    tracer: CpuTracer,
    firsts: Vec<u32>,
    moment: Moment,
    options: &'a TraceOptions,
}

/// Measures.
///
/// # Errors
/// Of a scene that is not finished, of shaders, and of the device; [`Error::Pass`] never.
pub fn measure(context: &Context, scene: &Arc<Scene>, options: &TraceOptions) -> Result<TraceReport, StageError> {
    let moment = scene.at(0.0, None).map_err(|error| Error::Globals(error.to_string()))?;
    let tlas = Tlas::build(scene, &moment);
    let mut library = stage::library(&options.shaders)?;
    device::add_kernel(&mut library);
    let registry = aquifer_passes::registry(library, Some(scene))?;
    let mut globals = SceneGlobals::new(context, scene.clone(), View::default())?;
    globals.advance(context, &FrameInfo { index: 0, seed: 0, size: options.size, history_valid: false })?;
    let firsts = scene.meshes.iter().scan(0, |next, mesh| Some(std::mem::replace(next, *next + mesh.triangles.len() as u32)));
    let tracer = CpuTracer::new(scene, &moment, &tlas);
    let target = Target { context, globals, registry, tracer, firsts: firsts.collect(), moment, options };
    let range = Range::new(scene, &target.moment, &tlas, &target.tracer, options.size);
    let kinds: Result<Vec<_>, Error> = RayKind::ALL.iter().map(|&kind| target.measure(kind, &range.rays(kind))).collect();
    Ok(TraceReport {
        adapter: context.adapter().name.clone(),
        threads: host::all_threads(),
        triangles: scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum(),
        instances: target.moment.instances.len(),
        size: options.size,
        rounds: options.rounds,
        kinds: kinds?,
    })
}

impl Target<'_> {
    fn measure(&self, kind: RayKind, rays: &[Ray]) -> Result<KindReport, Error> {
        let wanted = &self.options.tracers;
        let names = if wanted.is_empty() { device::tracers(&self.registry) } else { wanted.clone() };
        let job = |name: &String| device::job(self.context, &self.registry, &self.globals, name, kind, (rays, self.options.size[0]));
        let jobs: Vec<Job> = names.iter().map(job).collect::<Result<_, _>>()?;
        let repeats = self.options.repeats;
        let mut contestants: Vec<Contestant<'_, Error>> = Vec::new();
        for job in &jobs {
            contestants.push(Box::new(move || job.run(repeats)));
        }
        for threads in [1, host::all_threads()] {
            contestants.push(Box::new(move || {
                std::hint::black_box(host::trace(&self.tracer, kind, rays, threads));
                Ok(())
            }));
        }
        let seconds = turns(self.options.rounds, &mut contestants)?;
        drop(contestants);
        let count = rays.iter().filter(|ray| ray.exists()).count();
        let traced = |contestant: usize| count as f64 * if contestant < jobs.len() { f64::from(repeats) } else { 1.0 } / 1e6;
        let speeds: Vec<Vec<f64>> =
            seconds.iter().enumerate().map(|(i, times)| times.iter().map(|time| traced(i) / time).collect()).collect();
        let reference = speeds.last().map(Vec::as_slice).unwrap_or_default();
        let obvhs = [1, host::all_threads()].map(|threads| format!("obvhs, {threads} threads"));
        let tracers = names.iter().chain(&obvhs).enumerate().filter_map(|(i, name)| {
            Some(Ok(TracerReport {
                name: name.clone(),
                mrays_per_second: Middle::of(speeds[i].iter().copied())?,
                of_obvhs: Middle::of(speeds[i].iter().zip(reference).map(|(own, other)| own / other))?,
                differing: match jobs.get(i).map(|job| self.differing(job, kind, rays)).transpose() {
                    Ok(differing) => differing.map(|differing| differing as f64 / count as f64),
                    Err(error) => return Some(Err(error)),
                },
            }))
        });
        let tracers = tracers.collect::<Result<_, Error>>()?;
        Ok(KindReport { kind, rays: count, hits: host::trace(&self.tracer, kind, rays, 1) as f64 / count as f64, tracers })
    }

    /// How many rays hit something else on the device than on the CPU.
    fn differing(&self, job: &Job, kind: RayKind, rays: &[Ray]) -> Result<usize, Error> {
        let answers = device::answers(job)?;
        let differs = |(ray, answer): &(&Ray, &device::Answer)| {
            let (origin, direction, range) = (ray.origin.into(), ray.direction.into(), [0.0, ray.t_max]);
            let hit = answer[0] != u32::MAX;
            match kind {
                RayKind::Shadow => self.tracer.occluded(origin, direction, range) != hit,
                RayKind::Camera | RayKind::Bounce => {
                    let found = self.tracer.closest(origin, direction, range);
                    let expected = found.map(|hit| {
                        let mesh = self.moment.instances[hit.instance as usize].mesh;
                        (hit.instance, self.firsts[mesh as usize] + hit.triangle)
                    });
                    expected != hit.then_some((answer[0], answer[1]))
                }
            }
        };
        let pairs: Vec<_> = rays.iter().zip(&answers).filter(|(ray, _)| ray.exists()).collect();
        assert!(pairs.iter().all(|(_, answer)| answer[3] == 0), "the traversal stack ran over");
        Ok(pairs.iter().filter(|pair| differs(pair)).count())
    }
}
