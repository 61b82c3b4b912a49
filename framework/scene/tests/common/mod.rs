//! glTF files built in memory.

#![allow(dead_code, reason = "every test file uses its own part of this")]

use aquifer_scene::{CpuTracer, Emitters, EnvironmentDistribution, Features, LightList, Scene, Tlas};
use bytemuck::Pod;
use glam::Vec3;
use serde_json::{Value, json};

pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const F32: u32 = 5126;

/// A glTF document with one binary chunk.
#[derive(Clone)]
pub struct File {
    pub json: Value,
    pub bin: Vec<u8>,
}

impl File {
    pub fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "buffers": [{ "byteLength": 0 }],
            "bufferViews": [], "accessors": [], "meshes": [], "nodes": [],
            "scene": 0, "scenes": [{ "nodes": [] }]
        });
        Self { json, bin: Vec::new() }
    }

    pub fn push(&mut self, list: &str, item: Value) -> usize {
        let root = self.json.as_object_mut().expect("the document is an object");
        let items = root.entry(list).or_insert_with(|| json!([])).as_array_mut().expect("lists are arrays");
        items.push(item);
        items.len() - 1
    }

    pub fn view<T: Pod>(&mut self, data: &[T]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytemuck::cast_slice(data));
        self.json["buffers"][0]["byteLength"] = json!(self.bin.len());
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": self.bin.len() - offset }))
    }

    pub fn accessor<T: Pod>(&mut self, data: &[T], component: u32, shape: &str) -> usize {
        let view = self.view(data);
        self.push("accessors", json!({ "bufferView": view, "componentType": component, "count": data.len(), "type": shape }))
    }

    pub fn positions(&mut self, data: &[[f32; 3]]) -> usize {
        let index = self.accessor(data, F32, "VEC3");
        let bound = |pick: fn(f32, f32) -> f32| (0..3).map(|axis| data.iter().map(|p| p[axis]).reduce(pick)).collect::<Vec<_>>();
        self.json["accessors"][index]["min"] = json!(bound(f32::min));
        self.json["accessors"][index]["max"] = json!(bound(f32::max));
        index
    }

    /// Adds a node to the shown scene.
    pub fn root(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(json!(index));
        index
    }

    pub fn glb(&self) -> Vec<u8> {
        let text = serde_json::to_vec(&self.json).expect("values can be written");
        glb(&text, &self.bin)
    }
}

pub fn glb(text: &[u8], bin: &[u8]) -> Vec<u8> {
    let padded = |data: &[u8], with: u8| {
        let mut data = data.to_vec();
        data.resize(data.len().next_multiple_of(4), with);
        data
    };
    let (text, bin) = (padded(text, b' '), padded(bin, 0));
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((28 + text.len() as u32 + bin.len() as u32).to_le_bytes());
    for (kind, data) in [(b"JSON", &text), (b"BIN\0", &bin)] {
        file.extend((data.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(data);
    }
    file
}

pub fn png(width: u32, height: u32) -> Vec<u8> {
    let image = image::RgbaImage::from_fn(width, height, |x, y| image::Rgba([x as u8 * 16, y as u8 * 16, 200, 255]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("PNG takes RGBA");
    bytes.into_inner()
}

/// A file with something of everything that is read.
pub fn rich() -> File {
    let mut file = File::new();
    let quad = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0_f32]];
    let position = file.positions(&quad);
    let normal = file.accessor(&[[0.0_f32, 0.0, 1.0]; 4], F32, "VEC3");
    let uv = file.accessor(&[[0.0_f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]], F32, "VEC2");
    let color = file.accessor(&[[255_u8, 128, 0, 255]; 4], U8, "VEC4");
    file.json["accessors"][color]["normalized"] = json!(true);
    let indices = file.accessor(&[0_u16, 1, 2, 0, 2, 3], U16, "SCALAR");
    let image = file.view(&png(8, 4));
    file.push("images", json!({ "name": "checker", "bufferView": image, "mimeType": "image/png" }));
    file.push("samplers", json!({ "magFilter": 9728, "wrapS": 33071, "wrapT": 33648 }));
    file.push("textures", json!({ "source": 0, "sampler": 0 }));
    file.push("textures", json!({ "source": 0 }));
    file.push(
        "materials",
        json!({
            "name": "everything",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.5, 0.25, 1.0, 0.75], "metallicFactor": 0.5, "roughnessFactor": 0.25,
                "baseColorTexture": { "index": 0, "extensions": { "KHR_texture_transform": { "offset": [0.5, 0.0], "scale": [2.0, 2.0] } } },
                "metallicRoughnessTexture": { "index": 1 }
            },
            "normalTexture": { "index": 1, "scale": 0.5, "extensions": { "KHR_texture_transform": { "rotation": 1.0 } } },
            "emissiveFactor": [1.0, 0.5, 0.0],
            "emissiveTexture": { "index": 0 },
            "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
            "extensions": {
                "KHR_materials_emissive_strength": { "emissiveStrength": 4.0 },
                "KHR_materials_ior": { "ior": 1.25 },
                "KHR_materials_specular": { "specularFactor": 0.5, "specularColorFactor": [0.5, 1.0, 1.0] }
            }
        }),
    );
    file.push("materials", json!({ "extensions": { "KHR_materials_unlit": {} }, "alphaMode": "BLEND" }));
    let attributes = json!({ "POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv, "COLOR_0": color });
    file.push(
        "meshes",
        json!({ "name": "quads", "primitives": [
            { "attributes": attributes, "indices": indices, "material": 0 },
            { "attributes": { "POSITION": position }, "mode": 5, "material": 1 }
        ] }),
    );
    let base = file.view(&quad);
    let places = file.view(&[3_u16, 0]);
    let values = file.view(&[[0.0_f32, 2.0, 0.0]]);
    let sparse = json!({
        "count": 1,
        "indices": { "bufferView": places, "componentType": U16 },
        "values": { "bufferView": values }
    });
    let sparse = file.push(
        "accessors",
        json!({ "bufferView": base, "componentType": F32, "count": 4, "type": "VEC3", "sparse": sparse,
            "min": [0.0, 0.0, 0.0], "max": [1.0, 2.0, 0.0] }),
    );
    file.push("meshes", json!({ "primitives": [{ "attributes": { "POSITION": sparse }, "mode": 6 }] }));
    file.push(
        "cameras",
        json!({ "name": "main", "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5 } }),
    );
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_texture_transform"]);
    file.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "name": "sun", "type": "directional", "intensity": 3.0, "color": [1.0, 0.5, 0.25] },
        { "type": "point", "intensity": 5.0, "range": 10.0 },
        { "type": "spot", "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.6 } }
    ] } });
    let light = |index: u32| json!({ "KHR_lights_punctual": { "light": index } });
    let moving = file.push("nodes", json!({ "name": "moving", "mesh": 0 }));
    let child = file.push("nodes", json!({ "mesh": 1, "extensions": light(1), "translation": [0.0, 1.0, 0.0] }));
    file.root(json!({ "name": "root", "children": [moving, child], "scale": [2.0, 2.0, 2.0], "translation": [1.0, 2.0, 3.0] }));
    file.root(json!({ "camera": 0, "translation": [0.0, 0.0, 8.0] }));
    let turn = std::f32::consts::FRAC_1_SQRT_2;
    file.root(json!({ "extensions": light(0), "rotation": [-turn, 0.0, 0.0, turn] }));
    file.root(json!({ "extensions": light(2), "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1] }));
    let times = file.accessor(&[0.0_f32, 2.0], F32, "SCALAR");
    let slide = file.accessor(&[[0.0_f32; 3], [4.0, 0.0, 0.0]], F32, "VEC3");
    let spin = file.accessor(&[[0.0_f32, 0.0, 0.0, 1.0], [0.0, turn, 0.0, turn]], F32, "VEC4");
    file.push(
        "animations",
        json!({
            "samplers": [{ "input": times, "output": slide }, { "input": times, "output": spin, "interpolation": "STEP" }],
            "channels": [
                { "sampler": 0, "target": { "node": moving, "path": "translation" } },
                { "sampler": 1, "target": { "node": moving, "path": "rotation" } }
            ]
        }),
    );
    file
}

/// Everything that a renderer would do before its first frame.
pub fn use_it(scene: &Scene, case: &str) {
    for mesh in &scene.meshes {
        assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < mesh.positions.len()), "{case}");
        assert!(mesh.normals.len() == mesh.positions.len() && mesh.materials.len() == mesh.triangles.len(), "{case}");
        assert!(mesh.normals.iter().all(|normal| normal.is_normalized()), "{case}");
        assert!(mesh.tangents.iter().all(|tangent| tangent.is_finite() && tangent.w.abs() == 1.0), "{case}");
    }
    Features::of(scene);
    let emitters = Emitters::find(scene);
    let environment = scene.environment.as_ref().map(EnvironmentDistribution::new);
    for time in [0.0, 1.0, 1e9] {
        let Ok(moment) = scene.at(time, None) else { continue };
        let tlas = Tlas::build(scene, &moment);
        LightList::build(scene, &emitters, environment.as_ref(), &moment, &tlas);
        CpuTracer::new(scene, &moment, &tlas).closest(Vec3::new(0.3, 0.2, 9.0), Vec3::NEG_Z, [0.0, f32::INFINITY]);
    }
}
