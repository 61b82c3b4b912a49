//! Shader traversal against obvhs's on the same rays.

use aquifer_scene::{CpuTracer, Tlas};
use aquifer_tests::{Parts, context, scene};
use glam::Vec3;

const RAYS: usize = 250_000;

/// Random rays from within the scene's box; what they hit; whether the stack ran over; whether a shadow ray to just before and just
/// beyond the hit agrees.
const KERNEL: &str = "
import package::base::rng::{rng_begin, rng_next4};
import package::base::sampling::{sample_sphere};
import package::base::math::{HUGE};
import package::frame::frame::{NOW};
import package::scene::geometry::{NONE};
import package::scene::ray::{Ray};
import package::scene::hierarchy::{stack_overflow};
import package::slot::trace::{closest, occluded};
struct Params {
    /// @default 0
    low_x: f32,
    /// @default 0
    low_y: f32,
    /// @default 0
    low_z: f32,
    /// @default 0
    high_x: f32,
    /// @default 0
    high_y: f32,
    /// @default 0
    high_z: f32,
}
struct Traced { origin: vec3<f32>, t: f32, direction: vec3<f32>, instance: u32, triangle: u32, u: f32, v: f32, flags: u32 }
@group(1) @binding(0) var<uniform> params: Params;
/// @extent fixed 250000
@group(1) @binding(1) var<storage, read_write> traced: array<Traced>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&traced)) { return; }
    var rng = rng_begin(vec2<u32>(3u, 5u), id.xy, 0u, 0u);
    let low = vec3<f32>(params.low_x, params.low_y, params.low_z);
    let high = vec3<f32>(params.high_x, params.high_y, params.high_z);
    let origin = mix(low, high, rng_next4(&rng).xyz);
    let direction = sample_sphere(rng_next4(&rng).xy);
    let hit = closest(Ray(origin, HUGE, direction), NOW);
    var flags = 0u;
    if (hit.instance != NONE) {
        if (occluded(Ray(origin, hit.t * 0.999, direction), NOW)) { flags |= 2u; }
        if (!occluded(Ray(origin, hit.t * 1.001, direction), NOW)) { flags |= 4u; }
    }
    if (stack_overflow) { flags |= 1u; }
    traced[id.x] = Traced(origin, hit.t, direction, hit.instance, hit.triangle, hit.barycentrics.x, hit.barycentrics.y, flags);
}
";

#[test]
fn shaders_and_obvhs_hit_the_same_triangles() {
    let Some(context) = context() else { return };
    for name in ["cornell", "glossy", "animated", "outdoor"] {
        let scene = scene(name);
        let moment = scene.at(0.0, None).unwrap();
        let tlas = Tlas::build(&scene, &moment);
        let bounds = tlas.bounds().unwrap();
        let settings: Vec<String> = [("low", bounds.min), ("high", bounds.max)]
            .iter()
            .flat_map(|(end, corner)| {
                ["x", "y", "z"].iter().enumerate().map(move |(i, axis)| format!("test_trace.{end}_{axis}={:?}", corner[i]))
            })
            .collect();
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let tracer = CpuTracer::new(&scene, &moment, &tlas);
        for filling in ["bvh2", "cwbvh"] {
            let graph = format!("transport = 'emission'\noutput = 'test_trace.traced'\n[slots]\ntrace = '{filling}'\n[pass.test_trace]");
            let mut renderer =
                Parts { shaders: &[("pass/test_trace", KERNEL)], settings: &settings, ..Parts::new(&scene, &graph) }.renderer(&context);
            renderer.frame().unwrap();
            let words = renderer.read_f32("test_trace.traced").unwrap();
            assert_eq!(words.len(), RAYS * 12);
            compare(&format!("{name} by {filling}"), &words, &tracer, &scene, &moment);
        }
    }
}

fn compare(name: &str, words: &[f32], tracer: &CpuTracer, scene: &aquifer_scene::Scene, moment: &aquifer_scene::Moment) {
    let firsts: Vec<u32> =
        scene.meshes.iter().scan(0, |next, mesh| Some(std::mem::replace(next, *next + mesh.triangles.len() as u32))).collect();
    let (mut hits, mut ties, mut edges, mut shadows) = (0_usize, 0_usize, 0_usize, 0_usize);
    for ray in words.chunks_exact(12) {
        let (origin, direction) = (Vec3::from_slice(&ray[0..3]), Vec3::from_slice(&ray[4..7]));
        let (instance, triangle, flags) = (ray[7].to_bits(), ray[8].to_bits(), ray[11].to_bits());
        assert_eq!(flags & 1, 0, "{name}: the stack ran over");
        shadows += usize::from(flags & 6 != 0);
        let cpu = tracer.closest(origin, direction, [0.0, f32::MAX]);
        let mesh = |instance: u32| moment.instances[instance as usize].mesh as usize;
        let gpu = (instance != u32::MAX).then(|| (instance, triangle - firsts[mesh(instance)], ray[3]));
        match (cpu, gpu) {
            (None, None) => {}
            (Some(cpu), Some((instance, triangle, t))) if (cpu.t - t).abs() <= 1e-4 * t.max(1.0) => {
                hits += 1;
                if (cpu.instance, cpu.triangle) != (instance, triangle) {
                    // The same distance on another triangle: an edge that both share, or two that coincide. The shader's must be met there too.
                    let there = distance_to(scene, &moment.instances[instance as usize], triangle, origin, direction);
                    assert!(
                        there.is_some_and(|there| (there - f64::from(t)).abs() <= 1e-4 * there.max(1.0)),
                        "{name}: {cpu:?} and {gpu:?}, {there:?}"
                    );
                    ties += 1;
                }
            }
            // One of the two slipped past an edge: its own hit, or the nearer one of the other, lies on one.
            (cpu, gpu) => {
                let near = |u: f32, v: f32| u.min(v).min(1.0 - u - v) < 1e-3;
                let at_edge =
                    cpu.is_some_and(|hit| near(hit.barycentrics[0], hit.barycentrics[1])) || (gpu.is_some() && near(ray[9], ray[10]));
                assert!(at_edge, "{name}: {cpu:?} and {gpu:?} from {origin} along {direction}");
                edges += 1;
            }
        }
    }
    eprintln!(
        "{name}: {hits} hits, {ties} of them as near as another, {edges} past an edge, {shadows} shadow rays that disagree with the nearest hit"
    );
    assert!(hits > RAYS / 10, "{name}: too few hits to tell anything: {hits}");
    assert!(edges <= RAYS / 10_000, "{name}: {edges} rays slip past an edge");
    assert!(shadows <= RAYS / 10_000, "{name}: {shadows}");
}

/// Where the ray meets the plane of a triangle within a margin of its edges, in f64 (Möller and Trumbore 1997).
fn distance_to(
    scene: &aquifer_scene::Scene,
    instance: &aquifer_scene::Instance,
    triangle: u32,
    origin: Vec3,
    direction: Vec3,
) -> Option<f64> {
    let mesh = &scene.meshes[instance.mesh as usize];
    let [a, b, c] = mesh.corners(triangle as usize).map(|corner| instance.transform.transform_point3(corner).as_dvec3());
    let (origin, direction) = (origin.as_dvec3(), direction.as_dvec3());
    let (e1, e2, s) = (b - a, c - a, origin - a);
    let p = direction.cross(e2);
    let determinant = e1.dot(p);
    let q = s.cross(e1);
    let (u, v) = (s.dot(p) / determinant, direction.dot(q) / determinant);
    (u.min(v).min(1.0 - u - v) > -1e-3).then(|| e2.dot(q) / determinant)
}
