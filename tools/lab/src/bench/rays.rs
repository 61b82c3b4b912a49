//! Rays as a renderer traces them: through pixels, from surfaces into the cosine lobe, from surfaces to lights.

use crate::stats::rng::SplitMix;
use aquifer_scene::{CpuTracer, Emitters, EnvironmentDistribution, Hit, Light, LightList, Moment, PunctualShape, Scene, Tlas};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use serde::Serialize;
use std::f32::consts::TAU;

/// A ray as the shader's `scene/ray::Ray` lies in memory. Where `t_max` is 0 there is none.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Ray {
    /// Where it begins.
    pub origin: [f32; 3],
    /// Where it ends, in lengths of `direction`.
    pub t_max: f32,
    /// Unit.
    pub direction: [f32; 3],
    padding: u32,
}

impl Ray {
    /// There is something to trace.
    pub fn exists(&self) -> bool {
        self.t_max > 0.0
    }
}

/// What rays are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RayKind {
    /// Through the middle of each pixel; the nearest hit is asked for.
    Camera,
    /// From what the pixel sees, cosine-distributed; the nearest hit is asked for.
    Bounce,
    /// From what the pixel sees to a point on a light drawn by power; any hit is asked for.
    Shadow,
}

impl RayKind {
    /// All.
    pub const ALL: [RayKind; 3] = [RayKind::Camera, RayKind::Bounce, RayKind::Shadow];
}

/// A scene to shoot rays into, with the hierarchy of obvhs.
pub struct Range<'a> {
    scene: &'a Scene,
    moment: &'a Moment,
    tracer: &'a CpuTracer,
    lights: LightList,
    environment: Option<EnvironmentDistribution>,
    size: [u32; 2],
}

/// A point on a surface, seen from outside.
struct Seen {
    position: Vec3,
    /// On the viewer's side.
    normal: Vec3,
}

impl<'a> Range<'a> {
    /// For a film of `size` pixels.
    pub fn new(scene: &'a Scene, moment: &'a Moment, tlas: &Tlas, tracer: &'a CpuTracer, size: [u32; 2]) -> Self {
        let environment = scene.environment.as_ref().map(EnvironmentDistribution::new);
        let lights = LightList::build(scene, &Emitters::find(scene), environment.as_ref(), moment, tlas);
        Range { scene, moment, tracer, lights, environment, size }
    }

    /// One ray a pixel, row by row. Deterministic.
    pub fn rays(&self, kind: RayKind) -> Vec<Ray> {
        let [width, height] = self.size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let mut rng = SplitMix::new(kind as u64);
        pixels.map(|pixel| self.ray(kind, pixel, &mut rng).unwrap_or_default()).collect()
    }

    fn ray(&self, kind: RayKind, [x, y]: [u32; 2], rng: &mut SplitMix) -> Option<Ray> {
        let origin = self.moment.camera.position();
        let direction = self.moment.camera.ray([x as f32 + 0.5, y as f32 + 0.5], self.size);
        if kind == RayKind::Camera {
            return Some(ray(origin, direction, f32::MAX));
        }
        let hit = self.tracer.closest(origin, direction, [0.0, f32::MAX])?;
        let seen = self.seen(&hit, origin, direction);
        if kind == RayKind::Bounce {
            // A cosine lobe is a sphere that touches the surface.
            let direction = (seen.normal + sphere(rng)).try_normalize().unwrap_or(seen.normal);
            return Some(ray(seen.leave(direction), direction, f32::MAX));
        }
        self.to_light(&seen, rng)
    }

    fn seen(&self, hit: &Hit, origin: Vec3, direction: Vec3) -> Seen {
        let instance = &self.moment.instances[hit.instance as usize];
        let normal = self.scene.meshes[instance.mesh as usize].geometric_normal(hit.triangle as usize);
        let normal = Vec3::from(instance.transform.matrix3.inverse().transpose() * glam::Vec3A::from(normal)).normalize();
        Seen { position: origin + direction * hit.t, normal: if normal.dot(direction) > 0.0 { -normal } else { normal } }
    }

    fn to_light(&self, seen: &Seen, rng: &mut SplitMix) -> Option<Ray> {
        let mut uniform = || rng.uniform() as f32;
        let light = self.lights.table.sample(uniform(), uniform())?;
        let target = match self.lights.lights[light as usize] {
            Light::Triangle(light) => {
                let instance = &self.moment.instances[light.instance as usize];
                let corners = self.scene.meshes[instance.mesh as usize].corners(light.triangle as usize);
                let [a, b, c] = corners.map(|corner| instance.transform.transform_point3(corner));
                let root = uniform().sqrt();
                a + (b - a) * (1.0 - root) + (c - a) * (root * uniform())
            }
            Light::Punctual(index) => {
                let placed = &self.moment.lights[index as usize];
                if self.scene.lights[placed.light as usize].shape == PunctualShape::Directional {
                    return Some(ray(seen.leave(-placed.direction), -placed.direction, f32::MAX));
                }
                placed.position
            }
            Light::Environment => {
                let u = [uniform(), uniform(), uniform(), uniform()];
                let direction = self.environment.as_ref()?.sample(u)?;
                return Some(ray(seen.leave(direction), direction, f32::MAX));
            }
        };
        let origin = seen.leave(target - seen.position);
        let way = target - origin;
        // It ends before the light itself.
        Some(ray(origin, way.try_normalize()?, way.length() * (1.0 - STEP)))
    }
}

/// How far rays keep from surfaces, as a share of the largest coordinate: above what rounding makes of any position here.
const STEP: f32 = 1e-4;

impl Seen {
    fn leave(&self, direction: Vec3) -> Vec3 {
        let side = if self.normal.dot(direction) < 0.0 { -1.0 } else { 1.0 };
        self.position + self.normal * (side * STEP * self.position.abs().max_element())
    }
}

fn ray(origin: Vec3, direction: Vec3, t_max: f32) -> Ray {
    Ray { origin: origin.into(), t_max, direction: direction.into(), padding: 0 }
}

fn sphere(rng: &mut SplitMix) -> Vec3 {
    let z = 1.0 - 2.0 * rng.uniform() as f32;
    let (radius, angle) = ((1.0 - z * z).max(0.0).sqrt(), TAU * rng.uniform() as f32);
    Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
}
