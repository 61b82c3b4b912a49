//! What is written can be read: by the gltf crate as a judge of the format.

use aquifer_scene::{Alpha, Image, Material, Node, Scene};
use aquifer_scenes::build::{Place, Shape, Stage, matte, paint, tiled};
use aquifer_scenes::{ExportError, all, by_name, export};
use glam::{Mat3, Vec2, Vec3, Vec4};
use gltf::Gltf;

fn make(name: &str) -> Scene {
    (by_name(name).expect("the scene is in the list").make)()
}

fn written(scene: &Scene) -> Gltf {
    let files = export(scene).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    Gltf::from_slice(&files.glb).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

#[test]
fn every_scene_is_valid_and_keeps_its_counts() {
    for generator in all() {
        let scene = (generator.make)();
        let file = written(&scene);
        let triangles: usize =
            file.meshes().flat_map(|mesh| mesh.primitives()).map(|part| part.indices().expect("indexed").count() / 3).sum();
        assert_eq!(triangles, scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>(), "{}", scene.name);
        assert_eq!(file.materials().count(), scene.materials.len(), "{}", scene.name);
        assert_eq!(file.images().count(), scene.images.len(), "{}", scene.name);
        assert_eq!(file.nodes().count(), scene.nodes.len(), "{}", scene.name);
        assert_eq!(file.cameras().count(), scene.cameras.len(), "{}", scene.name);
        assert_eq!(file.lights().map_or(0, |lights| lights.count()), scene.lights.len(), "{}", scene.name);
        assert_eq!(file.animations().map(|a| a.channels().count()).sum::<usize>(), scene.animation.len(), "{}", scene.name);
        assert_eq!(file.extensions_required().count(), 0, "{}", scene.name);
    }
}

#[test]
fn emission_beyond_one_becomes_a_factor_and_a_strength() {
    let file = written(&make("cornell"));
    let lamp = file.materials().find(|material| material.name() == Some("lamp")).expect("the lamp is written");
    let strength = lamp.emissive_strength().expect("the lamp is brighter than 1");
    assert_eq!(strength, 20.0);
    let radiance = lamp.emissive_factor().map(|channel| channel * strength);
    for (found, expected) in radiance.into_iter().zip([20.0, 16.4, 11.6]) {
        assert!((found - expected).abs() < 1e-5, "{found} against {expected}");
    }
}

#[test]
fn only_extensions_in_use_are_named() {
    let named = |scene: &Scene| written(scene).extensions_used().map(String::from).collect::<Vec<_>>();
    assert_eq!(named(&make("cornell")), ["KHR_materials_emissive_strength", "KHR_materials_specular"]);
    let textured = named(&make("textured"));
    for extension in ["KHR_lights_punctual", "KHR_materials_unlit", "KHR_texture_transform"] {
        assert!(textured.iter().any(|name| name == extension), "{extension} is missing from {textured:?}");
    }
}

#[test]
fn images_come_back_texel_by_texel() {
    let scene = make("textured");
    let file = written(&scene);
    let blob = file.blob.as_deref().expect("a binary chunk");
    for (image, source) in scene.images.iter().zip(file.images()) {
        let gltf::image::Source::View { view, mime_type } = source.source() else { panic!("images are embedded") };
        assert_eq!(mime_type, "image/png");
        let decoded = image::load_from_memory(&blob[view.offset()..view.offset() + view.length()]).expect("a PNG").into_rgba8();
        assert_eq!(decoded.dimensions(), (image.width, image.height));
        assert_eq!(decoded.as_raw().as_slice(), image.rgba.as_flattened());
    }
}

#[test]
fn the_environment_comes_beside_the_file() {
    assert!(export(&make("cornell")).expect("the scene is sound").environment.is_none());
    let bytes = export(&make("outdoor")).expect("the scene is sound").environment.expect("there is a sky");
    assert_eq!(&bytes[..4], &[0x76, 0x2f, 0x31, 0x01], "OpenEXR's magic number");
}

fn square() -> (Stage, Material) {
    let mut stage = Stage::new("square");
    let mut shape = Shape::new("square");
    shape.quad(0, Vec3::ZERO, Vec3::X, Vec3::Y);
    stage.add(shape);
    (stage, matte("paper", [0.5; 3]))
}

/// What is said when one thing is wrong with a scene of one square.
fn refusal(spoil: impl FnOnce(&mut Scene)) -> ExportError {
    let (mut stage, material) = square();
    stage.material(material);
    let mut scene = stage.into_scene();
    assert!(export(&scene).is_ok());
    spoil(&mut scene);
    export(&scene).expect_err("the scene was spoilt")
}

#[test]
fn faults_are_named() {
    let nan = refusal(|scene| scene.meshes[0].positions[1].x = f32::NAN);
    assert_eq!(nan.to_string(), "a position of mesh 'square' holds a number that is not finite");
    let corner = refusal(|scene| scene.meshes[0].triangles[0][2] = 9);
    assert_eq!(corner.to_string(), "a triangle of mesh 'square' refers to number 9, but there are only 4");
    let bright = refusal(|scene| scene.materials[0].base_color.x = 1.5);
    assert!(matches!(bright, ExportError::OutOfRange { value: 1.5, .. }), "{bright}");
    let short = refusal(|scene| scene.meshes[0].normals.truncate(3));
    assert!(matches!(short, ExportError::Length { found: 3, expected: 4, .. }), "{short}");
    let astray = refusal(|scene| scene.nodes[0].mesh = Some(3));
    assert!(matches!(astray, ExportError::DanglingIndex { index: 3, count: 1, .. }), "{astray}");
    let orphan = refusal(|scene| scene.nodes[0].parent = Some(0));
    assert!(matches!(orphan, ExportError::DanglingIndex { .. }), "{orphan}");
    let torn = refusal(|scene| {
        scene.images.push(Image { name: "torn".into(), width: 2, height: 2, rgba: vec![[0; 4]; 3], srgb: true });
    });
    assert_eq!(torn.to_string(), "image 'torn' has 3 entries where 4 are needed");
    let sheared = refusal(|scene| {
        scene.images.push(paint("grey", [1, 1], |_| Vec4::splat(0.5)));
        let mut texture = tiled(0);
        texture.transform = Mat3::from_cols(Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Z);
        scene.materials[0].base_color_texture = Some(texture);
    });
    assert!(matches!(sheared, ExportError::ShearedTexture { .. }), "{sheared}");
}

#[test]
fn an_empty_mesh_is_left_out_and_the_others_keep_their_nodes() {
    let (mut stage, material) = square();
    stage.material(material);
    let mut scene = stage.into_scene();
    scene.meshes.insert(0, aquifer_scene::Mesh { name: "nothing".into(), ..Default::default() });
    scene.nodes[0].mesh = Some(1);
    scene.nodes.push(Node { mesh: Some(0), ..scene.nodes[0].clone() });
    let file = written(&scene);
    let meshes: Vec<Option<String>> = file.nodes().map(|node| node.mesh().map(|mesh| mesh.name().unwrap_or_default().into())).collect();
    assert_eq!(meshes, [Some("square".into()), None]);
}

#[test]
fn one_primitive_a_material_with_no_vertex_to_spare() {
    let mut stage = Stage::new("two");
    let red = stage.material(matte("red", [0.5, 0.0, 0.0]));
    let blue = stage.material(Material { alpha: Alpha::Mask { cutoff: 0.25 }, double_sided: true, ..matte("blue", [0.0, 0.0, 0.5]) });
    let mut shape = Shape::new("both");
    shape.quad(blue, Vec3::ZERO, Vec3::X, Vec3::Y);
    shape.disk(red, Vec3::Z, Vec3::Z, 1.0, 7);
    stage.add(shape);
    let file = written(&stage.into_scene());
    let mesh = file.meshes().next().expect("one mesh");
    let parts: Vec<(Option<usize>, usize)> =
        mesh.primitives().map(|part| (part.material().index(), part.get(&gltf::Semantic::Positions).expect("positions").count())).collect();
    assert_eq!(parts, [(Some(0), 8), (Some(1), 4)]);
    let blue = file.materials().nth(1).expect("two materials");
    assert_eq!((blue.alpha_mode(), blue.alpha_cutoff(), blue.double_sided()), (gltf::material::AlphaMode::Mask, Some(0.25), true));
}

#[test]
fn hierarchy_and_vertex_data_survive() {
    let (mut stage, material) = square();
    stage.material(material);
    let pivot = stage.pivot("pivot", Place::at(1.0, 2.0, 3.0).turned(90.0).sized(2.0));
    let mut leaf = Shape::new("leaf");
    leaf.tiled_quad(0, Vec3::ZERO, Vec3::X, Vec3::Y, Vec2::new(3.0, 2.0));
    let leaf = stage.add(leaf);
    stage.hang(leaf, pivot);
    let mut scene = stage.into_scene();
    let vertices = scene.meshes[1].positions.len();
    scene.meshes[1].tangents = vec![Vec4::new(1.0, 0.0, 0.0, -1.0); vertices];
    scene.meshes[1].colors = vec![Vec4::new(0.25, 0.5, 0.75, 1.0); vertices];
    scene.meshes[1].uvs[1] = scene.meshes[1].uvs[0].iter().map(|uv| *uv * 0.5).collect();
    let file = written(&scene);
    let root = file.nodes().nth(1).expect("the pivot");
    assert_eq!(root.children().map(|child| child.index()).collect::<Vec<_>>(), [2]);
    let (translation, _, scale) = root.transform().decomposed();
    assert_eq!((translation, scale), ([1.0, 2.0, 3.0], [2.0; 3]));

    let blob = file.blob.as_deref();
    let part = file.meshes().nth(1).and_then(|mesh| mesh.primitives().next()).expect("the leaf");
    let reader = part.reader(|_| blob);
    let mesh = &scene.meshes[1];
    let floats = |values: &[f32]| values.to_vec();
    assert_eq!(reader.read_positions().expect("positions").flatten().collect::<Vec<_>>(), floats(bytemuck::cast_slice(&mesh.positions)));
    assert_eq!(reader.read_normals().expect("normals").flatten().collect::<Vec<_>>(), floats(bytemuck::cast_slice(&mesh.normals)));
    assert_eq!(reader.read_tangents().expect("tangents").collect::<Vec<_>>(), vec![[1.0, 0.0, 0.0, -1.0]; vertices]);
    assert_eq!(reader.read_colors(0).expect("colours").into_rgba_f32().collect::<Vec<_>>(), vec![[0.25, 0.5, 0.75, 1.0]; vertices]);
    for set in 0..2 {
        let found: Vec<f32> = reader.read_tex_coords(set).expect("coordinates").into_f32().flatten().collect();
        assert_eq!(found, floats(bytemuck::cast_slice(&mesh.uvs[set as usize])));
    }
    let corners: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
    assert_eq!(corners, mesh.triangles.as_flattened());
}
