//! Everything that next-event estimation can choose, with the power that it is chosen by.

use crate::{
    AliasTable, EnvironmentDistribution, Instance, Material, Mesh, Moment, PunctualLight, PunctualShape, Scene, Tlas,
    emission::{Emitters, luminance},
};
use std::f64::consts::PI;

/// One light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// A triangle with an emissive material.
    Triangle(EmissiveTriangle),
    /// Index into [`Moment::lights`].
    Punctual(u32),
    /// The scene's environment.
    Environment,
}

/// A triangle that gives off light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EmissiveTriangle {
    /// Index into [`Moment::instances`].
    pub instance: u32,
    /// Index into [`Mesh::triangles`].
    pub triangle: u32,
}

/// The lights of a moment. The indices of lights are the same at every moment of a scene: first the triangles, instance by instance,
/// then the punctual lights, then the environment. What gives no light at this moment stays in the list with power 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightList {
    /// All lights.
    pub lights: Vec<Light>,
    /// Estimated luminous power of each, in the unit of radiance · m² · sr.
    pub power: Vec<f64>,
    /// Draws proportionally to `power`.
    pub table: AliasTable,
    /// One an instance: the light index of its first emissive triangle. With [`crate::MeshEmitters::ordinals`] it leads from a hit to
    /// a light.
    pub first_of_instance: Vec<u32>,
}

impl LightList {
    /// Collects the lights of `moment`. `environment` is the distribution of [`Scene::environment`], if there is one.
    pub fn build(
        scene: &Scene,
        emitters: &Emitters,
        environment: Option<&EnvironmentDistribution>,
        moment: &Moment,
        tlas: &Tlas,
    ) -> LightList {
        let mut list = LightList::default();
        for (index, instance) in moment.instances.iter().enumerate() {
            list.first_of_instance.push(list.lights.len() as u32);
            list.add_triangles(index as u32, instance, scene, emitters);
        }
        let disk = PI * scene_radius(tlas).powi(2);
        for (index, placed) in moment.lights.iter().enumerate() {
            list.add(Light::Punctual(index as u32), punctual_power(&scene.lights[placed.light as usize], disk));
        }
        if let Some(distribution) = environment {
            list.add(Light::Environment, distribution.mean_luminance() * 4.0 * PI * disk);
        }
        list.table = AliasTable::new(&list.power);
        list
    }

    /// The light that a hit on this triangle shows, if it is one.
    pub fn of_hit(&self, emitters: &Emitters, instance: u32, mesh: u32, triangle: u32) -> Option<u32> {
        let ordinal = emitters.meshes[mesh as usize].ordinal(triangle)?;
        Some(self.first_of_instance[instance as usize] + ordinal)
    }

    fn add(&mut self, light: Light, power: f64) {
        self.lights.push(light);
        self.power.push(power);
    }

    fn add_triangles(&mut self, index: u32, instance: &Instance, scene: &Scene, emitters: &Emitters) {
        let mesh = &scene.meshes[instance.mesh as usize];
        let found = &emitters.meshes[instance.mesh as usize];
        let is_solid = instance.is_solid();
        for (&triangle, &mean) in found.triangles.iter().zip(&found.luminance) {
            let material = &scene.materials[mesh.materials[triangle as usize] as usize];
            let area = if is_solid { world_area(mesh, triangle, instance) } else { 0.0 };
            self.add(Light::Triangle(EmissiveTriangle { instance: index, triangle }), area * f64::from(mean) * PI * sides(material));
        }
    }
}

fn sides(material: &Material) -> f64 {
    if material.double_sided { 2.0 } else { 1.0 }
}

/// Square metres in the world.
fn world_area(mesh: &Mesh, triangle: u32, instance: &Instance) -> f64 {
    let [a, b, c] = mesh.corners(triangle as usize).map(|corner| instance.transform.transform_point3(corner).as_dvec3());
    (b - a).cross(c - a).length() * 0.5
}

/// Point: 4π·I. Spot: I times the integral of its smooth cone. Directional: irradiance on a disk of the scene's size.
fn punctual_power(light: &PunctualLight, disk: f64) -> f64 {
    let intensity = f64::from(luminance(light.intensity.into()));
    match light.shape {
        PunctualShape::Directional => intensity * disk,
        PunctualShape::Point => intensity * 4.0 * PI,
        PunctualShape::Spot { inner, outer } => {
            // The edge is the square of a ramp that is linear in the cosine: a third of its solid angle.
            let (inner, outer) = (f64::from(inner).cos(), f64::from(outer).cos());
            intensity * 2.0 * PI * ((1.0 - inner) + (inner - outer) / 3.0)
        }
    }
}

/// Metres; 1 when nothing can be hit.
fn scene_radius(tlas: &Tlas) -> f64 {
    tlas.bounds().map_or(1.0, |bounds| f64::from(bounds.diagonal().length()) * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshEmitters, Node};
    use glam::{Vec3, vec3};

    /// A dark and a bright unit right triangle, placed twice: once doubled in size, once squashed flat.
    fn scene() -> Scene {
        let mesh = Mesh {
            positions: vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            materials: vec![0, 1],
            ..Mesh::default()
        };
        let bright = Material { emission: Vec3::splat(3.0), double_sided: true, ..Material::default() };
        let light = PunctualLight { name: String::new(), intensity: Vec3::ONE, shape: PunctualShape::Point, range: None };
        let place = |scale| Node { mesh: Some(0), scale, ..Node::default() };
        Scene {
            meshes: vec![mesh],
            materials: vec![Material::default(), bright],
            nodes: vec![place(Vec3::splat(2.0)), place(vec3(1.0, 0.0, 1.0)), Node { light: Some(0), ..Node::default() }],
            lights: vec![light],
            ..Scene::default()
        }
        .finish()
        .unwrap()
    }

    #[test]
    fn power_is_pi_times_radiance_times_area_times_sides() {
        let scene = scene();
        let (emitters, moment) = (Emitters::find(&scene), scene.at(0.0, None).unwrap());
        let list = LightList::build(&scene, &emitters, None, &moment, &Tlas::build(&scene, &moment));
        assert_eq!(list.lights.len(), 3);
        assert!((list.power[0] - PI * 3.0 * 2.0 * 2.0).abs() < 1e-6 * list.power[0], "{}", list.power[0]);
        assert_eq!(list.power[1], 0.0, "squashed flat");
        assert!((list.power[2] - 4.0 * PI).abs() < 1e-6);
        assert_eq!(list.table.entries[1].pmf, 0.0);
        let expected = list.power[0] / (list.power[0] + list.power[2]);
        assert!((f64::from(list.table.entries[0].pmf) - expected).abs() < 1e-6);
    }

    #[test]
    fn hits_lead_to_lights() {
        let scene = scene();
        let (emitters, moment) = (Emitters::find(&scene), scene.at(0.0, None).unwrap());
        let list = LightList::build(&scene, &emitters, None, &moment, &Tlas::build(&scene, &moment));
        for (index, light) in list.lights.iter().enumerate() {
            if let Light::Triangle(EmissiveTriangle { instance, triangle }) = *light {
                assert_eq!(list.of_hit(&emitters, instance, 0, triangle), Some(index as u32));
            }
        }
        let dark = scene.meshes[0].materials.iter().position(|&material| material == 0).unwrap();
        assert_eq!(list.of_hit(&emitters, 0, 0, dark as u32), None);
        assert_eq!(emitters.meshes[0].ordinals[dark], MeshEmitters::DARK);
    }

    #[test]
    fn a_spot_of_the_whole_half_space_is_half_a_point() {
        let light = |shape| PunctualLight { name: String::new(), intensity: Vec3::ONE, shape, range: None };
        let outer = std::f32::consts::FRAC_PI_2;
        let spot = punctual_power(&light(PunctualShape::Spot { inner: outer - 1e-6, outer }), 1.0);
        assert!((spot / punctual_power(&light(PunctualShape::Point), 1.0) - 0.5).abs() < 1e-5);
        // Numerical integral of the extension's falloff for a soft cone.
        let (inner, outer) = (0.3_f32, 1.1_f32);
        let (ci, co) = (f64::from(inner).cos(), f64::from(outer).cos());
        let steps = 100_000;
        let falloff = |cos: f64| ((cos - co) / (ci - co)).clamp(0.0, 1.0).powi(2);
        let integral: f64 = (0..steps).map(|i| falloff((i as f64 + 0.5) / f64::from(steps)) / f64::from(steps)).sum();
        let found = punctual_power(&light(PunctualShape::Spot { inner, outer }), 1.0);
        assert!((found - 2.0 * PI * integral).abs() < 1e-6, "{found}");
    }
}
