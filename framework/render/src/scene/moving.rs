//! What is written for each frame: camera, transforms, lights and the upper hierarchy, now and before.

use super::{
    View,
    mirror::{self, NONE},
    nodes,
    still::Still,
    store::Store,
};
use crate::{Context, Error, FrameInfo};
use aquifer_scene::{Camera, Features, Light, LightList, Moment, Scene, SceneError, Tlas};
use std::collections::BTreeMap;

/// The scene at one time, in bytes.
pub struct State {
    time: f32,
    view: View,
    camera: Camera,
    /// (name of this frame's array, name of last frame's, bytes).
    arrays: [Array; 5],
    /// Lights that can be drawn.
    lights: u32,
    /// Levels of the upper hierarchy.
    pub depth: u32,
}

struct Array {
    now: &'static str,
    /// The fact that shaders have it with; empty where they always do.
    fact: &'static str,
    /// Empty where shaders never ask for last frame's.
    before: &'static str,
    /// The fact that shaders have last frame's with.
    before_fact: &'static str,
    /// A table, not a buffer.
    table: bool,
    bytes: Vec<u8>,
}

impl State {
    pub fn of(scene: &Scene, still: &Still, view: &View, frame: u32) -> Result<State, SceneError> {
        let time = view.time_at(frame);
        let moment = scene.at(time, view.camera.as_deref())?;
        let tlas = Tlas::build(scene, &moment);
        let list = LightList::build(scene, &still.emitters, still.environment.as_ref(), &moment, &tlas);
        let lights = light_records(&moment, &list, still);
        let arrays = [
            Array {
                now: "scene/geometry::instances",
                fact: "",
                before: "scene/geometry::instances_prev",
                before_fact: "moving_objects",
                table: true,
                bytes: bytes(&instances(&moment, &list, still)),
            },
            Array {
                now: "scene/hierarchy::tlas",
                fact: "",
                before: "scene/hierarchy::tlas_prev",
                before_fact: "moving_objects",
                table: true,
                bytes: bytes(&nodes::upper(&tlas.bvh)),
            },
            Array {
                now: "scene/punctual::punctuals",
                fact: "punctual_lights",
                before: "scene/punctual::punctuals_prev",
                before_fact: "moving_lights",
                table: false,
                bytes: bytes(&punctuals(scene, &moment)),
            },
            Array { now: "lights/scene::lights", fact: "", before: "", before_fact: "", table: false, bytes: bytes(&lights) },
            Array { now: "scene/bounds::bounds", fact: "", before: "", before_fact: "", table: false, bytes: bytes(&[bounds(&tlas)]) },
        ];
        let drawable = if list.table.is_empty() { 0 } else { list.lights.len() as u32 };
        Ok(State { time, view: view.clone(), camera: view.free.unwrap_or(moment.camera), arrays, lights: drawable, depth: tlas.bvh.depth })
    }

    /// Nothing would change.
    pub fn is_at(&self, view: &View, time: f32) -> bool {
        self.time == time && self.view.camera == view.camera && self.view.free == view.free
    }
}

fn bytes<T: bytemuck::Pod>(records: &[T]) -> Vec<u8> {
    let zero = [T::zeroed()];
    bytemuck::cast_slice(if records.is_empty() { &zero } else { records }).to_vec()
}

fn instances(moment: &Moment, list: &LightList, still: &Still) -> Vec<mirror::Instance> {
    let record = |(instance, &first_light): (&aquifer_scene::Instance, &u32)| {
        let place = still.places[instance.mesh as usize];
        mirror::Instance::new(instance, place.first_triangle, first_light)
    };
    moment.instances.iter().zip(&list.first_of_instance).map(record).collect()
}

fn punctuals(scene: &Scene, moment: &Moment) -> Vec<mirror::Punctual> {
    moment.lights.iter().map(|placed| mirror::Punctual::new(&scene.lights[placed.light as usize], placed)).collect()
}

fn light_records(moment: &Moment, list: &LightList, still: &Still) -> Vec<mirror::Light> {
    let record = |(at, light): (usize, &Light)| {
        let entry = list.table.entries.get(at).copied().unwrap_or_default();
        let (kind, index, triangle) = match *light {
            Light::Triangle(t) => {
                let mesh = moment.instances[t.instance as usize].mesh;
                (0, t.instance, still.places[mesh as usize].first_triangle + t.triangle)
            }
            Light::Punctual(index) => (1, index, NONE),
            Light::Environment => (2, NONE, NONE),
        };
        mirror::Light { kind, index, triangle, pmf: entry.pmf, threshold: entry.threshold, other: entry.alias }
    };
    list.lights.iter().enumerate().map(record).collect()
}

fn bounds(tlas: &Tlas) -> mirror::Bounds {
    tlas.bounds().map(|found| mirror::Bounds { low: found.min.into(), high: found.max.into(), ..Default::default() }).unwrap_or_default()
}

/// The arrays on the device.
pub struct Moving {
    stores: BTreeMap<&'static str, Store>,
    /// Names of arrays, with the fact that the scene lacks.
    pub left_out: Vec<(&'static str, &'static str)>,
    frame: Store,
    /// Of the scene: lights or objects move.
    moves: bool,
    /// Shaders know of a camera that moves.
    camera_moves: bool,
    /// Deepest upper hierarchy that the traversal stack was sized for.
    depth: u32,
    /// Camera of the frame before.
    camera: Option<mirror::Camera>,
}

const FRAME: &str = "frame/frame::frame";

impl Moving {
    pub fn new(context: &Context, scene: &Scene, features: &Features, first: &State, depth: u32) -> Result<Moving, Error> {
        let names = features.names();
        let (mut stores, mut left_out) = (BTreeMap::new(), Vec::new());
        for Array { now, fact, before, before_fact, table, bytes } in &first.arrays {
            let mut contents = bytes.clone();
            contents.resize(contents.len().max(room(now, first)), 0);
            let make = |name| match table {
                true => Store::table(context, name, &contents),
                false => Store::buffer(context, name, &contents, wgpu::BufferUsages::STORAGE),
            };
            for (name, fact) in [(now, fact), (before, before_fact)].into_iter().filter(|(name, _)| !name.is_empty()) {
                if fact.is_empty() || names.contains(fact) {
                    stores.insert(*name, make(name)?);
                } else {
                    left_out.push((*name, *fact));
                }
            }
        }
        let frame = Store::buffer(context, FRAME, &[mirror::Frame::default()], wgpu::BufferUsages::UNIFORM)?;
        let facts = Features::of(scene);
        let moves = facts.moving_objects || facts.moving_lights;
        let camera_moves = features.moving_camera;
        Ok(Moving { stores, left_out, frame, moves, camera_moves, depth, camera: None })
    }

    pub fn store(&self, name: &str) -> Option<&Store> {
        if name == FRAME { Some(&self.frame) } else { self.stores.get(name) }
    }

    pub fn arrays(&self) -> impl Iterator<Item = (&'static str, u64)> {
        self.stores.iter().map(|(name, store)| (*name, store.bytes())).chain([(FRAME, self.frame.bytes())])
    }

    pub fn write_now(&self, context: &Context, state: &State) -> Result<(), Error> {
        if state.depth > self.depth {
            let (found, room) = (state.depth, self.depth);
            return Err(Error::Globals(format!(
                "at {} s the scene's upper hierarchy is {found} levels deep; the traversal stack has room for {room}",
                state.time
            )));
        }
        state.arrays.iter().for_each(|array| self.write(context, array.now, &array.bytes));
        Ok(())
    }

    pub fn write_before(&self, context: &Context, state: &State) -> Result<(), Error> {
        state.arrays.iter().for_each(|array| self.write(context, array.before, &array.bytes));
        Ok(())
    }

    fn write(&self, context: &Context, name: &str, bytes: &[u8]) {
        if let Some(store) = self.stores.get(name) {
            store.write(context, bytes);
        }
    }

    pub fn write_frame(&mut self, context: &Context, info: &FrameInfo, state: &State, centred: bool) {
        let jitter = if centred { [0.5; 2] } else { jitter(info.seed, info.index) };
        let camera = mirror::Camera::new(&state.camera, jitter);
        let still = mirror::Camera { jitter_x: 0.0, jitter_y: 0.0, ..camera };
        let last = self.camera.replace(camera);
        // Without motion vectors, another camera is another film.
        let follows = |last: &mirror::Camera| self.camera_moves || mirror::Camera { jitter_x: 0.0, jitter_y: 0.0, ..*last } == still;
        let history_valid = info.history_valid && last.as_ref().is_none_or(follows);
        let before = last.filter(|_| history_valid).unwrap_or(camera);
        let frame = mirror::Frame {
            extent: info.size,
            index: info.index,
            history_valid: u32::from(history_valid),
            seed: [info.seed as u32, (info.seed >> 32) as u32],
            lights: state.lights,
            moving: self.moves.into(),
            camera,
            camera_prev: before,
        };
        self.frame.write(context, bytemuck::bytes_of(&frame));
    }
}

/// Bytes that an array may come to need. The upper hierarchy has less than one inner node an instance, but squashed instances are not in it: room
/// for them to come back.
fn room(name: &str, first: &State) -> usize {
    let instances = first.arrays[0].bytes.len() / size_of::<mirror::Instance>();
    if name.ends_with("tlas") { (1 + instances) * size_of::<nodes::Pair>() } else { 0 }
}

/// Place of the film sample in every pixel of a frame: the R2 sequence (Roberts 2018), turned by a hash of the seed. Uniform over seeds
/// for any one frame, evenly spread over frames for any one seed.
fn jitter(seed: u64, frame: u32) -> [f32; 2] {
    const STEPS: [u64; 2] = [0xc13f_a9a9_02a6_328f, 0x91e1_0da5_c79e_7b1d];
    let turn = [split_mix(seed), split_mix(seed ^ 0x5851_f42d_4c95_7f2d)];
    // Fixed point with 64 bits: exact for every frame. The top 24 are what an f32 below 1 can hold.
    [0, 1].map(|axis| (STEPS[axis].wrapping_mul(u64::from(frame)).wrapping_add(turn[axis]) >> 40) as f32 / (1 << 24) as f32)
}

/// SplitMix64's finaliser (Steele et al. 2014).
fn split_mix(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jitter_is_even_over_frames_and_over_seeds() {
        let counts = |samples: &dyn Fn(u32) -> [f32; 2]| {
            let mut bins = [0_u32; 16];
            for i in 0..1600 {
                let [x, y] = samples(i);
                assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                bins[(x * 4.0) as usize + 4 * (y * 4.0) as usize] += 1;
            }
            bins
        };
        // Low discrepancy over frames: far closer to 100 a bin than random numbers are.
        assert!(counts(&|frame| jitter(7, frame)).iter().all(|count| count.abs_diff(100) <= 6));
        // Random over seeds: χ² with 15 degrees of freedom, 0.1 % point 37.7.
        let over_seeds = counts(&|seed| jitter(u64::from(seed), 11));
        let chi2: f64 = over_seeds.iter().map(|&n| (f64::from(n) - 100.0).powi(2) / 100.0).sum();
        assert!(chi2 < 37.7, "{chi2}");
    }
}
