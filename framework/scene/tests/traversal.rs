//! The two-level hierarchy against every triangle tried in turn, in double precision.

use aquifer_scene::{CpuTracer, Hit, Lens, Material, Mesh, Moment, Node, Scene, Tlas};
use glam::{Quat, Vec3, vec3};

/// SplitMix64.
struct Numbers(u64);

impl Numbers {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    fn cube(&mut self) -> Vec3 {
        vec3(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }
}

fn soup(numbers: &mut Numbers, triangles: u32, size: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for index in 0..triangles {
        let centre = numbers.cube();
        mesh.positions.extend([(); 3].map(|()| centre + numbers.cube() * size));
        mesh.triangles.push([3 * index, 3 * index + 1, 3 * index + 2]);
        mesh.materials.push(0);
    }
    mesh
}

/// Flat, sunk into an axis plane: the boxes have no thickness.
fn floor() -> Mesh {
    let positions = vec![vec3(-3.0, -1.0, -3.0), vec3(3.0, -1.0, -3.0), vec3(3.0, -1.0, 3.0), vec3(-3.0, -1.0, 3.0)];
    Mesh { positions, triangles: vec![[0, 2, 1], [0, 3, 2]], materials: vec![0; 2], ..Mesh::default() }
}

fn scene() -> Scene {
    let mut numbers = Numbers(7);
    let meshes = vec![soup(&mut numbers, 300, 0.2), soup(&mut numbers, 1, 0.5), floor()];
    let place = |mesh, translation, rotation, scale| Node { mesh: Some(mesh), translation, rotation, scale, ..Node::default() };
    let nodes = vec![
        place(0, Vec3::ZERO, Quat::IDENTITY, Vec3::ONE),
        place(0, vec3(2.0, 0.0, 0.0), Quat::from_rotation_y(0.7), vec3(0.5, -2.0, 1.0)),
        place(1, vec3(0.0, 2.0, 0.0), Quat::from_rotation_z(1.0), Vec3::splat(3.0)),
        place(0, vec3(0.0, 0.0, -4.0), Quat::from_rotation_x(2.0), Vec3::splat(1e-4)),
        place(0, vec3(5e3, 0.0, 0.0), Quat::from_rotation_x(2.0), Vec3::splat(2e3)),
        place(2, Vec3::ZERO, Quat::IDENTITY, Vec3::ONE),
        place(0, Vec3::ZERO, Quat::IDENTITY, vec3(1.0, 0.0, 1.0)),
        // One that framed the scene would be far away, and the moment's origin with it.
        Node { camera: Some(0), ..Node::default() },
    ];
    let cameras = vec![Lens { name: "main".into(), vertical_fov: 1.0, aspect: None, near: 0.1 }];
    Scene { meshes, materials: vec![Material::default()], nodes, cameras, ..Scene::default() }.finish().expect("the scene is sound")
}

/// All hits of a ray with world-space triangles: (t, instance, triangle), and how near the ray came to an edge.
fn brute_force(scene: &Scene, moment: &Moment, origin: Vec3, direction: Vec3) -> Vec<(f64, u32, u32, f64)> {
    let (o, d) = (origin.as_dvec3(), direction.as_dvec3());
    let mut hits = Vec::new();
    for (index, instance) in moment.instances.iter().enumerate().filter(|(_, instance)| instance.is_solid()) {
        let mesh = &scene.meshes[instance.mesh as usize];
        let transform = glam::DAffine3::from_mat3_translation(
            glam::DMat3::from_cols_array(&instance.transform.matrix3.to_cols_array().map(f64::from)),
            instance.transform.translation.as_dvec3(),
        );
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(triangle).map(|corner| transform.transform_point3(corner.as_dvec3()));
            let (e1, e2) = (b - a, c - a);
            let p = d.cross(e2);
            let inverse = 1.0 / e1.dot(p);
            let u = (o - a).dot(p) * inverse;
            let q = (o - a).cross(e1);
            let v = d.dot(q) * inverse;
            let t = e2.dot(q) * inverse;
            let margin = u.min(v).min(1.0 - u - v);
            if inverse.is_finite() && margin >= -1e-3 && t > 0.0 {
                hits.push((t, index as u32, triangle as u32, margin));
            }
        }
    }
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    hits
}

fn rays(count: usize) -> impl Iterator<Item = (Vec3, Vec3)> {
    let mut numbers = Numbers(99);
    (0..count).map(move |index| {
        let origin = numbers.cube() * 4.0;
        let direction = match index % 4 {
            0 => Vec3::AXES[index / 4 % 3] * if index % 8 < 4 { 1.0 } else { -1.0 },
            1 | 2 => (numbers.cube() - origin).normalize_or(Vec3::Y),
            _ => numbers.cube().normalize_or(Vec3::X),
        };
        (origin, direction)
    })
}

#[test]
fn agrees_with_brute_force() {
    let scene = scene();
    let moment = scene.at(0.0, None).expect("time 0");
    let tlas = Tlas::build(&scene, &moment);
    let tracer = CpuTracer::new(&scene, &moment, &tlas);
    let (mut met, mut missed) = (0, 0);
    for (origin, direction) in rays(20_000) {
        let all = brute_force(&scene, &moment, origin, direction);
        let found = tracer.closest(origin, direction, [0.0, f32::INFINITY]);
        // Where the ray passes within a thousandth of an edge, rounding may decide either way.
        let first_sure = all.iter().find(|hit| hit.3 > 1e-3);
        match found {
            Some(hit) => {
                met += 1;
                check_hit(&scene, &moment, origin, direction, hit);
                assert!(all.iter().any(|&(t, i, tri, _)| i == hit.instance && tri == hit.triangle && close(t, hit.t)), "{hit:?}");
                if let Some(sure) = first_sure {
                    assert!(f64::from(hit.t) <= sure.0 * (1.0 + 1e-4) + 1e-5, "{hit:?} but {sure:?}");
                }
                assert!(tracer.occluded(origin, direction, [0.0, hit.t * 1.001 + 1e-5]));
                assert!(!tracer.occluded(origin, direction, [0.0, hit.t * 0.999 - 1e-5]));
            }
            None => {
                missed += 1;
                assert!(first_sure.is_none(), "missed {first_sure:?} from {origin} to {direction}");
                assert!(!tracer.occluded(origin, direction, [0.0, f32::INFINITY]));
            }
        }
    }
    assert!(met > 5_000 && missed > 1_000, "{met} hits, {missed} misses");
}

fn close(t: f64, found: f32) -> bool {
    (t - f64::from(found)).abs() <= 1e-4 * t + 1e-5
}

/// The barycentrics lead back to the point on the ray.
fn check_hit(scene: &Scene, moment: &Moment, origin: Vec3, direction: Vec3, hit: Hit) {
    let instance = &moment.instances[hit.instance as usize];
    let [a, b, c] = scene.meshes[instance.mesh as usize].corners(hit.triangle as usize).map(|p| instance.transform.transform_point3(p));
    let [u, v] = hit.barycentrics;
    let (on_triangle, on_ray) = (a * (1.0 - u - v) + b * u + c * v, origin + direction * hit.t);
    let slack = 1e-4 * (1.0 + on_ray.length());
    assert!(on_triangle.distance(on_ray) < slack, "{on_triangle} {on_ray}");
}

#[test]
fn instances_that_are_flat_or_empty_are_in_no_leaf() {
    let scene = scene();
    let moment = scene.at(0.0, None).expect("time 0");
    let tlas = Tlas::build(&scene, &moment);
    let mut held: Vec<u32> = tlas.bvh.nodes.iter().filter(|node| node.count == 1).map(|node| node.first).collect();
    held.sort_unstable();
    assert_eq!(held, [0, 1, 2, 3, 4, 5], "the seventh is flat");
    assert!(Tlas::build(&Scene::default(), &Moment { instances: vec![], ..moment }).bounds().is_none());
}
