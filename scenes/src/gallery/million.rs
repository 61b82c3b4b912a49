//! A mountain of 1,048,352 triangles in one mesh, coloured at its vertices, in low sun under a sky: what building and walking a big
//! hierarchy costs.

use crate::build::{Noise, Place, Sky, Stage, height_field, plastic, sky};
use aquifer_scene::Scene;
use glam::{Vec2, Vec3};

/// 2 · 724² triangles.
const CELLS: u32 = 724;
/// Metres.
const SIDE: f32 = 1_600.0;
/// Keeps crests about a cell wide, so that no face turns away from its smooth normals.
const ROUNDING: f32 = 0.015;

pub(super) fn million() -> Scene {
    let mut stage = Stage::new("million");
    stage.material(plastic("ground", [1.0; 3], 0.9));
    let relief = Relief::new();
    let color = |position: Vec3, normal: Vec3| relief.color(position, normal);
    let mesh = stage.raw_mesh(height_field("mountain", SIDE, CELLS, |at| relief.height(at), Some(&color)));
    stage.place(mesh, Place::ORIGIN);
    let to_sun = Vec3::new(-0.72, 0.34, 0.28).normalize();
    stage.sun("sun", (-to_sun).to_array(), [3.2, 2.5, 1.7]);
    let look = Sky {
        zenith: Vec3::new(0.10, 0.20, 0.46),
        horizon: Vec3::new(0.62, 0.58, 0.56),
        ground: Vec3::new(0.10, 0.10, 0.10),
        to_sun,
        sun: Vec3::ZERO,
        sun_width: 1.0,
    };
    stage.environment(sky("evening", 256, &look));
    stage.camera("main", [-90.0, 92.0, 640.0], [30.0, 148.0, -60.0], 40.0);
    stage.camera("peak", [300.0, 330.0, 330.0], [20.0, 210.0, -40.0], 45.0);
    stage.into_scene()
}

struct Relief {
    hills: Noise,
    ridges: Noise,
}

impl Relief {
    fn new() -> Self {
        Self { hills: Noise::new(101), ridges: Noise::new(5) }
    }

    /// One peak of sharp ridges above rolling land.
    fn height(&self, at: Vec2) -> f32 {
        let from_peak = (at - Vec2::new(40.0, -80.0)).length() / 430.0;
        let peak = (-from_peak * from_peak).exp();
        let bend = Vec2::new(self.hills.plane(at * 0.006 + 3.0, 2), self.hills.plane(at * 0.006 - 9.0, 2)) * 60.0;
        let rolling = 75.0 * self.hills.plane(at * 0.004, 5);
        rolling + peak * (90.0 + 315.0 * self.ridge((at + bend) * 0.0042)) + 6.0 * self.hills.plane(at * 0.06, 4)
    }

    /// Noise folded at its middle, so that it has crests; each octave counts more where the one before is high.
    fn ridge(&self, point: Vec2) -> f32 {
        let (mut sum, mut weight, mut scale, mut point) = (0.0, 1.0, 0.54, point);
        for _ in 0..5 {
            let fold = 2.0 * self.ridges.plane_at(point) - 1.0;
            let crest = (1.0 - (fold * fold + ROUNDING).sqrt()).max(0.0);
            let crest = crest * crest * weight;
            sum += crest * scale;
            weight = (crest * 1.6).clamp(0.0, 1.0);
            scale *= 0.46;
            point = point * 2.03 + 17.0;
        }
        sum
    }

    fn color(&self, position: Vec3, normal: Vec3) -> Vec3 {
        let patch = self.hills.plane(Vec2::new(position.x, position.z) * 0.03, 4) - 0.5;
        let rock = Vec3::new(0.25, 0.21, 0.18) * (1.0 + 0.6 * patch);
        let grass = Vec3::new(0.10, 0.15, 0.045) * (1.0 + 0.9 * patch);
        let snow = Vec3::new(0.82, 0.84, 0.88);
        let level = |from: f32, to: f32, value: f32| ((value - from) / (to - from)).clamp(0.0, 1.0);
        let green = level(0.66, 0.82, normal.y) * (1.0 - level(120.0, 190.0, position.y + 60.0 * patch));
        let white = level(0.52, 0.70, normal.y) * level(185.0, 235.0, position.y + 70.0 * patch);
        rock.lerp(grass, green).lerp(snow, white)
    }
}
