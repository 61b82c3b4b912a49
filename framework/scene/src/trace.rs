//! Tracing rays on the CPU by obvhs's traversal: the yardstick for shaders.

use crate::{Mesh, Moment, Scene, Tlas};
use glam::{Affine3A, Vec3, Vec3A};
use obvhs::{
    bvh2::Bvh2,
    ray::{Ray, RayHit},
    triangle::Triangle,
};

/// A moment in the terms of obvhs. It knows geometry only: alpha is not looked at, both sides of a triangle are hit.
pub struct CpuTracer {
    tlas: Bvh2,
    instances: Vec<Placed>,
    meshes: Vec<Traced>,
}

struct Placed {
    mesh: usize,
    to_object: Affine3A,
}

struct Traced {
    bvh: Bvh2,
    triangles: Vec<Triangle>,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction.
    pub t: f32,
    /// Index into [`Moment::instances`].
    pub instance: u32,
    /// Index into [`Mesh::triangles`].
    pub triangle: u32,
    /// Barycentric weights of the second and third corner.
    pub barycentrics: [f32; 2],
}

impl CpuTracer {
    /// Copies what it needs.
    pub fn new(scene: &Scene, moment: &Moment, tlas: &Tlas) -> Self {
        let place = |instance: &crate::Instance| Placed { mesh: instance.mesh as usize, to_object: instance.transform.inverse() };
        Self {
            tlas: tlas.bvh.to_obvhs(),
            instances: moment.instances.iter().map(place).collect(),
            meshes: scene.meshes.iter().map(Traced::new).collect(),
        }
    }

    /// The nearest hit with `range[0] ≤ t < range[1]`. The direction need not be unit, but must not be zero.
    pub fn closest(&self, origin: Vec3, direction: Vec3, range: [f32; 2]) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        let ray = Ray::new(origin.into(), direction.into(), range[0], range[1]);
        self.tlas.ray_traverse(ray, &mut RayHit::none(), |ray, instance| {
            let found = self.closest_in(instance, ray).filter(|hit| hit.t < ray.tmax);
            nearest = found.or(nearest);
            found.map_or(f32::INFINITY, |hit| hit.t)
        });
        nearest
    }

    /// Anything is hit with `range[0] ≤ t < range[1]`.
    pub fn occluded(&self, origin: Vec3, direction: Vec3, range: [f32; 2]) -> bool {
        let ray = Ray::new(origin.into(), direction.into(), range[0], range[1]);
        !self.tlas.ray_traverse_miss(ray, |ray, instance| {
            let placed = &self.instances[instance];
            let mesh = &self.meshes[placed.mesh];
            let (local, _) = to_object(ray, &placed.to_object);
            let missed = mesh.bvh.ray_traverse_miss(local, |ray, triangle| mesh.triangles[triangle].intersect(ray));
            // The traversal above asks for a distance inside the ray's range; which one does not matter.
            if missed { f32::INFINITY } else { ray.tmin }
        })
    }

    fn closest_in(&self, instance: usize, ray: &Ray) -> Option<Hit> {
        let placed = &self.instances[instance];
        let mesh = &self.meshes[placed.mesh];
        let (local, length) = to_object(ray, &placed.to_object);
        let mut hit = RayHit::none();
        mesh.bvh.ray_traverse(local, &mut hit, |ray, triangle| mesh.triangles[triangle].intersect(ray));
        let triangle = mesh.triangles.get(hit.primitive_id as usize)?;
        Some(Hit { t: hit.t / length, instance: instance as u32, triangle: hit.primitive_id, barycentrics: barycentrics(triangle, &local) })
    }
}

impl Traced {
    fn new(mesh: &Mesh) -> Self {
        let triangle = |index| {
            let [v0, v1, v2] = mesh.corners(index).map(Vec3A::from);
            Triangle { v0, v1, v2 }
        };
        Self { bvh: mesh.bvh.to_obvhs(), triangles: (0..mesh.triangles.len()).map(triangle).collect() }
    }
}

/// The ray in object space with a unit direction, since obvhs rounds short components of directions to zero; and the length that the
/// direction had there, by which distances have grown.
fn to_object(ray: &Ray, to_object: &Affine3A) -> (Ray, f32) {
    let direction = to_object.transform_vector3a(ray.direction);
    let length = direction.length();
    let origin = to_object.transform_point3a(ray.origin);
    (Ray::new(origin, direction / length, ray.tmin * length, ray.tmax * length), length)
}

/// Weights of v1 and v2, by the intersection test of obvhs (Möller and Trumbore 1997).
fn barycentrics(triangle: &Triangle, ray: &Ray) -> [f32; 2] {
    let (e1, e2) = (triangle.v0 - triangle.v1, triangle.v2 - triangle.v0);
    let r = ray.direction.cross(triangle.v0 - ray.origin);
    let inverse = 1.0 / e1.cross(e2).dot(ray.direction);
    [r.dot(e2) * inverse, r.dot(e1) * inverse]
}
