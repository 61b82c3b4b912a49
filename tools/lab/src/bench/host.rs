//! Tracing on the CPU by obvhs's traversal, on one thread or on all.

use super::rays::{Ray, RayKind};
use aquifer_scene::CpuTracer;
use std::{
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

/// Rays that a thread takes at a time.
const BATCH: usize = 1024;

/// How many threads there can be.
pub fn all_threads() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Traces all rays on so many threads; returns how many hit something.
pub fn trace(tracer: &CpuTracer, kind: RayKind, rays: &[Ray], threads: usize) -> usize {
    let next = AtomicUsize::new(0);
    let work = || {
        let batches = std::iter::from_fn(|| {
            let begin = next.fetch_add(BATCH, Ordering::Relaxed);
            rays.get(begin..(begin + BATCH).min(rays.len())).filter(|batch| !batch.is_empty())
        });
        batches.map(|batch| batch.iter().filter(|ray| hits(tracer, kind, ray)).count()).sum::<usize>()
    };
    if threads == 1 {
        return work();
    }
    thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        work() + others.into_iter().map(|other| other.join().unwrap_or_default()).sum::<usize>()
    })
}

fn hits(tracer: &CpuTracer, kind: RayKind, ray: &Ray) -> bool {
    let (origin, direction, range) = (ray.origin.into(), ray.direction.into(), [0.0, ray.t_max]);
    match kind {
        _ if !ray.exists() => false,
        RayKind::Shadow => tracer.occluded(origin, direction, range),
        RayKind::Camera | RayKind::Bounce => tracer.closest(origin, direction, range).is_some(),
    }
}
