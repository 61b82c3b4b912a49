//! Facts of a scene that let the renderer leave things out.

use crate::{Alpha, Channel, Interpolation, Material, Node, Scene, Track};
use serde::Serialize;
use std::collections::BTreeSet;

macro_rules! features {
    ($($(#[doc = $doc:expr])+ $name:ident,)+) => {
        /// What a scene holds, as far as shaders care. A fact that is false lets branches, bindings and passes go.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
        pub struct Features {
            $($(#[doc = $doc])+ pub $name: bool,)+
        }

        impl Features {
            /// Every name that shaders may ask for.
            pub const NAMES: &[&'static str] = &[$(stringify!($name)),+];

            /// The names of the facts that hold: what shaders see in `@if`.
            pub fn names(&self) -> BTreeSet<&'static str> {
                let mut names = BTreeSet::new();
                $(if self.$name { names.insert(stringify!($name)); })+
                names
            }

            /// Every fact holds: nothing may be left out.
            pub const ALL: Features = Features { $($name: true,)+ };
        }
    };
}

features! {
    /// Some triangle emits.
    emissive_meshes,
    /// There are directional, point or spot lights.
    punctual_lights,
    /// Light comes from infinitely far away.
    environment,
    /// Some material reads an image.
    textures,
    /// Some material has a normal map.
    normal_maps,
    /// Some material has holes: alpha mask or blend.
    alpha,
    /// Some mesh has vertex colours.
    vertex_colors,
    /// Some material may be metallic.
    metals,
    /// Some material reflects light not only diffusely.
    glossy,
    /// Some material shows both its sides.
    double_sided,
    /// Some material is unlit.
    unlit,
    /// Some mesh moves.
    moving_objects,
    /// Some light moves: a punctual one, or a mesh that emits.
    moving_lights,
    /// Some camera moves.
    moving_camera,
}

impl Features {
    /// The facts of `scene`. Only what its nodes place counts.
    pub fn of(scene: &Scene) -> Features {
        let moving = moving_nodes(scene);
        let mut features = Features { environment: scene.environment.is_some(), ..Features::default() };
        for (node, &moves) in scene.nodes.iter().zip(&moving) {
            features.punctual_lights |= node.light.is_some();
            features.moving_lights |= moves && node.light.is_some();
            features.moving_camera |= moves && node.camera.is_some();
            features.moving_objects |= moves && node.mesh.is_some();
            features.moving_lights |= moves && emits(scene, node);
        }
        for (mesh, _) in scene.meshes.iter().zip(placed_meshes(scene)).filter(|(_, placed)| *placed) {
            features.vertex_colors |= !mesh.colors.is_empty();
            let used: BTreeSet<u32> = mesh.materials.iter().copied().collect();
            used.iter().for_each(|&material| features.add_material(&scene.materials[material as usize]));
        }
        features
    }

    fn add_material(&mut self, material: &Material) {
        self.emissive_meshes |= material.emits();
        self.textures |= material.textures().next().is_some();
        self.normal_maps |= material.normal_texture.is_some();
        self.alpha |= material.alpha != Alpha::Opaque;
        self.metals |= material.metallic > 0.0;
        self.glossy |= material.metallic > 0.0 || material.specular > 0.0;
        self.double_sided |= material.double_sided;
        self.unlit |= material.unlit;
    }
}

fn placed_meshes(scene: &Scene) -> Vec<bool> {
    let mut placed = vec![false; scene.meshes.len()];
    scene.nodes.iter().filter_map(|node| node.mesh).for_each(|mesh| placed[mesh as usize] = true);
    placed
}

fn emits(scene: &Scene, node: &Node) -> bool {
    let emissive = |&material: &u32| scene.materials[material as usize].emits();
    node.mesh.is_some_and(|mesh| scene.meshes[mesh as usize].materials.iter().any(emissive))
}

/// Nodes whose world transform changes over time, one a node.
fn moving_nodes(scene: &Scene) -> Vec<bool> {
    let mut moving = vec![false; scene.nodes.len()];
    scene.animation.iter().filter(|channel| changes(channel)).for_each(|channel| moving[channel.node as usize] = true);
    for (index, node) in scene.nodes.iter().enumerate() {
        moving[index] |= node.parent.is_some_and(|parent| moving[parent as usize]);
    }
    moving
}

/// Splines count as changing even where all their keys agree: their tangents may swing out.
fn changes(channel: &Channel) -> bool {
    fn differ<T: PartialEq>(values: &[T]) -> bool {
        values.windows(2).any(|pair| pair[0] != pair[1])
    }
    let differ = match &channel.track {
        Track::Translation(values) | Track::Scale(values) => differ(values),
        Track::Rotation(values) => differ(values),
    };
    channel.times.len() > 1 && (differ || channel.interpolation == Interpolation::CubicSpline)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use glam::Vec3;

    fn scene() -> Scene {
        let mesh = Mesh { materials: vec![1], triangles: vec![[0; 3]], ..Mesh::default() };
        let plain = Material { metallic: 0.0, specular: 0.0, ..Material::default() };
        let lamp = Material { emission: Vec3::ONE, ..plain.clone() };
        let metal_nobody_uses = Material::default();
        Scene {
            meshes: vec![mesh],
            materials: vec![plain, lamp, metal_nobody_uses],
            nodes: vec![Node::default(), Node { parent: Some(0), mesh: Some(0), ..Node::default() }],
            ..Scene::default()
        }
    }

    fn sliding(values: [f32; 2]) -> Channel {
        let track = Track::Translation(values.map(Vec3::splat).to_vec());
        Channel { node: 0, track, times: vec![0.0, 1.0], interpolation: Interpolation::Linear }
    }

    #[test]
    fn only_what_is_placed_counts() {
        assert_eq!(Features::of(&scene()).names(), BTreeSet::from(["emissive_meshes"]));
    }

    #[test]
    fn children_move_with_their_parents() {
        let mut scene = scene();
        scene.animation.push(sliding([0.0, 1.0]));
        assert_eq!(Features::of(&scene).names(), BTreeSet::from(["emissive_meshes", "moving_lights", "moving_objects"]));
        scene.animation[0] = sliding([1.0, 1.0]);
        assert!(!Features::of(&scene).moving_objects);
    }

    #[test]
    fn every_name_is_listed() {
        assert!(Features::NAMES.contains(&"moving_camera") && Features::NAMES.len() == 14);
    }
}
