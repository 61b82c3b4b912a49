//! Every scene is what its line in the list says, is sound, and comes out the same each time.

use aquifer_scene::{Interpolation, Scene};
use aquifer_scenes::{all, by_name, export, gallery};
use std::collections::BTreeSet;

fn make(name: &str) -> Scene {
    (by_name(name).expect("the scene is in the list").make)()
}

fn triangle_count(scene: &Scene) -> usize {
    scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
}

#[test]
fn names_are_unique_and_every_scene_is_named_after_its_generator() {
    let names: BTreeSet<&str> = all().iter().map(|generator| generator.name).collect();
    assert_eq!(names.len(), all().len());
    for generator in all() {
        assert_eq!((generator.make)().name, generator.name);
    }
}

#[test]
fn every_scene_finishes_without_a_warning() {
    for generator in all() {
        let scene = (generator.make)();
        assert!(triangle_count(&scene) > 0, "{}", generator.name);
        let before = triangle_count(&scene);
        let scene = scene.finish().unwrap_or_else(|error| panic!("{}: {error}", generator.name));
        assert_eq!(scene.warnings, Vec::<String>::new(), "{}", generator.name);
        assert_eq!(triangle_count(&scene), before, "{}", generator.name);
        assert!(scene.at(0.0, Some("main")).is_ok(), "{}", generator.name);
    }
}

#[test]
fn every_number_is_finite_and_every_normal_unit() {
    for generator in all() {
        let scene = (generator.make)();
        for mesh in &scene.meshes {
            let what = format!("mesh '{}' of {}", mesh.name, generator.name);
            assert!(mesh.positions.iter().all(|p| p.is_finite()), "{what}");
            assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4), "{what}");
            assert!(mesh.uvs.iter().flatten().all(|uv| uv.is_finite()), "{what}");
        }
        if let Some(environment) = &scene.environment {
            assert!(environment.radiance.as_flattened().iter().all(|value| value.is_finite() && *value >= 0.0), "{}", generator.name);
        }
    }
}

#[test]
fn front_faces_and_shading_normals_agree() {
    for generator in all() {
        let scene = (generator.make)();
        for mesh in &scene.meshes {
            let disagree = mesh.triangles.iter().filter(|triangle| {
                let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
                let face = (b - a).cross(c - a);
                let shading = triangle.map(|i| mesh.normals[i as usize]).into_iter().sum::<glam::Vec3>();
                face.dot(shading) <= 0.0
            });
            assert_eq!(disagree.count(), 0, "mesh '{}' of {}", mesh.name, generator.name);
        }
    }
}

#[test]
fn the_same_code_gives_the_same_bytes() {
    for generator in all() {
        let [first, second] = [0, 1].map(|_| export(&(generator.make)()).unwrap_or_else(|error| panic!("{}: {error}", generator.name)));
        assert!(first.glb == second.glb, "{}", generator.name);
        assert!(first.environment == second.environment, "{}", generator.name);
    }
}

#[test]
fn many_lights_has_thousands_of_emissive_triangles_of_widely_differing_power() {
    let scene = make("many_lights").finish().expect("the scene is sound");
    let moment = scene.at(0.0, None).expect("it has a camera");
    let mut powers = Vec::new();
    for instance in &moment.instances {
        let mesh = &scene.meshes[instance.mesh as usize];
        for (triangle, material) in mesh.triangles.iter().zip(&mesh.materials) {
            let emission = scene.materials[*material as usize].emission;
            if emission.max_element() > 0.0 {
                let [a, b, c] = triangle.map(|i| instance.transform.transform_point3(mesh.positions[i as usize]));
                powers.push(emission.max_element() * (b - a).cross(c - a).length());
            }
        }
    }
    assert!(powers.len() >= 4_000, "{}", powers.len());
    powers.sort_by(f32::total_cmp);
    let spread = powers[powers.len() * 99 / 100] / powers[powers.len() / 100];
    assert!(spread > 1e3, "the middle 98 % span a factor of {spread}");
}

#[test]
fn point_lights_has_two_thousand() {
    assert_eq!(make("point_lights").lights.len(), 2_000);
}

#[test]
fn animated_uses_every_interpolation_and_ends_where_it_began() {
    let scene = make("animated").finish().expect("the scene is sound");
    let used: Vec<Interpolation> = scene.animation.iter().map(|channel| channel.interpolation).collect();
    for kind in [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline] {
        assert!(used.contains(&kind), "{kind:?}");
    }
    let [start, middle, end] = [0.0, 1.3, 4.0].map(|time| scene.at(time, None).expect("it has a camera"));
    for (a, b) in start.instances.iter().zip(&end.instances) {
        assert!(a.transform.abs_diff_eq(b.transform, 1e-4));
    }
    assert!(start.camera.to_world.abs_diff_eq(end.camera.to_world, 1e-4));
    assert!(start.lights.iter().zip(&end.lights).all(|(a, b)| a.position.distance(b.position) < 1e-4));
    assert!(start.instances.iter().zip(&middle.instances).any(|(a, b)| a.transform != b.transform));
    assert!(start.camera != middle.camera);
    assert!(start.lights.iter().zip(&middle.lights).any(|(a, b)| a.position != b.position));
}

#[test]
fn plates_stand_at_the_distance_asked_for() {
    let scene = gallery::plates::plates_at(0.4);
    let heights: BTreeSet<u32> = scene.meshes[0].positions.iter().map(|p| p.y.to_bits()).collect();
    assert_eq!(heights, BTreeSet::from([0.0_f32.to_bits(), 0.4_f32.to_bits()]));
}

#[test]
fn the_furnace_takes_the_material_given() {
    let scene = gallery::furnace::furnace_of(aquifer_scenes::build::metal("subject", [0.9, 0.5, 0.2], 0.3));
    assert!(scene.materials.iter().any(|material| material.name == "subject" && material.metallic == 1.0));
}
