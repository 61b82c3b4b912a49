//! A corner of a courtyard with every use of an image that Aquifer reads: base colour, metallic-roughness, normal and emission maps, a
//! transformed and a mirrored texture, leaves cut out by alpha, a pane of stained glass that blends, vertex colours, and a surface that is
//! unlit. All images are painted here.

use crate::build::{Noise, Place, Random, Shape, Stage, glow, heights_to_normals, metal, paint, paint_data, plastic, tiled, transformed};
use aquifer_scene::{Alpha, Image, Material, Scene, TextureRef, Wrap};
use glam::{Quat, Vec2, Vec3, Vec4};
use std::f32::consts::TAU;

pub(super) fn textured() -> Scene {
    let mut stage = Stage::new("textured");
    add_wall_and_floor(&mut stage);
    add_globe(&mut stage);
    add_sign(&mut stage);
    add_plant(&mut stage);
    add_glass(&mut stage);
    add_painted_vase(&mut stage);
    add_lights(&mut stage);
    stage.camera("main", [0.35, 1.35, 3.5], [-0.05, 0.92, -0.6], 42.0);
    stage.camera("leaves", [-0.35, 1.15, 1.5], [-1.25, 0.95, -0.5], 45.0);
    stage.into_scene()
}

/// Bricks a tile across and down, in running bond.
const BRICKS: Vec2 = Vec2::new(4.0, 8.0);

/// Distance (0 to 1) from the joint within a brick, and a number that names the brick.
fn brick(uv: Vec2) -> (f32, u32) {
    let row = (uv.y * BRICKS.y).floor();
    let shifted = Vec2::new(uv.x * BRICKS.x + 0.5 * row.rem_euclid(2.0), uv.y * BRICKS.y);
    let inside = shifted - shifted.floor();
    let from_edge = inside.min(Vec2::ONE - inside) * Vec2::new(2.0, 1.0);
    let joint = (from_edge.min_element() / 0.13).clamp(0.0, 1.0);
    let column = shifted.x.floor().rem_euclid(BRICKS.x);
    (joint * joint * (3.0 - 2.0 * joint), (row.rem_euclid(BRICKS.y) * BRICKS.x + column) as u32)
}

fn brick_images() -> [Image; 3] {
    let grain = Noise::tiling(11, 16);
    let color = paint("brick", [512, 512], |uv| {
        let (body, number) = brick(uv);
        let own = Random::new(u64::from(number)).range(0.65, 1.1);
        let clay = Vec3::new(0.40, 0.13, 0.075) * own * (0.7 + 0.6 * grain.plane(uv * 16.0, 4));
        Vec3::new(0.42, 0.40, 0.36).lerp(clay, body).extend(1.0)
    });
    let rough = paint_data("brick roughness", [256, 256], |uv| {
        let (body, number) = brick(uv);
        let glazed = if number % 5 == 0 { 0.3 } else { 0.75 };
        Vec4::new(0.0, 1.0 + (glazed - 1.0) * body, 0.0, 1.0)
    });
    let normal = heights_to_normals("brick normals", [512, 512], 0.035, |uv| brick(uv).0 + 0.25 * grain.plane(uv * 16.0, 3));
    [color, rough, normal]
}

fn add_wall_and_floor(stage: &mut Stage) {
    let [color, rough, normal] = brick_images().map(|image| tiled(stage.image(image)));
    let wall = stage.material(Material {
        base_color_texture: Some(color),
        metallic_roughness_texture: Some(rough),
        normal_texture: Some(normal),
        ..plastic("brick", [1.0; 3], 1.0)
    });
    let checker = paint("checker", [256, 256], |uv| {
        let dark = ((uv.x * 4.0).floor() + (uv.y * 4.0).floor()).rem_euclid(2.0) > 0.5;
        let marble = Noise::tiling(5, 4).plane(uv * 4.0, 5);
        let stone = if dark { Vec3::new(0.05, 0.07, 0.07) } else { Vec3::new(0.62, 0.60, 0.55) };
        (stone * (0.6 + 0.7 * marble)).extend(1.0)
    });
    let checker = tiled(stage.image(checker));
    let turned = transformed(checker, [0.15, 0.4], 45.0_f32.to_radians(), [4.0, 4.0]);
    let floor = stage.material(Material { base_color_texture: Some(turned), ..plastic("floor", [1.0; 3], 0.3) });
    let mut yard = Shape::new("yard");
    yard.quad(floor, Vec3::new(-3.0, 0.0, 3.0), Vec3::X * 6.0, Vec3::NEG_Z * 4.5);
    yard.tiled_quad(wall, Vec3::new(-3.0, 0.0, -1.5), Vec3::X * 6.0, Vec3::Y * 3.2, Vec2::new(6.0, 3.2));
    yard.tiled_quad(wall, Vec3::new(-2.2, 0.0, 3.0), Vec3::NEG_Z * 4.5, Vec3::Y * 3.2, Vec2::new(4.5, 3.2));
    stage.add(yard);
}

/// A globe whose seas are rough paint and whose land is metal.
fn add_globe(stage: &mut Stage) {
    let noise = Noise::new(23);
    let land = move |uv: Vec2| {
        let (sin, cos) = (std::f32::consts::PI * uv.y).sin_cos();
        let around = Vec2::from_angle(TAU * uv.x) * sin;
        let height = noise.fractal(Vec3::new(around.x, cos, around.y) * 2.2 + 7.0, 5);
        ((height - 0.50) * 40.0).clamp(0.0, 1.0)
    };
    let color =
        stage.image(paint("globe", [512, 256], |uv| Vec3::new(0.03, 0.12, 0.22).lerp(Vec3::new(1.0, 0.78, 0.34), land(uv)).extend(1.0)));
    let rough = stage.image(paint_data("globe metal", [512, 256], |uv| {
        let land = land(uv);
        Vec4::new(0.0, 0.55 - 0.3 * land, land, 1.0)
    }));
    let skin = stage.material(Material {
        base_color_texture: Some(tiled(color)),
        metallic_roughness_texture: Some(tiled(rough)),
        ..metal("globe", [1.0; 3], 1.0)
    });
    let wood = stage.material(plastic("stand", [0.16, 0.08, 0.05], 0.4));
    let mut globe = Shape::new("globe");
    globe.globe(skin, Vec3::ZERO, 0.42, 40);
    let globe = stage.mesh(globe);
    stage.place(globe, Place::at(0.35, 0.62, -0.35).rotated(Quat::from_rotation_z(-0.4) * Quat::from_rotation_y(2.1)));
    let mut stand = Shape::new("stand");
    let foot = [(0.0, 0.0), (0.34, 0.0), (0.34, 0.05), (0.10, 0.10), (0.08, 0.16), (0.20, 0.26), (0.0, 0.2)];
    stand.lathe(wood, Vec3::new(0.35, 0.0, -0.35), &foot.map(Vec2::from), 40);
    stage.add(stand);
}

/// Five-by-seven letters, a row a byte, the leftmost pixel in bit 4.
const LETTERS: [[u8; 7]; 4] = [
    [0b01110, 0b10001, 0b10000, 0b10000, 0b10000, 0b10001, 0b01110],
    [0b01110, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001],
    [0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b10000],
    [0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111],
];

fn lit(uv: Vec2) -> bool {
    let cell = (uv * Vec2::new(25.0, 9.0)).floor() - Vec2::ONE;
    let (letter, column, row) = ((cell.x / 6.0).floor(), cell.x.rem_euclid(6.0) as u32, cell.y);
    let inside = (0.0..4.0).contains(&letter) && column < 5 && (0.0..7.0).contains(&row);
    inside && LETTERS[letter as usize][row as usize] >> (4 - column) & 1 == 1
}

/// A lit sign: an emission map, filtered to the nearest texel so that its edges stay sharp, beside a mirrored border.
fn add_sign(stage: &mut Stage) {
    let letters = stage.image(paint("letters", [250, 90], |uv| if lit(uv) { Vec4::ONE } else { Vec4::new(0.0, 0.0, 0.0, 1.0) }));
    let sharp = TextureRef { linear: false, wrap: [Wrap::Clamp; 2], ..tiled(letters) };
    let face = stage.material(Material {
        emission: Vec3::new(9.0, 3.2, 0.9),
        emission_texture: Some(sharp),
        ..plastic("sign", [0.03, 0.03, 0.04], 0.4)
    });
    let zigzag = stage.image(paint("zigzag", [32, 32], |uv| {
        let red = (uv.x + uv.y).fract() < 0.5;
        if red { Vec4::new(0.55, 0.05, 0.04, 1.0) } else { Vec4::new(0.8, 0.74, 0.6, 1.0) }
    }));
    let mirrored = TextureRef { wrap: [Wrap::Mirror; 2], ..tiled(zigzag) };
    let border = stage.material(Material { base_color_texture: Some(mirrored), ..plastic("border", [1.0; 3], 0.6) });
    let mut sign = Shape::new("sign");
    sign.cuboid(border, [-0.62, 1.62, -1.5], [0.82, 2.16, -1.43]);
    sign.quad(face, Vec3::new(-0.56, 1.68, -1.425), Vec3::X * 1.32, Vec3::Y * 0.42);
    sign.tiled_quad(border, Vec3::new(-2.195, 0.32, 1.4), Vec3::NEG_Z * 2.9, Vec3::Y * 0.12, Vec2::new(24.0, 1.0));
    stage.add(sign);
}

/// Leaves on crossed cards, cut out where opacity falls below one half.
fn add_plant(stage: &mut Stage) {
    let leaf = stage.image(paint("leaf", [128, 128], |uv| {
        let across = (uv.x - 0.5).abs();
        let along = 1.0 - uv.y;
        let half_width = 0.46 * (std::f32::consts::PI * along.powf(0.8)).sin().max(0.0) * (0.85 + 0.15 * (along * 60.0).sin());
        let vein = across < 0.012 || ((along - across * 0.9) * 9.0).fract() < 0.08;
        let green = if vein { Vec3::new(0.22, 0.34, 0.10) } else { Vec3::new(0.07, 0.22, 0.05) };
        green.extend(if across < half_width { 1.0 } else { 0.0 })
    }));
    let leaves = stage.material(Material {
        base_color_texture: Some(tiled(leaf)),
        alpha: Alpha::Mask { cutoff: 0.5 },
        double_sided: true,
        ..plastic("leaves", [1.0; 3], 0.6)
    });
    let clay = stage.material(plastic("clay", [0.45, 0.19, 0.10], 0.85));
    let foot = Vec3::new(-1.25, 0.0, -0.55);
    let mut pot = Shape::new("pot");
    let profile = [(0.0, 0.0), (0.20, 0.0), (0.30, 0.42), (0.33, 0.42), (0.33, 0.48), (0.27, 0.48), (0.25, 0.40), (0.0, 0.40)];
    pot.lathe(clay, foot, &profile.map(Vec2::from), 40);
    stage.add(pot);

    let mut card = Shape::new("leaf");
    card.quad(leaves, Vec3::new(-0.13, 0.0, 0.0), Vec3::X * 0.26, Vec3::Y * 0.5);
    let card = stage.mesh(card);
    let mut random = Random::new(5);
    for i in 0..46 {
        let angle = i as f32 * 2.399_963;
        let tilt = random.range(0.15, 1.15);
        let place = foot + Vec3::new(0.05 * angle.cos(), 0.40 + random.range(0.0, 0.45), 0.05 * angle.sin());
        let rotation = Quat::from_rotation_y(angle) * Quat::from_rotation_x(tilt);
        stage.place(card, Place::at(place.x, place.y, place.z).rotated(rotation).sized(random.range(0.75, 1.25)));
    }
}

/// Stained glass in front of the lamp's light: its opacity says how often light is stopped.
fn add_glass(stage: &mut Stage) {
    let panes = stage.image(paint("stained glass", [128, 128], |uv| {
        let cell = (uv * 6.0).floor();
        let inside = uv * 6.0 - cell;
        if inside.min(Vec2::ONE - inside).min_element() < 0.06 {
            return Vec4::new(0.03, 0.03, 0.03, 1.0);
        }
        let mut random = Random::new((cell.y * 6.0 + cell.x) as u64);
        let hue = Vec3::new(random.unit(), random.unit(), random.unit());
        (hue * hue * 0.8 + 0.05).extend(random.range(0.35, 0.75))
    }));
    let glass = stage.material(Material {
        base_color_texture: Some(tiled(panes)),
        alpha: Alpha::Blend,
        double_sided: true,
        ..plastic("stained glass", [1.0; 3], 0.2)
    });
    let mut screen = Shape::new("screen");
    screen.quad(glass, Vec3::new(0.95, 0.05, -0.05), Vec3::new(0.72, 0.0, -0.35), Vec3::Y * 1.2);
    stage.add(screen);
}

/// A vase coloured by its vertices, on a plinth beside an unlit card.
fn add_painted_vase(stage: &mut Stage) {
    let china = stage.material(plastic("painted china", [1.0; 3], 0.25));
    let card = stage.material(Material { unlit: true, ..plastic("unlit card", [0.85, 0.62, 0.10], 1.0) });
    let mut vase = Shape::new("vase");
    let profile = [(0.0, 0.0), (0.10, 0.0), (0.16, 0.10), (0.18, 0.22), (0.13, 0.38), (0.07, 0.48), (0.10, 0.56), (0.0, 0.54)];
    vase.lathe(china, Vec3::ZERO, &profile.map(Vec2::from), 48);
    let mut mesh = vase.into_mesh();
    mesh.colors = mesh
        .positions
        .iter()
        .map(|p| {
            let wave = 0.5 + 0.5 * (9.0 * p.y / 0.56 * TAU / 3.0 + 5.0 * p.z.atan2(p.x)).sin();
            Vec3::new(0.06, 0.14, 0.42).lerp(Vec3::new(0.85, 0.82, 0.74), wave).extend(1.0)
        })
        .collect();
    let vase = stage.raw_mesh(mesh);
    stage.place(vase, Place::at(-0.45, 0.0, 0.35));
    let mut label = Shape::new("label");
    label.quad(card, Vec3::new(-0.40, 0.001, 0.78), Vec3::new(0.22, 0.0, 0.06), Vec3::new(-0.02, 0.10, -0.06));
    stage.add(label);
}

fn add_lights(stage: &mut Stage) {
    let lamp = stage.material(glow("lamp", [17.0, 16.0, 14.0]));
    let mut panel = Shape::new("lamp");
    panel.quad(lamp, Vec3::new(0.9, 3.1, -0.9), Vec3::new(1.1, -0.5, 0.0), Vec3::Z * 1.3);
    stage.add(panel);
    stage.point("fill", [-0.8, 2.3, 2.6], [2.4, 2.9, 3.6]);
}
