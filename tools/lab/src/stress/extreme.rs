//! Still scenes with numbers far from one.

use super::{Case, Known, Looks, Turned};
use aquifer_scene::{Environment, Material, Node, PunctualShape, Scene};
use aquifer_scenes::{
    build::{Place, Random, Shape, Stage, glow, matte, metal, plastic},
    by_name,
    gallery::furnace::furnace_of,
};
use glam::{Mat3, Quat, Vec3};

const NOISE: &str = "one sample of a light a pixel, of which few matter: noise";
const UNRESOLVED: &str = "all seeds leave a standard error of 3 %, where half of the band is 2.5 %: noise";

const CORNER: &str = "few paths find what a lamp of 1e-8 m² sends round a corner: noise";
const MIRROR: &str =
    "points of lights drawn without regard to the BSDF never meet the lobe of a mirror: its picture of the lamp is missing";

/// Graphs that draw points of lights, and nothing else.
const LIGHTS_ONLY: &[Known] = &[
    Known { graph: "light_sampling", why: MIRROR },
    Known { graph: "ris_only", why: MIRROR },
    Known { graph: "restir_di_unbiased", why: MIRROR },
];

/// Every still case.
pub(super) const CASES: &[Case] = &[
    Case::still("emission_range", "six cells, lit by lamps of radiance 1e-6 to 1e9", emission_range),
    Case {
        known: &[Known { graph: "path_tracer_indirect", why: CORNER }],
        ..Case::still("lamp_sizes", "a lamp 1e-4 m wide beside one 100 m long", lamp_sizes)
    },
    Case::still("touching_lamp", "a lamp that stands on the floor: 1/r² without bound", touching_lamp),
    Case { truth: Some(cornell), ..Case::still("far_1e4", "cornell 1e4 m from the origin", || moved(1.0, 1e4)) },
    Case { truth: Some(cornell), ..Case::still("far_1e6", "cornell 1e6 m from the origin", || moved(1.0, 1e6)) },
    Case { truth: Some(cornell), ..Case::still("scaled_down", "cornell scaled by 1e-3", || moved(1e-3, 0.0)) },
    Case { truth: Some(cornell), ..Case::still("scaled_up", "cornell scaled by 1e3", || moved(1e3, 0.0)) },
    Case::still("slivers", "needles of 1e-5 m, and triangles without area", slivers),
    Case {
        known: &[
            Known { graph: "light_sampling", why: NOISE },
            Known { graph: "ris_only", why: UNRESOLVED },
            Known { graph: "restir_di_unbiased", why: UNRESOLVED },
        ],
        ..Case::still("grazing", "a long floor seen and lit at a grazing angle", grazing)
    },
    Case { known: LIGHTS_ONLY, ..Case::still("sharp_and_rough", "metal of α → 0 beside plastic of α = 1", sharp_and_rough) },
    Case::still("black", "a room that reflects nothing", || boxed([0.0; 3])),
    Case::still("white", "a furnace: a white ball in even light", || furnace_of(matte("white", [1.0; 3]))),
    Case::still("one_light", "a single point light", one_light),
    Case::still("no_light", "no light at all", no_light),
    Case::still("million_lights", "2^20 emissive triangles", million_lights),
    Case { size: [1, 1], ..Case::still("one_pixel", "an image of one pixel", cornell) },
    Case { size: [64, 1], ..Case::still("one_row", "an image of one row", cornell) },
    Case { size: [3840, 2160], looks: Looks::Once, ..Case::still("4k", "3840x2160, or the limit that forbids it", cornell) },
    Case::still("light_behind", "a lamp shut away behind a wall: nothing is lit", light_behind),
    Case { looks: Looks::Refused("environment.radiance[5]"), ..Case::still("nan_texels", "NaN in the environment map", nan_texels) },
    Case::still("thin_walls", "walls 1e-4 m thick between light and dark: neighbours that see nothing alike", thin_walls),
    Case {
        turned: &[("cap", Turned::Most), ("candidates", Turned::To(128.0)), ("taps", Turned::Most)],
        ..Case::still("large_counts", "the largest caps and numbers of neighbours, 128 candidates", cornell)
    },
    Case {
        turned: &[("normal", Turned::Least), ("depth", Turned::Least)],
        known: LIGHTS_ONLY,
        ..Case::still("no_neighbour", "no pixel is like any other: neighbours are sought in vain", sharp_and_rough)
    },
];

fn cornell() -> Scene {
    (by_name("cornell").expect("it is among the built-in scenes").make)()
}

/// Cornell, scaled, then moved the same way along all axes. The light is the same: radiance knows no length.
fn moved(scale: f32, distance: f32) -> Scene {
    let mut scene = cornell();
    for node in &mut scene.nodes {
        node.parent = Some(node.parent.map_or(0, |parent| parent + 1));
    }
    scene.nodes.insert(0, Node { name: "root".into(), translation: Vec3::splat(distance), scale: Vec3::splat(scale), ..Node::default() });
    debug_assert!(scene.animation.is_empty() && scene.lights.is_empty(), "their indices and intensities would have to follow");
    scene
}

/// A room of side 2, open to the camera, of one colour, with a lamp at its ceiling.
fn boxed(color: [f32; 3]) -> Scene {
    let mut stage = Stage::new("box");
    let wall = stage.material(matte("wall", color));
    let lamp = stage.material(glow("lamp", [8.0; 3]));
    let mut room = Shape::new("room");
    room.room([Some(wall), Some(wall), Some(wall), Some(wall), Some(wall), None], [-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]);
    room.quad(lamp, Vec3::new(-0.3, 1.99, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6);
    stage.add(room);
    stage.camera("main", [0.0, 1.0, 4.0], [0.0, 1.0, 0.0], 35.0);
    stage.into_scene()
}

fn emission_range() -> Scene {
    let mut stage = Stage::new("emission_range");
    let wall = stage.material(matte("wall", [0.5; 3]));
    let mut cells = Shape::new("cells");
    for cell in 0..6 {
        let lamp = stage.material(glow(&format!("lamp {cell}"), [10.0_f32.powi(3 * cell - 6); 3]));
        let x = cell as f32 - 3.0;
        cells.room([Some(wall), Some(wall), Some(wall), Some(wall), Some(wall), None], [x, 0.0, -1.0], [x + 1.0, 1.0, 0.0]);
        cells.quad(lamp, Vec3::new(x + 0.35, 0.99, -0.65), Vec3::X * 0.3, Vec3::Z * 0.3);
    }
    stage.add(cells);
    stage.camera("main", [0.0, 0.5, 6.0], [0.0, 0.5, 0.0], 30.0);
    stage.into_scene()
}

fn lamp_sizes() -> Scene {
    let mut stage = Stage::new("lamp_sizes");
    let floor = stage.material(matte("floor", [0.5; 3]));
    let block = stage.material(plastic("block", [0.4, 0.3, 0.2], 0.5));
    let small = stage.material(glow("small", [6e7; 3]));
    let large = stage.material(glow("large", [1.0; 3]));
    let mut shape = Shape::new("all");
    shape.quad(floor, Vec3::new(-3.0, 0.0, 3.0), Vec3::X * 6.0, Vec3::NEG_Z * 6.0);
    shape.block(block, [0.5, 0.8, 0.5], Place::at(-0.6, 0.0, 0.0).turned(20.0).affine());
    shape.quad(small, Vec3::new(0.5, 1.0, 0.0), Vec3::X * 1e-4, Vec3::Z * 1e-4);
    shape.quad(large, Vec3::new(-50.0, 2.5, -0.5), Vec3::X * 100.0, Vec3::Z * 0.1);
    stage.add(shape);
    stage.camera("main", [0.0, 1.6, 4.0], [0.0, 0.3, 0.0], 40.0);
    stage.into_scene()
}

fn touching_lamp() -> Scene {
    let mut stage = Stage::new("touching_lamp");
    let floor = stage.material(matte("floor", [0.6; 3]));
    let lamp = stage.material(Material { double_sided: true, ..glow("lamp", [3.0; 3]) });
    let mut shape = Shape::new("all");
    shape.quad(floor, Vec3::new(-2.0, 0.0, 2.0), Vec3::X * 4.0, Vec3::NEG_Z * 4.0);
    shape.quad(lamp, Vec3::new(-0.5, 0.0, 0.0), Vec3::X, Vec3::Y * 0.5);
    stage.add(shape);
    stage.camera("main", [0.6, 1.5, 3.0], [0.0, 0.1, 0.0], 40.0);
    stage.into_scene()
}

fn slivers() -> Scene {
    let mut stage = Stage::new("slivers");
    let floor = stage.material(matte("floor", [0.5; 3]));
    let needle = stage.material(plastic("needle", [0.7, 0.5, 0.3], 0.4));
    let lamp = stage.material(glow("lamp", [6.0; 3]));
    let mut shape = Shape::new("all");
    let mut random = Random::new(5);
    shape.quad(floor, Vec3::new(-2.0, 0.0, -2.0), Vec3::X * 4.0, Vec3::Y * 2.5);
    // A floor of long strips, each of two triangles.
    for i in 0..256 {
        let x = -2.0 + 4.0 * i as f32 / 256.0;
        shape.quad(floor, Vec3::new(x, 0.0, 2.0), Vec3::X * (4.0 / 256.0), Vec3::NEG_Z * 4.0);
    }
    for _ in 0..2000 {
        let foot = Vec3::new(random.range(-1.5, 1.5), 0.0, random.range(-1.5, 1.5));
        let tip = foot + Vec3::new(random.range(-0.2, 0.2), random.range(0.2, 1.0), random.range(-0.2, 0.2));
        shape.facet(needle, [foot, foot + Vec3::X * 1e-5, tip]);
        let corners = [foot, foot, tip].map(|place| shape.vertex(place, Vec3::Y, glam::Vec2::ZERO));
        shape.triangle(needle, corners);
    }
    shape.quad(lamp, Vec3::new(-0.5, 2.0, -0.5), Vec3::X, Vec3::Z);
    stage.add(shape);
    stage.camera("main", [0.0, 1.2, 4.0], [0.0, 0.4, 0.0], 40.0);
    stage.into_scene()
}

fn grazing() -> Scene {
    let mut stage = Stage::new("grazing");
    let floor = stage.material(plastic("floor", [0.4; 3], 0.3));
    let lamp = stage.material(glow("lamp", [20.0; 3]));
    let mut shape = Shape::new("all");
    shape.quad(floor, Vec3::new(-50.0, 0.0, 5.0), Vec3::X * 100.0, Vec3::NEG_Z * 400.0);
    shape.quad(lamp, Vec3::new(-30.0, 0.01, -60.0), Vec3::X * 60.0, Vec3::Y * 0.5);
    stage.add(shape);
    stage.camera("main", [0.0, 0.3, 4.0], [0.0, 0.0, -40.0], 12.0);
    stage.into_scene()
}

fn sharp_and_rough() -> Scene {
    let mut stage = Stage::new("sharp_and_rough");
    let floor = stage.material(plastic("floor", [0.5; 3], 1.0));
    let mirror = stage.material(metal("mirror", [0.9; 3], 0.0));
    let rough = stage.material(plastic("rough", [0.3, 0.5, 0.3], 1.0));
    let lamp = stage.material(glow("lamp", [5.0; 3]));
    let mut shape = Shape::new("all");
    shape.room([Some(floor), Some(floor), Some(floor), Some(floor), Some(floor), None], [-2.0, 0.0, -1.5], [2.0, 2.2, 1.5]);
    shape.ball(mirror, Vec3::new(-0.7, 0.5, 0.0), 0.5, 4);
    shape.ball(rough, Vec3::new(0.7, 0.5, 0.0), 0.5, 4);
    shape.quad(lamp, Vec3::new(-0.8, 2.19, -0.5), Vec3::X * 1.6, Vec3::Z);
    stage.add(shape);
    stage.camera("main", [0.0, 1.1, 4.6], [0.0, 0.9, 0.0], 36.0);
    stage.into_scene()
}

fn one_light() -> Scene {
    let mut stage = Stage::new("one_light");
    let wall = stage.material(matte("wall", [0.5; 3]));
    let mut room = Shape::new("room");
    room.room([Some(wall), Some(wall), Some(wall), Some(wall), Some(wall), None], [-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]);
    room.block(wall, [0.6, 0.6, 0.6], Place::at(0.2, 0.0, 0.0).turned(25.0).affine());
    stage.add(room);
    stage.point("light", [-0.2, 1.6, 0.2], [1.0; 3]);
    stage.camera("main", [0.0, 1.0, 4.0], [0.0, 1.0, 0.0], 35.0);
    let scene = stage.into_scene();
    debug_assert!(matches!(scene.lights[0].shape, PunctualShape::Point));
    scene
}

fn no_light() -> Scene {
    let mut scene = cornell();
    scene.materials.iter_mut().for_each(|material| material.emission = Vec3::ZERO);
    scene
}

/// 1,024 copies of a panel with 1,024 small lights.
fn million_lights() -> Scene {
    let mut stage = Stage::new("million_lights");
    let floor = stage.material(matte("floor", [0.5; 3]));
    let light = stage.material(glow("light", [30.0; 3]));
    let mut panel = Shape::new("panel");
    for i in 0..1024 {
        let (x, z) = ((i % 32) as f32 / 32.0, (i / 32) as f32 / 32.0);
        let corner = Vec3::new(x, 0.0, z);
        panel.facet(light, [corner, corner + Vec3::X * 0.01, corner + Vec3::Z * 0.01]);
    }
    let panel = stage.mesh(panel);
    for i in 0..1024 {
        let place = Place::at(-2.0 + (i % 32) as f32 / 8.0, 2.0 + 0.1 * (i % 7) as f32, -2.0 + (i / 32) as f32 / 8.0);
        stage.place(panel, place.sized(0.125));
    }
    let mut ground = Shape::new("ground");
    ground.quad(floor, Vec3::new(-3.0, 0.0, 3.0), Vec3::X * 6.0, Vec3::NEG_Z * 6.0);
    ground.block(floor, [0.8, 0.8, 0.8], Place::at(0.0, 0.0, 0.0).turned(30.0).affine());
    stage.add(ground);
    stage.camera("main", [0.0, 1.2, 4.0], [0.0, 0.4, 0.0], 42.0);
    stage.into_scene()
}

/// The lamp shines away from the room, behind its back wall.
fn light_behind() -> Scene {
    let mut stage = Stage::new("light_behind");
    let wall = stage.material(matte("wall", [0.5; 3]));
    let lamp = stage.material(glow("lamp", [8.0; 3]));
    let mut room = Shape::new("room");
    room.room([Some(wall), Some(wall), Some(wall), Some(wall), Some(wall), None], [-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]);
    room.cuboid(wall, [-1.5, -0.5, -1.3], [1.5, 2.5, -1.1]);
    room.quad(lamp, Vec3::new(-0.5, 0.5, -1.5), Vec3::Y, Vec3::X);
    stage.add(room);
    stage.camera("main", [0.0, 1.0, 4.0], [0.0, 1.0, 0.0], 35.0);
    stage.into_scene()
}

fn nan_texels() -> Scene {
    let mut scene = no_light();
    let mut radiance = vec![[1.0; 3]; 8];
    radiance[5][1] = f32::NAN;
    scene.environment = Some(Environment { name: "sky".into(), width: 4, height: 2, radiance, world_to_map: Mat3::IDENTITY });
    scene
}

/// Panels that stand upright on a floor, edge on to the camera, each with a lamp on one side.
fn thin_walls() -> Scene {
    let mut stage = Stage::new("thin_walls");
    let floor = stage.material(matte("floor", [0.6; 3]));
    let wall = stage.material(matte("wall", [0.5, 0.3, 0.3]));
    let lamp = stage.material(glow("lamp", [12.0; 3]));
    let mut shape = Shape::new("all");
    shape.quad(floor, Vec3::new(-3.0, 0.0, 3.0), Vec3::X * 6.0, Vec3::NEG_Z * 6.0);
    let mut panel = Shape::new("panel");
    panel.cuboid(wall, [0.0, 0.0, -1.5], [1e-4, 1.0, 1.5]);
    for i in 0..9 {
        let x = 0.4 * (i as f32 - 4.0);
        shape.append(&panel, Place::at(x, 0.0, 0.0).rotated(Quat::from_rotation_y(0.1 * (i as f32 - 4.0))).affine());
    }
    for i in 0..4 {
        let x = 0.8 * (i as f32 - 2.0) + 0.15;
        shape.quad(lamp, Vec3::new(x, 0.9, -0.2), Vec3::X * 0.1, Vec3::Z * 0.4);
    }
    stage.add(shape);
    stage.camera("main", [0.2, 2.2, 3.4], [0.0, 0.3, 0.0], 42.0);
    stage.into_scene()
}
