//! The plain arrays of a scene. Units: metres, radians, watts; colours are linear Rec. 709.

use crate::{Bvh, Camera};
use glam::{Affine3A, DVec3, Mat3, Quat, Vec2, Vec3, Vec4};

/// Everything that can be drawn, before any time is chosen.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// What the user calls it: a generator's name or a file's stem.
    pub name: String,
    /// Triangle meshes; an instance places one in the world.
    pub meshes: Vec<Mesh>,
    /// Surfaces, indexed by [`Mesh::materials`].
    pub materials: Vec<Material>,
    /// Decoded images, indexed by [`TextureRef::image`].
    pub images: Vec<Image>,
    /// The hierarchy, parents before children.
    pub nodes: Vec<Node>,
    /// Cameras, each held by the node that names it.
    pub cameras: Vec<Lens>,
    /// Punctual lights, each held by the node that names it.
    pub lights: Vec<PunctualLight>,
    /// Light from infinitely far away, if any.
    pub environment: Option<Environment>,
    /// What moves.
    pub animation: Vec<Channel>,
    /// What the loader changed, dropped or could not honour, in words for the user.
    pub warnings: Vec<String>,
}

/// One triangle mesh. After [`Scene::finish`], `triangles` are in the order of the leaves of `bvh`.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name in the file, or empty.
    pub name: String,
    /// Object-space positions, one a vertex.
    pub positions: Vec<Vec3>,
    /// Unit shading normals, one a vertex.
    pub normals: Vec<Vec3>,
    /// Tangents with handedness in w, one a vertex, or empty.
    pub tangents: Vec<Vec4>,
    /// Two sets of texture coordinates, each one a vertex, or empty.
    pub uvs: [Vec<Vec2>; 2],
    /// Linear RGBA vertex colours, one a vertex, or empty.
    pub colors: Vec<Vec4>,
    /// Vertex indices, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Index into [`Scene::materials`], one a triangle.
    pub materials: Vec<u32>,
    /// Hierarchy over `triangles`; empty until [`Scene::finish`] builds it.
    pub bvh: Bvh,
}

/// A node of the hierarchy. Its world transform is its parent's times `translation * rotation * scale`.
#[derive(Clone, Debug)]
pub struct Node {
    /// Name in the file, or empty.
    pub name: String,
    /// Index of the parent, always smaller than the own index.
    pub parent: Option<u32>,
    /// Translation in metres.
    pub translation: Vec3,
    /// Unit rotation.
    pub rotation: Quat,
    /// Scale by axis.
    pub scale: Vec3,
    /// Index into [`Scene::meshes`].
    pub mesh: Option<u32>,
    /// Index into [`Scene::cameras`].
    pub camera: Option<u32>,
    /// Index into [`Scene::lights`].
    pub light: Option<u32>,
}

impl Default for Node {
    fn default() -> Self {
        Self {
            name: String::new(),
            parent: None,
            translation: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            scale: Vec3::ONE,
            mesh: None,
            camera: None,
            light: None,
        }
    }
}

/// A pinhole camera without its place: it looks down −Z of its node, +Y is up.
#[derive(Clone, Debug)]
pub struct Lens {
    /// Name for `--camera`.
    pub name: String,
    /// Full vertical field of view, radians.
    pub vertical_fov: f32,
    /// Width over height of the intended picture; `None` follows the output.
    pub aspect: Option<f32>,
    /// Near plane in metres, used by the rasteriser only.
    pub near: f32,
}

/// glTF 2.0 metallic-roughness surface (Appendix B), with the extensions that Aquifer reads.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name in the file, or empty.
    pub name: String,
    /// Linear base colour and opacity.
    pub base_color: Vec4,
    /// Multiplies `base_color`; sRGB image.
    pub base_color_texture: Option<TextureRef>,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// Perceptual roughness; α = roughness².
    pub roughness: f32,
    /// G = roughness, B = metallic; linear image.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Emitted radiance, W·m⁻²·sr⁻¹: emissiveFactor × emissive strength.
    pub emission: Vec3,
    /// Multiplies `emission`; sRGB image.
    pub emission_texture: Option<TextureRef>,
    /// Tangent-space normal; linear image.
    pub normal_texture: Option<TextureRef>,
    /// Scale of the normal map's x and y.
    pub normal_scale: f32,
    /// Index of refraction of the dielectric (KHR_materials_ior), 1.5 by default.
    pub ior: f32,
    /// KHR_materials_specular: strength and colour of the dielectric's F0.
    pub specular: f32,
    /// See `specular`.
    pub specular_color: Vec3,
    /// How `base_color.w` is used.
    pub alpha: Alpha,
    /// Both sides are shaded (and emit).
    pub double_sided: bool,
    /// KHR_materials_unlit: shown as base colour, neither lit nor lighting.
    pub unlit: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            emission: Vec3::ZERO,
            emission_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            ior: 1.5,
            specular: 1.0,
            specular_color: Vec3::ONE,
            alpha: Alpha::Opaque,
            double_sided: false,
            unlit: false,
        }
    }
}

/// How opacity is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// Ignored.
    Opaque,
    /// A hole where opacity is below the cutoff.
    Mask {
        /// The cutoff.
        cutoff: f32,
    },
    /// A hole with probability 1 − opacity.
    Blend,
}

/// One use of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureRef {
    /// Index into [`Scene::images`].
    pub image: u32,
    /// Which of [`Mesh::uvs`].
    pub uv_set: u32,
    /// KHR_texture_transform as a 2D affine map of (u, v, 1).
    pub transform: Mat3,
    /// Wrapping in u and v.
    pub wrap: [Wrap; 2],
    /// Bilinear (true) or nearest.
    pub linear: bool,
}

/// What happens outside \[0, 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// Tile.
    Repeat,
    /// Hold the edge.
    Clamp,
    /// Tile, every other one mirrored.
    Mirror,
}

/// A decoded image, 8 bits a channel, row by row from the top.
#[derive(Clone, Debug)]
pub struct Image {
    /// Name or path, for messages.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// RGBA, as stored (not yet linearised); `srgb` says how to read RGB.
    pub rgba: Vec<[u8; 4]>,
    /// RGB is sRGB encoded.
    pub srgb: bool,
}

/// KHR_lights_punctual, without its place: it shines down −Z of its node.
#[derive(Clone, Debug)]
pub struct PunctualLight {
    /// Name in the file, or empty.
    pub name: String,
    /// Directional: irradiance on a plane that faces it. Point, spot: radiant intensity, per steradian.
    pub intensity: Vec3,
    /// What kind.
    pub shape: PunctualShape,
    /// Distance at which it is windowed to nothing (KHR_lights_punctual `range`); `None` is infinite.
    pub range: Option<f32>,
}

/// The kinds of punctual light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctualShape {
    /// From infinitely far, along the node's −Z.
    Directional,
    /// In all directions.
    Point,
    /// In a cone round −Z, with the extension's smooth edge between the two half angles (radians).
    Spot {
        /// Full intensity within.
        inner: f32,
        /// Nothing beyond.
        outer: f32,
    },
}

/// Light from infinitely far, equirectangular: u = 0.5 + atan2(x, −z) / 2π, v = acos(y) / π.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Name or path, for messages.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Radiance, row by row from the top (+Y).
    pub radiance: Vec<[f32; 3]>,
    /// Turns a world direction into the map's.
    pub world_to_map: Mat3,
}

/// One animated property of one node.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Index into [`Scene::nodes`].
    pub node: u32,
    /// Which property, with its key values.
    pub track: Track,
    /// Seconds, strictly increasing, one a key.
    pub times: Vec<f32>,
    /// How values between keys are made.
    pub interpolation: Interpolation,
}

/// Key values. Cubic splines hold three a key: in-tangent, value, out-tangent.
#[derive(Clone, Debug)]
pub enum Track {
    /// Metres.
    Translation(Vec<Vec3>),
    /// Unit quaternions.
    Rotation(Vec<Quat>),
    /// By axis.
    Scale(Vec<Vec3>),
}

/// glTF's three interpolations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the key before.
    Step,
    /// Straight, or along the great circle.
    Linear,
    /// Hermite.
    CubicSpline,
}

/// A scene at one time.
#[derive(Clone, Debug)]
pub struct Moment {
    /// Seconds.
    pub time: f32,
    /// Where the places of this moment begin to count, in the scene's own world: the origin itself unless the camera is far from it.
    pub origin: DVec3,
    /// Placed meshes, in node order: the same index is the same thing at every time.
    pub instances: Vec<Instance>,
    /// Placed punctual lights, in node order.
    pub lights: Vec<PlacedLight>,
    /// The chosen camera.
    pub camera: Camera,
}

/// A mesh in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Index into [`Scene::nodes`], for messages.
    pub node: u32,
    /// Object to world.
    pub transform: Affine3A,
}

/// A punctual light in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedLight {
    /// Index into [`Scene::lights`].
    pub light: u32,
    /// World position, metres.
    pub position: Vec3,
    /// Unit world direction in which it shines.
    pub direction: Vec3,
}
