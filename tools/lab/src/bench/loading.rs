//! How long a scene takes to load, to build and to upload.

use super::turns::{Contestant, Middle, turns};
use aquifer_render::{Context, Error, SceneGlobals, View};
use aquifer_scene::{Bvh, BvhOptions, BvhQuality, Scene, Tlas, WideBvh};
use serde::Serialize;
use std::{hint::black_box, sync::Arc};

/// Times of one scene.
#[derive(Clone, Debug, Serialize)]
pub struct LoadReport {
    /// In the scene's meshes.
    pub triangles: usize,
    /// Placed meshes.
    pub instances: usize,
    /// Rounds that counted.
    pub rounds: u32,
    /// Bytes on the device.
    pub device_bytes: u64,
    /// In the order of their turns.
    pub steps: Vec<StepReport>,
}

/// One step.
#[derive(Clone, Debug, Serialize)]
pub struct StepReport {
    /// What was done.
    pub name: &'static str,
    /// How long.
    pub seconds: Middle,
    /// As a multiple of the default build in the same round.
    pub of_default_build: Middle,
}

/// The default build's place among the steps.
const DEFAULT: usize = 2;

/// Measures; `load` makes the finished scene, from a file or from code.
///
/// # Errors
/// The first of `load`, or of the upload.
pub fn measure<E: From<Error>>(context: &Context, rounds: u32, load: impl Fn() -> Result<Scene, E>) -> Result<LoadReport, E> {
    let scene = Arc::new(load()?);
    let moment = scene.at(0.0, None).map_err(|error| Error::Globals(error.to_string()))?;
    let globals = || SceneGlobals::new(context, scene.clone(), View::default());
    let build = |quality| -> Contestant<'_, E> {
        let scene = &scene;
        Box::new(move || {
            let options = BvhOptions { quality, ..BvhOptions::default() };
            scene.meshes.iter().for_each(|mesh| drop(black_box(Bvh::of(mesh, &options))));
            Ok(())
        })
    };
    let mut contestants: Vec<(&'static str, Contestant<'_, E>)> = vec![
        ("load, hierarchies included", Box::new(|| load().map(|scene| drop(black_box(scene))))),
        ("hierarchies, fast", build(BvhQuality::Fast)),
        ("hierarchies, medium (default)", build(BvhQuality::Medium)),
        ("hierarchies, slow", build(BvhQuality::Slow)),
        (
            "wide hierarchies, medium",
            Box::new(|| {
                scene.meshes.iter().for_each(|mesh| drop(black_box(WideBvh::of(mesh, BvhQuality::Medium))));
                Ok(())
            }),
        ),
        (
            "upper level",
            Box::new(|| {
                black_box(Tlas::build(&scene, &moment));
                Ok(())
            }),
        ),
        ("upload", Box::new(|| globals().map(drop).map_err(E::from))),
    ];
    let (names, mut contestants): (Vec<_>, Vec<_>) = contestants.drain(..).unzip();
    let seconds = turns(rounds, &mut contestants)?;
    drop(contestants);
    let steps = names.iter().zip(&seconds).filter_map(|(name, times)| {
        let of_default = times.iter().zip(&seconds[DEFAULT]).map(|(own, default)| own / default);
        Some(StepReport { name, seconds: Middle::of(times.iter().copied())?, of_default_build: Middle::of(of_default)? })
    });
    Ok(LoadReport {
        triangles: scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum(),
        instances: moment.instances.len(),
        rounds,
        device_bytes: globals()?.bytes(),
        steps: steps.collect(),
    })
}
