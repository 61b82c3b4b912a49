//! A scene in the making.

use super::{Place, Shape, facing};
use aquifer_scene::{Channel, Environment, Image, Interpolation, Lens, Material, Mesh, Node, PunctualLight, PunctualShape, Scene, Track};
use glam::Vec3;

/// Near plane of every camera made here, metres.
const NEAR: f32 = 0.01;

/// Gathers a [`Scene`]; everything added gets the index that is returned.
#[derive(Clone, Debug)]
pub struct Stage {
    scene: Scene,
}

impl Stage {
    /// An empty stage.
    pub fn new(name: &str) -> Self {
        Self { scene: Scene { name: name.into(), ..Scene::default() } }
    }

    /// The scene as it stands.
    pub fn into_scene(self) -> Scene {
        self.scene
    }

    /// Adds a material.
    pub fn material(&mut self, material: Material) -> u32 {
        push(&mut self.scene.materials, material)
    }

    /// Adds an image.
    pub fn image(&mut self, image: Image) -> u32 {
        push(&mut self.scene.images, image)
    }

    /// Adds a mesh to be placed by [`Stage::place`].
    pub fn mesh(&mut self, shape: Shape) -> u32 {
        push(&mut self.scene.meshes, shape.into_mesh())
    }

    /// Adds a mesh that is more than a [`Shape`]: with vertex colours, tangents, a second set of texture coordinates.
    pub fn raw_mesh(&mut self, mesh: Mesh) -> u32 {
        push(&mut self.scene.meshes, mesh)
    }

    /// Adds a shape and places it at the origin. Returns the node.
    pub fn add(&mut self, shape: Shape) -> u32 {
        let mesh = self.mesh(shape);
        self.place(mesh, Place::ORIGIN)
    }

    /// Places a mesh. Returns the node, which takes the mesh's name.
    pub fn place(&mut self, mesh: u32, place: Place) -> u32 {
        let name = self.scene.meshes[mesh as usize].name.clone();
        self.node(Node { mesh: Some(mesh), ..node(&name, place) })
    }

    /// Adds an empty node for others to hang from.
    pub fn pivot(&mut self, name: &str, place: Place) -> u32 {
        self.node(node(name, place))
    }

    /// Hangs a node from an earlier one, so that it moves along.
    pub fn hang(&mut self, child: u32, parent: u32) {
        debug_assert!(parent < child, "parents come before children");
        self.scene.nodes[child as usize].parent = Some(parent);
    }

    /// A camera at `eye` that looks at `target`; full vertical field of view in degrees. Returns the node.
    pub fn camera(&mut self, name: &str, eye: [f32; 3], target: [f32; 3], degrees: f32) -> u32 {
        let lens = Lens { name: name.into(), vertical_fov: degrees.to_radians(), aspect: None, near: NEAR };
        let camera = push(&mut self.scene.cameras, lens);
        let [x, y, z] = eye;
        let place = Place::at(x, y, z).rotated(facing(Vec3::from(target) - Vec3::from(eye)));
        self.node(Node { camera: Some(camera), ..node(name, place) })
    }

    /// A sun that shines along `direction`; `irradiance` (W·m⁻²) is what a plane that faces it receives. Returns the node.
    pub fn sun(&mut self, name: &str, direction: [f32; 3], irradiance: [f32; 3]) -> u32 {
        let place = Place::ORIGIN.rotated(facing(direction.into()));
        self.light(name, irradiance, PunctualShape::Directional, place)
    }

    /// A point light of radiant intensity `intensity` (W·sr⁻¹). Returns the node.
    pub fn point(&mut self, name: &str, position: [f32; 3], intensity: [f32; 3]) -> u32 {
        let [x, y, z] = position;
        self.light(name, intensity, PunctualShape::Point, Place::at(x, y, z))
    }

    /// A spot light aimed at `target`; half angles in degrees. Returns the node.
    pub fn spot(&mut self, name: &str, position: [f32; 3], target: [f32; 3], intensity: [f32; 3], half_angles: [f32; 2]) -> u32 {
        let [x, y, z] = position;
        let [inner, outer] = half_angles.map(f32::to_radians);
        let place = Place::at(x, y, z).rotated(facing(Vec3::from(target) - Vec3::from(position)));
        self.light(name, intensity, PunctualShape::Spot { inner, outer }, place)
    }

    /// Light from infinitely far away.
    pub fn environment(&mut self, environment: Environment) {
        self.scene.environment = Some(environment);
    }

    /// Moves a property of a node through its key values.
    pub fn animate(&mut self, node: u32, interpolation: Interpolation, times: &[f32], track: Track) {
        self.scene.animation.push(Channel { node, track, times: times.to_vec(), interpolation });
    }

    fn light(&mut self, name: &str, intensity: [f32; 3], shape: PunctualShape, place: Place) -> u32 {
        let light = PunctualLight { name: name.into(), intensity: intensity.into(), shape, range: None };
        let light = push(&mut self.scene.lights, light);
        self.node(Node { light: Some(light), ..node(name, place) })
    }

    fn node(&mut self, node: Node) -> u32 {
        push(&mut self.scene.nodes, node)
    }
}

fn push<T>(items: &mut Vec<T>, item: T) -> u32 {
    items.push(item);
    items.len() as u32 - 1
}

fn node(name: &str, place: Place) -> Node {
    Node {
        name: name.into(),
        parent: None,
        translation: place.translation,
        rotation: place.rotation,
        scale: place.scale,
        mesh: None,
        camera: None,
        light: None,
    }
}
