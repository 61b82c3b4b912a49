//! The hierarchy with its cameras and punctual lights.

use super::{LoadError, Loader, named};
use crate::{Lens, Node, PunctualLight, PunctualShape, unit};
use glam::{Mat4, Quat, Vec3};
use gltf::json::{
    camera::Camera,
    extensions::scene::khr_lights_punctual::{Light, Type},
    scene,
    validation::Checked,
};
use std::{
    collections::HashMap,
    f32::consts::{FRAC_PI_2, PI},
};

/// Node of the file → node of the scene, for those that the shown scene reaches.
pub(super) type NodeMap = HashMap<usize, u32>;

/// How far a matrix may be from its translation, rotation and scale, relative to its largest entry.
const SHEAR: f32 = 1e-3;

impl Loader<'_> {
    /// The nodes of the file's default scene, parents first.
    pub(super) fn read_nodes(&mut self) -> Result<NodeMap, LoadError> {
        let mut map = NodeMap::new();
        let mut stack: Vec<(usize, Option<u32>)> = self.roots().into_iter().rev().map(|root| (root, None)).collect();
        while let Some((index, parent)) = stack.pop() {
            let new = self.scene.nodes.len() as u32;
            if map.insert(index, new).is_some() {
                return Err(LoadError::Hierarchy { pointer: format!("/nodes/{index}") });
            }
            let json = self.document.as_json().nodes[index].clone();
            let node = self.read_node(index, &json, parent)?;
            self.scene.nodes.push(node);
            stack.extend(json.children.iter().flatten().rev().map(|child| (child.value(), Some(new))));
        }
        Ok(map)
    }

    /// Roots of the default scene, else of the first one; a file without scenes shows every node that is no child.
    fn roots(&mut self) -> Vec<usize> {
        let root = self.document.as_json();
        let scene = root.scene.map_or(0, |scene| scene.value());
        if let Some(scene) = root.scenes.get(scene) {
            return scene.nodes.iter().map(|node| node.value()).collect();
        }
        let mut is_child = vec![false; root.nodes.len()];
        root.nodes.iter().flat_map(|node| node.children.iter().flatten()).for_each(|child| is_child[child.value()] = true);
        let roots = (0..is_child.len()).filter(|&node| !is_child[node]).collect();
        self.warn("the file has no scene: all its nodes are shown".to_owned());
        roots
    }

    fn read_node(&mut self, index: usize, json: &scene::Node, parent: Option<u32>) -> Result<Node, LoadError> {
        let name = named("node", index, json.name.as_deref());
        if json.skin.is_some() {
            self.warn(format!("{name}: its skin is not applied, the rest pose is shown"));
        }
        let (scale, rotation, translation) = self.transform(index, json, &name)?;
        let camera = json.camera.map(|camera| self.read_camera(camera.value(), json)).transpose()?.flatten();
        let light = json.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        Ok(Node {
            name: json.name.clone().unwrap_or_default(),
            parent,
            translation,
            rotation,
            scale,
            mesh: json.mesh.map(|mesh| mesh.value() as u32),
            camera,
            light: light.map(|light| light.light.value() as u32),
        })
    }

    fn transform(&mut self, index: usize, json: &scene::Node, name: &str) -> Result<(Vec3, Quat, Vec3), LoadError> {
        let Some(matrix) = json.matrix else {
            let rotation = json.rotation.map_or(Quat::IDENTITY, |rotation| Quat::from_array(rotation.0));
            let rotation =
                unit::rotation(rotation).ok_or_else(|| LoadError::invalid(format!("/nodes/{index}/rotation"), "has no length"))?;
            let vector = |given: Option<[f32; 3]>, default| given.map_or(default, Vec3::from_array);
            return Ok((vector(json.scale, Vec3::ONE), rotation, vector(json.translation, Vec3::ZERO)));
        };
        let matrix = Mat4::from_cols_array(&matrix);
        let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
        let again = Mat4::from_scale_rotation_translation(scale, rotation, translation);
        let turn = unit::rotation(rotation).filter(|_| scale.is_finite());
        let Some(turn) = turn.filter(|_| matrix.row(3) == glam::Vec4::W && matrix.determinant() != 0.0) else {
            return Err(LoadError::invalid(format!("/nodes/{index}/matrix"), "has no translation, rotation and scale"));
        };
        let largest = matrix.to_cols_array().into_iter().fold(0.0_f32, |largest, entry| largest.max(entry.abs()));
        if !again.abs_diff_eq(matrix, largest * SHEAR) {
            self.warn(format!("{name}: its matrix shears, which glTF does not allow; shown without the shear"));
        }
        Ok((scale, turn, translation))
    }

    /// Every node gets a camera of its own, since the node places it. `None` for orthographic ones.
    fn read_camera(&mut self, index: usize, node: &scene::Node) -> Result<Option<u32>, LoadError> {
        let camera: Camera = self.document.as_json().cameras[index].clone();
        let Some(perspective) = &camera.perspective else {
            self.warn(format!("{}: orthographic cameras are not supported, left out", named("camera", index, camera.name.as_deref())));
            return Ok(None);
        };
        let pointer = format!("/cameras/{index}/perspective");
        if !(perspective.yfov > 0.0 && perspective.yfov < PI) {
            return Err(LoadError::invalid(format!("{pointer}/yfov"), "must lie between 0 and π"));
        }
        let aspect = perspective.aspect_ratio;
        if aspect.is_some_and(|aspect| aspect <= 0.0) {
            return Err(LoadError::invalid(format!("{pointer}/aspectRatio"), "must be more than 0"));
        }
        let wished = camera.name.clone().or_else(|| node.name.clone()).unwrap_or_else(|| format!("camera {index}"));
        let name = self.unused_camera_name(&wished);
        self.scene.cameras.push(Lens { name, vertical_fov: perspective.yfov, aspect, near: perspective.znear });
        Ok(Some(self.scene.cameras.len() as u32 - 1))
    }

    fn unused_camera_name(&self, wished: &str) -> String {
        let is_free = |name: &String| self.scene.cameras.iter().all(|camera| camera.name != *name);
        let numbered = (2..).map(|number| format!("{wished}.{number}"));
        std::iter::once(wished.to_owned()).chain(numbered).find(is_free).unwrap_or_default()
    }

    /// The lights of KHR_lights_punctual, in the file's order. Candela and lux are taken as W/sr and W/m², as nits are for emission:
    /// all light of a scene is in one unit.
    pub(super) fn read_lights(&mut self) -> Result<(), LoadError> {
        let extensions = self.document.as_json().extensions.as_ref();
        let Some(lights) = extensions.and_then(|extensions| extensions.khr_lights_punctual.as_ref()) else { return Ok(()) };
        self.scene.lights = lights.lights.iter().enumerate().map(|(index, light)| read_light(index, light)).collect::<Result<_, _>>()?;
        Ok(())
    }
}

fn read_light(index: usize, light: &Light) -> Result<PunctualLight, LoadError> {
    let pointer = format!("/extensions/KHR_lights_punctual/lights/{index}");
    let wrong = |field: &str, why: &str| Err(LoadError::invalid(format!("{pointer}/{field}"), why));
    let intensity = Vec3::from_array(light.color) * light.intensity;
    if !intensity.is_finite() || intensity.min_element() < 0.0 {
        return wrong("intensity", "must be finite, 0 or more, in every colour");
    }
    if light.range.is_some_and(|range| range <= 0.0) {
        return wrong("range", "must be more than 0");
    }
    let shape = match (light.type_, &light.spot) {
        (Checked::Valid(Type::Directional), _) => PunctualShape::Directional,
        (Checked::Valid(Type::Point), _) => PunctualShape::Point,
        (Checked::Valid(Type::Spot), Some(spot)) => {
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            // π/2 written with a few digits too many is meant as π/2.
            if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2 + 1e-5) {
                return wrong("spot", "needs 0 ≤ innerConeAngle < outerConeAngle ≤ π/2");
            }
            let outer = outer.min(FRAC_PI_2);
            PunctualShape::Spot { inner: inner.min(outer.next_down()), outer }
        }
        (Checked::Valid(Type::Spot), None) => return wrong("spot", "missing"),
        (Checked::Invalid, _) => return wrong("type", "unknown type"),
    };
    Ok(PunctualLight { name: light.name.clone().unwrap_or_default(), intensity, shape, range: light.range })
}
