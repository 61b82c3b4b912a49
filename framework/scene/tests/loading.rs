//! What a glTF file says is what the scene holds.

mod common;

use aquifer_scene::{Alpha, Features, LoadError, Moment, PunctualShape, Scene, Wrap};
use common::{F32, File, U32, png, rich};
use glam::{Mat3, Vec3, vec2, vec3, vec4};
use serde_json::json;
use std::collections::BTreeSet;

fn load(file: &File) -> Scene {
    Scene::from_gltf(&file.glb(), "test", None).expect("the file is sound")
}

fn error(file: &File) -> String {
    Scene::from_gltf(&file.glb(), "test", None).expect_err("the file is broken").to_string()
}

/// World-space corners of every triangle, rounded, in no particular order.
fn world_triangles(scene: &Scene, moment: &Moment) -> BTreeSet<Vec<i32>> {
    let placed = moment.instances.iter().flat_map(|instance| {
        let mesh = &scene.meshes[instance.mesh as usize];
        (0..mesh.triangles.len()).map(move |triangle| mesh.corners(triangle).map(|corner| instance.transform.transform_point3(corner)))
    });
    placed.map(|corners| corners.iter().flat_map(|corner| (*corner * 1000.0).round().as_ivec3().to_array()).collect()).collect()
}

#[test]
fn geometry_and_hierarchy() {
    let scene = load(&rich());
    assert_eq!(scene.meshes.len(), 2);
    let [quads, fan] = [&scene.meshes[0], &scene.meshes[1]];
    assert_eq!((quads.triangles.len(), fan.triangles.len()), (4, 2));
    assert_eq!(quads.materials.iter().filter(|&&material| material == 0).count(), 2);
    assert_eq!(fan.materials, [2, 2], "the default material stands behind the file's own");
    assert!(fan.positions.contains(&vec3(0.0, 2.0, 0.0)), "sparse accessors replace elements");
    assert!(quads.colors.iter().any(|color| color.abs_diff_eq(vec4(1.0, 128.0 / 255.0, 0.0, 1.0), 1e-6)));
    assert!(quads.colors.contains(&glam::Vec4::ONE), "a primitive without colours is white");
    assert_eq!(quads.tangents.len(), quads.positions.len());
    let moment = scene.at(0.0, None).expect("there is a camera");
    let triangles = world_triangles(&scene, &moment);
    assert!(triangles.contains(&vec![1000, 2000, 3000, 3000, 2000, 3000, 3000, 4000, 3000]), "{triangles:?}");
    assert!(triangles.contains(&vec![3000, 6000, 3000, 1000, 8000, 3000, 1000, 4000, 3000]), "{triangles:?}");
}

#[test]
fn materials_and_textures() {
    let scene = load(&rich());
    let material = &scene.materials[0];
    assert_eq!(material.name, "everything");
    assert_eq!(material.base_color, vec4(0.5, 0.25, 1.0, 0.75));
    assert_eq!((material.metallic, material.roughness, material.ior, material.specular), (0.5, 0.25, 1.25, 0.5));
    assert_eq!(material.specular_color, vec3(0.5, 1.0, 1.0));
    assert_eq!(material.emission, vec3(4.0, 2.0, 0.0), "factor times strength");
    assert_eq!(material.alpha, Alpha::Mask { cutoff: 0.25 });
    assert!(material.double_sided && !material.unlit);
    let base = material.base_color_texture.as_ref().expect("given");
    assert_eq!((base.wrap, base.linear), ([Wrap::Clamp, Wrap::Mirror], false));
    assert!(base.transform.transform_point2(vec2(0.25, 0.25)).abs_diff_eq(vec2(1.0, 0.5), 1e-6));
    let rough = material.metallic_roughness_texture.as_ref().expect("given");
    assert_eq!((rough.wrap, rough.linear, rough.transform), ([Wrap::Repeat; 2], true, Mat3::IDENTITY));
    let normal = material.normal_texture.as_ref().expect("given");
    assert!(normal.transform.transform_point2(vec2(1.0, 0.0)).abs_diff_eq(vec2(1.0_f32.cos(), -1.0_f32.sin()), 1e-6));
    assert_eq!(material.normal_scale, 0.5);
    assert_eq!(scene.images.len(), 2, "one read as sRGB, one as linear");
    assert!(scene.images[base.image as usize].srgb && !scene.images[rough.image as usize].srgb);
    let image = &scene.images[base.image as usize];
    assert_eq!((image.width, image.height, image.rgba[8 + 3]), (8, 4, [48, 16, 200, 255]));
    assert!(scene.materials[1].unlit && scene.materials[1].alpha == Alpha::Blend);
}

#[test]
fn cameras_lights_and_features() {
    let scene = load(&rich());
    let moment = scene.at(0.0, Some("main")).expect("named");
    assert_eq!(moment.camera.position(), vec3(0.0, 0.0, 8.0));
    assert_eq!((moment.camera.vertical_fov, scene.cameras[0].aspect), (0.8, Some(1.5)));
    assert_eq!(moment.lights.len(), 3);
    let by_light = |light: u32| moment.lights.iter().find(|placed| placed.light == light).expect("placed");
    let [sun, point, spot] = [&scene.lights[0], &scene.lights[1], &scene.lights[2]];
    assert_eq!((sun.shape, sun.intensity), (PunctualShape::Directional, vec3(3.0, 1.5, 0.75)));
    assert!(by_light(0).direction.abs_diff_eq(Vec3::NEG_Y, 1e-6), "−Z turned by −90° about X points down");
    assert_eq!((point.shape, point.intensity, point.range), (PunctualShape::Point, Vec3::splat(5.0), Some(10.0)));
    assert_eq!(by_light(1).position, vec3(1.0, 4.0, 3.0), "scaled by the parent; intensity is not");
    assert_eq!((spot.shape, spot.intensity), (PunctualShape::Spot { inner: 0.2, outer: 0.6 }, Vec3::ONE));
    assert_eq!((by_light(2).position, by_light(2).direction), (vec3(4.0, 5.0, 6.0), Vec3::NEG_Z));
    let names = Features::of(&scene).names();
    let expected = [
        "alpha",
        "double_sided",
        "emissive_meshes",
        "glossy",
        "metals",
        "moving_lights",
        "moving_objects",
        "normal_maps",
        "punctual_lights",
        "textures",
        "unlit",
        "vertex_colors",
    ];
    assert_eq!(names, BTreeSet::from(expected));
}

#[test]
fn animation_moves_nodes() {
    let scene = load(&rich());
    let place = |time: f32| {
        let moment = scene.at(time, None).expect("a time");
        moment.instances.iter().find(|instance| scene.nodes[instance.node as usize].name == "moving").expect("placed").transform
    };
    assert!(place(-1.0).translation.abs_diff_eq(glam::vec3a(1.0, 2.0, 3.0), 1e-6));
    assert!(place(1.0).translation.abs_diff_eq(glam::vec3a(5.0, 2.0, 3.0), 1e-6), "half way, times the parent's scale");
    assert!(place(1.9).transform_vector3(Vec3::X).abs_diff_eq(vec3(2.0, 0.0, 0.0), 1e-6), "steps hold");
    assert!(place(2.0).transform_vector3(Vec3::X).abs_diff_eq(vec3(0.0, 0.0, -2.0), 1e-5), "a quarter turn about Y");
}

#[test]
fn loading_twice_gives_the_same() {
    let [a, b] = [load(&rich()), load(&rich())];
    assert_eq!(a.meshes[0].triangles, b.meshes[0].triangles);
    assert_eq!(a.meshes[0].bvh, b.meshes[0].bvh);
    assert_eq!(a.warnings, b.warnings);
}

#[test]
fn external_files_and_data_uris() {
    let folder = tempfile::tempdir().expect("a place for files");
    let mut file = rich();
    let bin = std::mem::take(&mut file.bin);
    file.json["buffers"][0]["uri"] = json!("data/all%20of%20it.bin");
    file.push("images", json!({ "uri": "data/map.png" }));
    file.json["textures"][1]["source"] = json!(1);
    std::fs::create_dir(folder.path().join("data")).expect("new");
    std::fs::write(folder.path().join("data/all of it.bin"), &bin).expect("writable");
    std::fs::write(folder.path().join("data/map.png"), png(4, 4)).expect("writable");
    let path = folder.path().join("room.gltf");
    std::fs::write(&path, file.json.to_string()).expect("writable");
    let scene = Scene::load(&path).expect("sound");
    assert_eq!((scene.name.as_str(), scene.meshes[0].triangles.len()), ("room", 4));
    assert_eq!(scene.images.iter().filter(|image| image.width == 4).count(), 1);

    file.json["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{}", base64::encode(&bin)));
    file.json["textures"][1]["source"] = json!(0);
    let scene = Scene::from_gltf(file.json.to_string().as_bytes(), "text", None).expect("needs no folder");
    assert_eq!(scene.meshes[0].triangles.len(), 4);
}

#[test]
fn files_outside_the_folder_are_refused() {
    let outer = tempfile::tempdir().expect("a place for files");
    let folder = outer.path().join("scene");
    std::fs::create_dir(&folder).expect("new");
    let mut file = rich();
    std::fs::write(outer.path().join("outside.bin"), &file.bin).expect("writable");
    let outside = outer.path().join("outside.bin").display().to_string();
    for uri in ["../outside.bin", "%2E%2E/outside.bin", outside.as_str(), &format!("file://{outside}")] {
        file.json["buffers"][0]["uri"] = json!(uri);
        let path = folder.join("scene.gltf");
        std::fs::write(&path, file.json.to_string()).expect("writable");
        let found = Scene::load(&path);
        assert!(matches!(&found, Err(LoadError::Location { pointer, .. }) if pointer == "/buffers/0/uri"), "{uri}: {found:?}");
    }
}

#[test]
fn what_is_left_out_is_named() {
    let mut file = rich();
    let joint = file.push("nodes", json!({}));
    file.push("skins", json!({ "joints": [joint] }));
    file.json["nodes"][0]["skin"] = json!(0);
    file.json["meshes"][1]["primitives"][0]["targets"] = json!([{ "POSITION": 0 }]);
    let positions = file.json["meshes"][0]["primitives"][1]["attributes"]["POSITION"].clone();
    file.json["meshes"][0]["primitives"]
        .as_array_mut()
        .expect("a list")
        .push(json!({ "attributes": { "POSITION": positions }, "mode": 1 }));
    file.push("cameras", json!({ "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "zfar": 9, "znear": 1 } }));
    file.root(json!({ "camera": 1 }));
    file.json["extensionsUsed"] = json!(["KHR_materials_clearcoat"]);
    let expected = [
        "extension `KHR_materials_clearcoat` is not supported: shown without it",
        "mesh `quads`: 1 primitives of points or lines left out",
        "mesh 1: morph targets are not applied, its rest pose is shown",
        "node `moving`: its skin is not applied, the rest pose is shown",
        "camera 1: orthographic cameras are not supported, left out",
    ];
    assert_eq!(load(&file).warnings, expected);
}

#[test]
fn cameras_that_share_a_name_stay_apart() {
    let mut file = rich();
    file.root(json!({ "name": "second", "camera": 0, "translation": [1.0, 0.0, 0.0] }));
    let scene = load(&file);
    assert_eq!(scene.camera_names(), ["main", "main.2"]);
    assert_eq!(scene.at(0.0, Some("main.2")).expect("named").camera.position(), Vec3::X);
}

#[test]
fn faults_name_their_json_pointer() {
    let broken = |change: &dyn Fn(&mut File)| {
        let mut file = rich();
        change(&mut file);
        error(&file)
    };
    type Edit<'a> = &'a dyn Fn(&mut File);
    let cases: &[(Edit<'_>, &str)] = &[
        (&|f| f.json["bufferViews"][0]["byteLength"] = json!(9_999_999), "/bufferViews/0: reaches byte 9999999 of "),
        (&|f| f.json["accessors"][0]["count"] = json!(5), "/accessors/0: reaches byte 60 of 48"),
        (&|f| f.json["accessors"][1]["count"] = json!(3), "/meshes/0/primitives/0/attributes/NORMAL: 3 elements for 4 vertices"),
        (&|f| f.json["accessors"][0]["type"] = json!("VEC2"), "/accessors/0: holds Vec2 of F32 where Vec3 of floats"),
        (&|f| f.json["accessors"][3]["normalized"] = json!(false), "/accessors/3: holds Vec4 of U8 where Vec4 of floats or normalized"),
        (&|f| f.json["bufferViews"][0]["byteStride"] = json!(8), "/accessors/0: a stride of 8 bytes does not fit elements of 12"),
        (&|f| f.json["accessors"][4]["componentType"] = json!(U32), "/accessors/4: reaches byte 24 of 12"),
        (&|f| f.json["nodes"][0]["children"] = json!([2]), "/nodes/2: a node may be reached in one way only"),
        (&|f| f.json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]), "/nodes/0/rotation: has no length"),
        (&|f| f.json["cameras"][0]["perspective"]["yfov"] = json!(4.0), "/cameras/0/perspective/yfov: must lie between 0 and π"),
        (&|f| f.json["buffers"][0]["byteLength"] = json!(9_999_999), "/buffers/0/byteLength: reaches byte 9999999 of "),
        (&|f| f.json["images"][0] = json!({}), "/images/0: has neither a URI nor a buffer view"),
        (&|f| f.json["images"][0]["bufferView"] = json!(0), "/images/0: neither PNG nor JPEG"),
        (&|f| f.json["animations"][0]["channels"][0]["target"]["node"] = json!(99), "/animations/0/channels/0/target/node: index 99"),
        (&|f| f.json["extensionsRequired"] = json!(["EXT_meshopt_compression"]), "/extensionsRequired: `EXT_meshopt_compression`"),
        (&|f| f.json["materials"][0]["normalTexture"]["index"] = json!(7), "/materials/0/normalTexture/index: Index out of bounds"),
    ];
    for (change, expected) in cases {
        let found = broken(*change);
        assert!(found.starts_with(expected), "{found}\ninstead of\n{expected}");
    }
}

#[test]
fn numbers_that_are_none_are_found_in_every_accessor() {
    let file = rich();
    let mut checked = 0;
    for (index, accessor) in file.json["accessors"].as_array().expect("a list").iter().enumerate() {
        if accessor["componentType"] != json!(F32) {
            continue;
        }
        let view = accessor["bufferView"].as_u64().expect("given") as usize;
        let offset = file.json["bufferViews"][view]["byteOffset"].as_u64().expect("given") as usize;
        for value in [f32::NAN, f32::INFINITY] {
            let mut broken = file.clone();
            broken.bin[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
            assert_eq!(error(&broken), format!("/accessors/{index}: element 0: not a finite 32-bit number"));
            checked += 1;
        }
    }
    assert!(checked >= 14);
}
