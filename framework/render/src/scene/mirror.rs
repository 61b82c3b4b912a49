//! Scene records as bytes: Rust twins of structs in the shaders. The layouts are the shaders'; a test compares every offset with reflection.

use aquifer_scene as scene;
use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Vec3};

/// `scene/geometry::NONE`: no such index.
pub const NONE: u32 = u32::MAX;

macro_rules! twins {
    ($($(#[doc = $doc:expr])+ $module:literal $name:ident { $($field:ident: $ty:ty,)+ })+) => {
        $($(#[doc = $doc])+
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
        pub struct $name { $(pub $field: $ty,)+ })+

        /// (module, struct, size, [(member, offset)]) of every twin.
        #[cfg(test)]
        pub fn layouts() -> Vec<(&'static str, &'static str, usize, Vec<(&'static str, usize)>)> {
            vec![$(($module, stringify!($name), size_of::<$name>(),
                vec![$((stringify!($field), std::mem::offset_of!($name, $field)),)+])),+]
        }
    };
}

twins! {
    /// The pinhole camera.
    "frame/frame" Camera {
        position: [f32; 3], tan_half_fov: f32, right: [f32; 3], near: f32, up: [f32; 3], jitter_x: f32, forward: [f32; 3], jitter_y: f32,
    }
    /// Uniform of every pass.
    "frame/frame" Frame {
        extent: [u32; 2], index: u32, history_valid: u32, seed: [u32; 2], lights: u32, moving: u32, camera: Camera, camera_prev: Camera,
    }
    /// Corners and packed normals.
    "scene/geometry" Triangle { a: [f32; 3], na: u32, b: [f32; 3], nb: u32, c: [f32; 3], nc: u32, }
    /// Material and place among emitters.
    "scene/geometry" TriangleInfo { material: u32, emissive: u32, }
    /// A mesh in the world.
    "scene/geometry" Instance {
        to_world_x: [f32; 4], to_world_y: [f32; 4], to_world_z: [f32; 4], to_object_x: [f32; 4], to_object_y: [f32; 4], to_object_z: [f32; 4],
        first_triangle: u32, first_light: u32, mirrored: u32, padding: u32,
    }
    /// A surface.
    "scene/material" Material {
        base_color: [f32; 4], emission: [f32; 3], flags: u32, specular_color: [f32; 3], specular: f32, metallic: f32, roughness: f32,
        reflectance: f32, alpha_cutoff: f32, base_color_texture: u32, metallic_roughness_texture: u32, emission_texture: u32,
        normal_texture: u32, normal_scale: f32, padding: [u32; 3],
    }
    /// The box of everything.
    "scene/bounds" Bounds { low: [f32; 3], padding: u32, high: [f32; 3], padding_too: u32, }
    /// Both sets of texture coordinates of the corners.
    "scene/material" TriangleUvs { a: [f32; 4], b: [f32; 4], c: [f32; 4], }
    /// One use of an image.
    "scene/texture" Texture { u_row: [f32; 4], v_row: [f32; 4], first: u32, width: u32, height: u32, flags: u32, }
    /// One light.
    "lights/scene" Light { kind: u32, index: u32, triangle: u32, pmf: f32, threshold: f32, other: u32, }
    /// A punctual light in the world.
    "scene/punctual" Punctual {
        position: [f32; 3], kind: u32, direction: [f32; 3], range: f32, intensity: [f32; 3], cone_scale: f32, cone_offset: f32, padding: [u32; 3],
    }
    /// Size and turn of the environment map.
    "scene/environment" EnvironmentInfo { to_map_x: [f32; 3], width: u32, to_map_y: [f32; 3], height: u32, to_map_z: [f32; 3], padding: u32, }
}

impl Camera {
    /// At `jitter` within the pixel.
    pub fn new(camera: &scene::Camera, jitter: [f32; 2]) -> Camera {
        let m = camera.to_world.matrix3;
        Camera {
            position: camera.position().into(),
            tan_half_fov: (camera.vertical_fov * 0.5).tan(),
            right: m.x_axis.into(),
            near: camera.near,
            up: m.y_axis.into(),
            jitter_x: jitter[0],
            forward: (-m.z_axis).into(),
            jitter_y: jitter[1],
        }
    }
}

impl Instance {
    /// Of an instance that casts and receives: one squashed flat keeps zeros, since no leaf of the hierarchy holds it.
    pub fn new(instance: &scene::Instance, first_triangle: u32, first_light: u32) -> Instance {
        let [to_world_x, to_world_y, to_world_z] = rows(&instance.transform);
        let inverse = if instance.is_solid() { instance.transform.inverse() } else { Affine3A::ZERO };
        let [to_object_x, to_object_y, to_object_z] = rows(&inverse);
        let mirrored = u32::from(instance.mirrors());
        Instance {
            to_world_x,
            to_world_y,
            to_world_z,
            to_object_x,
            to_object_y,
            to_object_z,
            first_triangle,
            first_light,
            mirrored,
            padding: 0,
        }
    }
}

fn rows(map: &Affine3A) -> [[f32; 4]; 3] {
    let (m, t) = (map.matrix3, map.translation);
    [0, 1, 2].map(|i| [m.x_axis[i], m.y_axis[i], m.z_axis[i], t[i]])
}

impl Material {
    /// `texture` gives the index of a texture use.
    pub fn new(material: &scene::Material, mut texture: impl FnMut(&Option<scene::TextureRef>) -> u32) -> Material {
        let (mask, blend, cutoff) = match material.alpha {
            scene::Alpha::Opaque => (0, 0, 0.0),
            scene::Alpha::Mask { cutoff } => (4, 0, cutoff),
            scene::Alpha::Blend => (0, 8, 0.0),
        };
        Material {
            base_color: material.base_color.into(),
            emission: material.emission.into(),
            flags: u32::from(material.double_sided) | (u32::from(material.unlit) << 1) | mask | blend,
            specular_color: material.specular_color.into(),
            specular: material.specular,
            metallic: material.metallic,
            roughness: material.roughness,
            reflectance: ((material.ior - 1.0) / (material.ior + 1.0)).powi(2),
            alpha_cutoff: cutoff,
            base_color_texture: texture(&material.base_color_texture),
            metallic_roughness_texture: texture(&material.metallic_roughness_texture),
            emission_texture: texture(&material.emission_texture),
            normal_texture: texture(&material.normal_texture),
            normal_scale: material.normal_scale,
            padding: [0; 3],
        }
    }
}

impl Texture {
    /// `first` is the image's first texel.
    pub fn new(used: &scene::TextureRef, image: &scene::Image, first: u32) -> Texture {
        let wrap = |mode: scene::Wrap| match mode {
            scene::Wrap::Repeat => 0,
            scene::Wrap::Clamp => 1,
            scene::Wrap::Mirror => 2,
        };
        let row = |i: usize| [used.transform.x_axis[i], used.transform.y_axis[i], used.transform.z_axis[i], 0.0];
        let flags = wrap(used.wrap[0])
            | (wrap(used.wrap[1]) << 2)
            | (u32::from(used.linear) << 4)
            | (u32::from(image.srgb) << 5)
            | (u32::from(used.uv_set == 1) << 6);
        Texture { u_row: row(0), v_row: row(1), first, width: image.width, height: image.height, flags }
    }
}

impl Punctual {
    /// A light where its node stands.
    pub fn new(light: &scene::PunctualLight, placed: &scene::PlacedLight) -> Punctual {
        let (kind, cone_scale, cone_offset) = match light.shape {
            scene::PunctualShape::Directional => (0, 0.0, 1.0),
            scene::PunctualShape::Point => (1, 0.0, 1.0),
            scene::PunctualShape::Spot { inner, outer } => {
                // The extension's lightAngleScale and lightAngleOffset.
                let scale = 1.0 / (inner.cos() - outer.cos()).max(0.001);
                (2, scale, -outer.cos() * scale)
            }
        };
        Punctual {
            position: placed.position.into(),
            kind,
            direction: placed.direction.into(),
            range: light.range.unwrap_or(0.0),
            intensity: light.intensity.into(),
            cone_scale,
            cone_offset,
            padding: [0; 3],
        }
    }
}

/// A unit vector as `base/pack::unpack_unit` reads it.
pub fn pack_unit(v: Vec3) -> u32 {
    let v = v / (v.x.abs() + v.y.abs() + v.z.abs()).max(f32::MIN_POSITIVE);
    let sign = |x: f32| if x >= 0.0 { 1.0 } else { -1.0 };
    let (x, y) = if v.z >= 0.0 { (v.x, v.y) } else { ((1.0 - v.y.abs()) * sign(v.x), (1.0 - v.x.abs()) * sign(v.y)) };
    let snorm = |x: f32| u32::from((x.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16);
    snorm(x) | (snorm(y) << 16)
}

/// A row of halves, as `base/pack::unpack_half4` reads it.
pub fn pack_half4(v: [f32; 4]) -> [u32; 2] {
    let half = |x: f32| u32::from(half::f16::from_f32(x).to_bits());
    [half(v[0]) | (half(v[1]) << 16), half(v[2]) | (half(v[3]) << 16)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use aquifer_shader::{Library, ResourceKind, Specialisation};
    use std::collections::BTreeMap;

    /// A kernel that binds every struct once; reflection then tells its layout.
    #[test]
    fn twins_lie_as_their_shaders_do() {
        let mut library = Library::new();
        for (path, text) in aquifer_shaders::modules() {
            library.insert(path.clone(), text, path);
        }
        let mut by_module = BTreeMap::<_, Vec<_>>::new();
        for (module, name, ..) in layouts() {
            by_module.entry(module).or_default().push(name);
        }
        let imports =
            by_module.iter().map(|(module, names)| format!("import package::{}::{{{}}};\n", module.replace('/', "::"), names.join(", ")));
        let bindings = layouts()
            .into_iter()
            .enumerate()
            .map(|(i, (_, name, ..))| format!("@group(1) @binding({i}) var<storage, read> b{i}: array<{name}>;\n"));
        let uses = (0..layouts().len()).map(|i| format!("sum += arrayLength(&b{i});"));
        let text = format!(
            "{}{}@group(1) @binding(99) var<storage, read_write> out: u32;\n@compute @workgroup_size(1) fn main() {{ var sum = 0u; {} out = sum; }}\n",
            imports.collect::<String>(),
            bindings.collect::<String>(),
            uses.collect::<String>()
        );
        library.insert("test/layouts", text, "layouts.wgsl");
        let features = aquifer_scene::Features::NAMES.iter().map(|name| name.to_string()).collect();
        let what = Specialisation { entry: "test/layouts".into(), slots: library.default_slots(), features };
        let interface = library.compose(&what).unwrap().interface;
        for (i, (module, name, size, members)) in layouts().into_iter().enumerate() {
            let binding = interface.bindings.iter().find(|binding| binding.name == format!("b{i}")).unwrap();
            let ResourceKind::StorageArray { ty, stride, .. } = &binding.resource else { panic!("no array") };
            let theirs: Vec<_> = ty.members.iter().map(|member| (member.name.as_str(), member.offset as usize)).collect();
            let ours: Vec<_> = members.into_iter().filter(|(member, _)| !member.starts_with("padding")).collect();
            assert_eq!(theirs, ours, "{module}::{name}");
            assert_eq!(*stride as usize, size, "{module}::{name}");
        }
    }

    /// Rounding moves x and y of the octahedron by half a step, 1 / 65,534, and z by both together; making the vector unit stretches that
    /// by at most √3: √6 · √3 / 65,534 = 6.5e-5.
    #[test]
    fn packed_units_keep_their_direction() {
        for i in 0..1000 {
            let (z, phi) = ((i as f32 + 0.5) / 500.0 - 1.0, i as f32 * 2.399_963);
            let v = Vec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z);
            let bits = pack_unit(v);
            let p = [bits as u16 as i16, (bits >> 16) as u16 as i16].map(|s| f32::from(s) / 32767.0);
            let z = 1.0 - p[0].abs() - p[1].abs();
            let fold = (-z).max(0.0);
            let back = Vec3::new(p[0] - fold.copysign(p[0]), p[1] - fold.copysign(p[1]), z).normalize();
            assert!((back - v).length() < 6.5e-5, "{v} {back}");
        }
    }
}
