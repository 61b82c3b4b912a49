//! What is written and loaded again is the same scene.

use aquifer_scene::{Environment, Material, Mesh, Moment, Scene, TextureRef};
use aquifer_scenes::{Exported, all, by_name, export};
use glam::Vec3;

/// A scene as its author typed it, finished; and the same by way of a file.
fn both(make: fn() -> Scene) -> (Scene, Scene, Exported) {
    let scene = make();
    let files = export(&scene).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    let loaded = Scene::from_gltf(&files.glb, &scene.name, None).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    let scene = scene.finish().unwrap_or_else(|error| panic!("the scene is unsound: {error}"));
    (scene, loaded, files)
}

fn at(scene: &Scene, time: f32) -> Moment {
    scene.at(time, Some("main")).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

/// Corners of every triangle of a mesh with its material, to the bit and in an order of their own: the file sorts them by material, the
/// hierarchy by place.
fn triangles(mesh: &Mesh) -> Vec<([[u32; 3]; 3], u32)> {
    let corner = |i: u32| mesh.positions[i as usize].to_array().map(f32::to_bits);
    let mut found: Vec<_> = mesh.triangles.iter().map(|triangle| triangle.map(corner)).zip(mesh.materials.iter().copied()).collect();
    found.sort_unstable();
    found
}

/// Factor times strength, and colour times intensity, may round once.
fn same_to_rounding(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() <= 2.0 * f32::EPSILON * a.abs().max_element()
}

fn same_texture(a: Option<&TextureRef>, b: Option<&TextureRef>, scenes: [&Scene; 2]) -> bool {
    let (Some(a), Some(b)) = (a, b) else { return a.is_none() && b.is_none() };
    let [first, second] = [(a, scenes[0]), (b, scenes[1])].map(|(texture, scene)| &scene.images[texture.image as usize]);
    let image = first.rgba == second.rgba && first.width == second.width && first.srgb == second.srgb;
    let sampling = (a.uv_set, a.wrap, a.linear) == (b.uv_set, b.wrap, b.linear);
    image && sampling && a.transform.abs_diff_eq(b.transform, 1e-5)
}

fn assert_same_material(a: &Material, b: &Material, scenes: [&Scene; 2]) {
    let what = format!("material '{}' of {}", a.name, scenes[0].name);
    assert_eq!(a.name, b.name, "{what}");
    assert_eq!((a.base_color, a.metallic, a.roughness), (b.base_color, b.metallic, b.roughness), "{what}");
    assert_eq!((a.ior, a.specular, a.specular_color), (b.ior, b.specular, b.specular_color), "{what}");
    assert_eq!((a.alpha, a.double_sided, a.unlit), (b.alpha, b.double_sided, b.unlit), "{what}");
    assert_eq!(a.normal_scale, b.normal_scale, "{what}");
    assert!(same_to_rounding(a.emission, b.emission), "{what}: {} became {}", a.emission, b.emission);
    let uses =
        |m: &Material| [&m.base_color_texture, &m.metallic_roughness_texture, &m.emission_texture, &m.normal_texture].map(Option::clone);
    for (a, b) in uses(a).iter().zip(&uses(b)) {
        assert!(same_texture(a.as_ref(), b.as_ref(), scenes), "{what}: {a:?} became {b:?}");
    }
}

#[test]
fn meshes_come_back_to_the_bit() {
    for generator in all() {
        let (scene, loaded, _) = both(generator.make);
        assert_eq!(loaded.warnings, Vec::<String>::new(), "{}", generator.name);
        assert_eq!(scene.meshes.len(), loaded.meshes.len(), "{}", generator.name);
        for (a, b) in scene.meshes.iter().zip(&loaded.meshes) {
            assert!(triangles(a) == triangles(b), "mesh '{}' of {}", a.name, generator.name);
        }
    }
}

#[test]
fn every_instance_stands_where_it_stood() {
    for generator in all() {
        let (scene, loaded, _) = both(generator.make);
        let (first, second) = (at(&scene, 0.0).instances, at(&loaded, 0.0).instances);
        assert_eq!(first.len(), second.len(), "{}", generator.name);
        for (a, b) in first.iter().zip(&second) {
            assert_eq!((a.mesh, a.node), (b.mesh, b.node), "{}", generator.name);
            // Rotations are made unit once more on the way.
            let tolerance = 4.0 * f32::EPSILON * (1.0 + a.transform.to_cols_array().into_iter().fold(0.0, |m: f32, x| m.max(x.abs())));
            assert!(a.transform.abs_diff_eq(b.transform, tolerance), "node {} of {}", a.node, generator.name);
        }
    }
}

#[test]
fn materials_lights_and_cameras_come_back() {
    for generator in all() {
        let (scene, loaded, _) = both(generator.make);
        assert_eq!(scene.materials.len(), loaded.materials.len(), "{}", generator.name);
        for (a, b) in scene.materials.iter().zip(&loaded.materials) {
            assert_same_material(a, b, [&scene, &loaded]);
        }
        assert_eq!(scene.lights.len(), loaded.lights.len(), "{}", generator.name);
        for (a, b) in scene.lights.iter().zip(&loaded.lights) {
            assert_eq!((&a.name, a.shape, a.range), (&b.name, b.shape, b.range), "{}", generator.name);
            assert!(same_to_rounding(a.intensity, b.intensity), "light '{}' of {}", a.name, generator.name);
        }
        assert_eq!(scene.camera_names(), loaded.camera_names(), "{}", generator.name);
        for name in scene.camera_names() {
            let [a, b] = [&scene, &loaded].map(|scene| scene.at(0.0, Some(&name)).expect("the camera was listed").camera);
            assert_eq!(a, b, "camera '{name}' of {}", generator.name);
        }
    }
}

#[test]
fn the_animated_scene_moves_as_before() {
    let (scene, loaded, _) = both(by_name("animated").expect("it is in the list").make);
    for time in [0.0, 0.7, 1.9, 2.5, 3.99, 7.0] {
        let (a, b) = (at(&scene, time), at(&loaded, time));
        assert_eq!((a.camera, &a.lights), (b.camera, &b.lights), "at {time}");
        let transforms = |moment: &Moment| moment.instances.iter().map(|instance| instance.transform).collect::<Vec<_>>();
        assert_eq!(transforms(&a), transforms(&b), "at {time}");
    }
}

#[test]
fn the_environment_comes_back_by_way_of_openexr() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["outdoor", "million"] {
        let (scene, _, files) = both(by_name(name).expect("it is in the list").make);
        let path = folder.path().join(name).with_extension("exr");
        std::fs::write(&path, files.environment.expect("there is a sky")).expect("the folder is writable");
        let loaded = Environment::load(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        let sky = scene.environment.expect("there is a sky");
        assert_eq!((sky.width, sky.height), (loaded.width, loaded.height), "{name}");
        assert!(sky.radiance == loaded.radiance, "{name}");
    }
}
