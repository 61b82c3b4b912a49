//! A scene at one time: animation applied, the hierarchy multiplied out, one camera chosen.

use crate::{Camera, Instance, Moment, Node, PlacedLight, Scene, SceneError, unit};
use glam::{Affine3A, DAffine3, DVec3, Mat3A, Vec3, Vec3A};

/// Metres between the places where a moment's origin may lie: floats tell 3·10⁻⁵ m apart half as far away.
const ORIGINS: f64 = 1024.0;

impl Scene {
    /// The scene at `time` seconds, seen by the camera of that name, or by the first camera. Before the first key and after the last
    /// one, animation holds still.
    ///
    /// Floats are fine only near their origin, so that of the moment lies near the first camera, see [`Moment::origin`].
    ///
    /// # Errors
    /// [`SceneError::UnknownCamera`] lists the cameras there are; the others speak of a scene that was not finished.
    pub fn at(&self, time: f32, camera: Option<&str>) -> Result<Moment, SceneError> {
        let origin = self.origin();
        let near = |world: DAffine3| (DAffine3::from_translation(-origin) * world).as_affine3a();
        let world: Vec<Affine3A> = self.node_transforms(time)?.into_iter().map(near).collect();
        Ok(Moment {
            time,
            origin,
            instances: self.instances(&world),
            lights: self.placed_lights(&world),
            camera: self.camera(&world, camera)?,
        })
    }

    /// Node to world at `time`, one a node.
    ///
    /// # Errors
    /// When `time` is not finite.
    pub fn world_transforms(&self, time: f32) -> Result<Vec<Affine3A>, SceneError> {
        Ok(self.node_transforms(time)?.into_iter().map(|world| world.as_affine3a()).collect())
    }

    fn node_transforms(&self, time: f32) -> Result<Vec<DAffine3>, SceneError> {
        if !time.is_finite() {
            return Err(SceneError::Time(time));
        }
        let mut nodes = self.nodes.clone();
        for channel in &self.animation {
            channel.apply(time, &mut nodes[channel.node as usize]);
        }
        let mut world: Vec<DAffine3> = Vec::with_capacity(nodes.len());
        for node in &nodes {
            let parent = node.parent.map_or(DAffine3::IDENTITY, |parent| world[parent as usize]);
            world.push(parent * node.local_transform());
        }
        Ok(world)
    }

    /// The nearest place of a moment's origin to the first camera without its animation: the same at all times, since history holds places too.
    fn origin(&self) -> DVec3 {
        let mut next = self.placed_cameras().next().map(|(node, _)| node as u32);
        let mut position = DVec3::ZERO;
        while let Some(node) = next.map(|node| &self.nodes[node as usize]) {
            position = node.local_transform().transform_point3(position);
            next = node.parent;
        }
        let origin = (position / ORIGINS).round() * ORIGINS;
        if origin.is_finite() { origin } else { DVec3::ZERO }
    }

    /// Names of the cameras that nodes hold, the default one first.
    pub fn camera_names(&self) -> Vec<String> {
        self.placed_cameras().map(|(_, camera)| self.cameras[camera].name.clone()).collect()
    }

    /// (node, camera), in the order of the cameras.
    fn placed_cameras(&self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.cameras.len()).filter_map(|camera| Some((self.nodes.iter().position(|node| node.camera == Some(camera as u32))?, camera)))
    }

    fn instances(&self, world: &[Affine3A]) -> Vec<Instance> {
        let place = |(index, node): (usize, &Node)| node.mesh.map(|mesh| Instance { mesh, node: index as u32, transform: world[index] });
        self.nodes.iter().enumerate().filter_map(place).collect()
    }

    fn placed_lights(&self, world: &[Affine3A]) -> Vec<PlacedLight> {
        let place = |(index, node): (usize, &Node)| {
            node.light.map(|light| PlacedLight {
                light,
                position: world[index].translation.into(),
                direction: unit::direction((-world[index].matrix3.z_axis).into()).unwrap_or(Vec3::NEG_Z),
            })
        };
        self.nodes.iter().enumerate().filter_map(place).collect()
    }

    fn camera(&self, world: &[Affine3A], name: Option<&str>) -> Result<Camera, SceneError> {
        let mut placed = self.placed_cameras();
        let found = match name {
            None => placed.next().ok_or(SceneError::NoCamera)?,
            Some(name) => placed
                .find(|&(_, camera)| self.cameras[camera].name == name)
                .ok_or_else(|| SceneError::UnknownCamera { name: name.to_owned(), known: self.camera_names() })?,
        };
        let lens = &self.cameras[found.1];
        let to_world = rigid(&world[found.0]).ok_or_else(|| SceneError::FlatCamera { name: lens.name.clone() })?;
        Ok(Camera { to_world, vertical_fov: lens.vertical_fov, near: lens.near })
    }
}

impl Node {
    /// `translation * rotation * scale`.
    pub fn local_transform(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale.as_dvec3(), self.rotation.as_dquat(), self.translation.as_dvec3())
    }
}

impl Instance {
    /// The transform mirrors (its determinant is negative). glTF then lets clockwise faces be front faces: the front normal stays
    /// `inverse(transform)ᵀ · object normal`, while the cross product of *world* edges points to the back.
    pub fn mirrors(&self) -> bool {
        self.transform.matrix3.determinant() < 0.0
    }

    /// The transform has a finite inverse. Others squash the mesh flat: it cannot be hit and it emits nothing.
    pub fn is_solid(&self) -> bool {
        let inverse = self.transform.inverse();
        self.transform.is_finite() && inverse.is_finite() && self.transform.matrix3.determinant() != 0.0
    }
}

/// Keeps place, viewing direction and up, and takes scale, shear and mirroring away; `None` when one of the directions is nothing,
/// or the place is nowhere.
fn rigid(transform: &Affine3A) -> Option<Affine3A> {
    let back = transform.matrix3.z_axis.try_normalize().filter(|_| transform.translation.is_finite())?;
    let up: Vec3A = transform.matrix3.y_axis.try_normalize()?.reject_from_normalized(back).try_normalize()?;
    let matrix3 = Mat3A::from_cols(up.cross(back), up, back);
    Some(Affine3A { matrix3, translation: transform.translation })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Lens;
    use glam::{Quat, vec3};
    use std::f32::consts::{FRAC_PI_2, PI};

    fn scene() -> Scene {
        let root = Node { scale: vec3(2.0, -3.0, 4.0), translation: vec3(1.0, 2.0, 3.0), ..Node::default() };
        let child = Node {
            parent: Some(0),
            rotation: Quat::from_rotation_y(FRAC_PI_2),
            translation: vec3(1.0, 0.0, 0.0),
            camera: Some(0),
            ..Node::default()
        };
        let lens = Lens { name: "main".into(), vertical_fov: 1.0, aspect: None, near: 0.1 };
        Scene { nodes: vec![root, child], cameras: vec![lens], ..Scene::default() }
    }

    #[test]
    fn cameras_lose_scale_and_mirroring() {
        let camera = scene().at(0.0, Some("main")).unwrap().camera;
        assert!(camera.position().abs_diff_eq(vec3(3.0, 2.0, 3.0), 1e-6));
        let matrix = camera.to_world.matrix3;
        assert!((matrix.determinant() - 1.0).abs() < 1e-6);
        assert!((matrix.transpose() * matrix).abs_diff_eq(Mat3A::IDENTITY, 1e-6));
        assert!((-matrix.z_axis).abs_diff_eq(glam::vec3a(-1.0, 0.0, 0.0), 1e-6), "looks where −Z went");
        assert!(matrix.y_axis.abs_diff_eq(glam::vec3a(0.0, -1.0, 0.0), 1e-6), "up is where +Y went");
    }

    #[test]
    fn far_from_the_origin_everything_is_as_fine_as_near_it() {
        let far = |translation: Vec3| {
            let root = Node { translation, ..Node::default() };
            let below = |x: f32| Node { parent: Some(0), translation: vec3(x, 2.0, -3.0), ..Node::default() };
            let lens = Lens { name: "main".into(), vertical_fov: 1.0, aspect: None, near: 0.1 };
            let nodes = vec![root, Node { camera: Some(0), ..below(0.125) }, Node { mesh: Some(0), ..below(0.126) }];
            Scene { nodes, cameras: vec![lens], ..Scene::default() }.at(0.0, None).unwrap()
        };
        for translation in [Vec3::ZERO, Vec3::splat(500.0), vec3(1e4, -1e6, 1e6), Vec3::splat(f32::MAX)] {
            let moment = far(translation);
            let apart = Vec3::from(moment.instances[0].transform.translation) - moment.camera.position();
            assert!(translation.x > 1e30 || apart.abs_diff_eq(vec3(1e-3, 0.0, 0.0), 4e-5), "{translation}: {apart}");
            assert_eq!(moment.origin == DVec3::ZERO, translation.abs().max_element() < 512.0);
            let place = moment.camera.position().as_dvec3() + moment.origin;
            assert!(place.abs_diff_eq(translation.as_dvec3() + DVec3::new(0.125, 2.0, -3.0), 1e-4) || translation.x > 1e30);
        }
    }

    #[test]
    fn unknown_cameras_are_told_what_there_is() {
        let error = scene().at(0.0, Some("mian")).unwrap_err();
        assert_eq!(error.to_string(), "no camera `mian`; the scene has `main`");
        assert_eq!(Scene::default().at(0.0, None).unwrap_err(), SceneError::NoCamera);
        assert!(matches!(scene().at(f32::NAN, None), Err(SceneError::Time(_))));
    }

    #[test]
    fn the_front_of_a_mirrored_triangle_is_where_the_cross_product_does_not_point() {
        let corners = [vec3(0.1, 0.2, 0.3), vec3(1.0, 0.0, 0.2), vec3(0.3, 0.9, 0.4)];
        let cross = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).normalize();
        for scale in [vec3(1.0, 2.0, 3.0), vec3(-1.0, 2.0, 3.0), vec3(-1.0, -2.0, 3.0), vec3(-1.0, -2.0, -3.0)] {
            let transform = Affine3A::from_scale_rotation_translation(scale, Quat::from_rotation_x(0.4), Vec3::ONE);
            let instance = Instance { mesh: 0, node: 0, transform };
            let front = Vec3::from(transform.inverse().matrix3.transpose() * Vec3A::from(cross(corners))).normalize();
            let sign = if instance.mirrors() { -1.0 } else { 1.0 };
            let world = cross(corners.map(|corner| transform.transform_point3(corner)));
            assert!(front.abs_diff_eq(world * sign, 1e-5), "{scale}");
        }
    }

    #[test]
    fn mirroring_and_flatness_show() {
        let instance = |scale| Instance { mesh: 0, node: 0, transform: Affine3A::from_scale(scale) };
        assert!(instance(vec3(1.0, -1.0, 1.0)).mirrors() && instance(vec3(1.0, -1.0, 1.0)).is_solid());
        assert!(!instance(vec3(-1.0, -1.0, 1.0)).mirrors());
        assert!(!instance(vec3(1.0, 0.0, 1.0)).is_solid());
        let turned = Instance { mesh: 0, node: 0, transform: Affine3A::from_rotation_z(PI) };
        assert!(!turned.mirrors() && turned.is_solid());
    }
}
