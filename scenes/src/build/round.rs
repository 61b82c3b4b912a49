//! Round shapes with smooth normals.

use super::Shape;
use glam::{Quat, Vec2, Vec3};
use std::collections::BTreeMap;
use std::f32::consts::{PI, TAU};

impl Shape {
    /// A sphere from an icosahedron split `splits` times (20 · 4^splits triangles), even all over. Its texture coordinates have a seam:
    /// for images use [`Shape::globe`].
    pub fn ball(&mut self, material: u32, center: Vec3, radius: f32, splits: u32) {
        let (directions, faces) = icosphere(splits);
        let indices: Vec<u32> =
            directions.iter().map(|direction| self.vertex(center + *direction * radius, *direction, spherical(*direction))).collect();
        for face in faces {
            self.triangle(material, face.map(|i| indices[i as usize]));
        }
    }

    /// A sphere of `rings` bands from pole to pole and twice as many around: an image wraps it once.
    pub fn globe(&mut self, material: u32, center: Vec3, radius: f32, rings: u32) {
        let profile: Vec<Vec2> = (0..=rings)
            .map(|ring| {
                let angle = PI * ring as f32 / rings as f32;
                Vec2::new(angle.sin(), -angle.cos()) * radius
            })
            .collect();
        self.lathe(material, center, &profile, rings * 2);
    }

    /// A flat disk whose front points along `normal`.
    pub fn disk(&mut self, material: u32, center: Vec3, normal: Vec3, radius: f32, segments: u32) {
        let turn = Quat::from_rotation_arc(Vec3::Z, normal.normalize());
        let normal = turn * Vec3::Z;
        let middle = self.vertex(center, normal, Vec2::splat(0.5));
        let rim: Vec<u32> = (0..segments)
            .map(|segment| {
                let round = Vec2::from_angle(TAU * segment as f32 / segments as f32);
                let uv = Vec2::new(0.5 + 0.5 * round.x, 0.5 - 0.5 * round.y);
                self.vertex(center + turn * (round * radius).extend(0.0), normal, uv)
            })
            .collect();
        for segment in 0..segments as usize {
            self.triangle(material, [middle, rim[segment], rim[(segment + 1) % segments as usize]]);
        }
    }

    /// The side of a cylinder or cone from `bottom` to `top`, open at both ends.
    pub fn tube(&mut self, material: u32, bottom: Vec3, top: Vec3, radii: [f32; 2], segments: u32) {
        let axis = top - bottom;
        let turn = Quat::from_rotation_arc(Vec3::Y, axis.normalize());
        let slope = (radii[0] - radii[1]) / axis.length();
        let ring = |shape: &mut Self, center: Vec3, radius: f32, v: f32| -> Vec<u32> {
            let vertices = 0..=segments;
            vertices
                .map(|segment| {
                    let u = segment as f32 / segments as f32;
                    let out = turn * around(u);
                    let normal = (out + axis.normalize() * slope).normalize();
                    shape.vertex(center + out * radius, normal, Vec2::new(u, v))
                })
                .collect()
        };
        let low = ring(self, bottom, radii[0], 1.0);
        let high = ring(self, top, radii[1], 0.0);
        self.band(material, &low, &high, radii[0] > 0.0, radii[1] > 0.0);
    }

    /// A cylinder closed by disks.
    pub fn rod(&mut self, material: u32, bottom: Vec3, top: Vec3, radius: f32, segments: u32) {
        self.tube(material, bottom, top, [radius; 2], segments);
        self.disk(material, bottom, bottom - top, radius, segments);
        self.disk(material, top, top - bottom, radius, segments);
    }

    /// A body of revolution about +Y through `foot`. The profile holds (radius, height) from the bottom up; a radius of 0 closes an end.
    pub fn lathe(&mut self, material: u32, foot: Vec3, profile: &[Vec2], segments: u32) {
        let rings: Vec<Vec<u32>> = (0..profile.len())
            .map(|row| {
                let slope = profile_normal(profile, row);
                let v = 1.0 - row as f32 / (profile.len() - 1) as f32;
                let vertices = 0..=segments;
                vertices
                    .map(|segment| {
                        let u = segment as f32 / segments as f32;
                        let out = around(u);
                        let position = foot + out * profile[row].x + Vec3::Y * profile[row].y;
                        self.vertex(position, out * slope.x + Vec3::Y * slope.y, Vec2::new(u, v))
                    })
                    .collect()
            })
            .collect();
        for (row, pair) in rings.windows(2).enumerate() {
            self.band(material, &pair[0], &pair[1], profile[row].x > CLOSED, profile[row + 1].x > CLOSED);
        }
    }

    /// Joins two rings of vertices; a ring that is a point gives one triangle a segment instead of two.
    fn band(&mut self, material: u32, low: &[u32], high: &[u32], low_open: bool, high_open: bool) {
        for segment in 0..low.len() - 1 {
            if low_open {
                self.triangle(material, [low[segment], low[segment + 1], high[segment + 1]]);
            }
            if high_open {
                self.triangle(material, [low[segment], high[segment + 1], high[segment]]);
            }
        }
    }
}

/// Radii below this (metres) are a point.
const CLOSED: f32 = 1e-5;

/// Unit vector in the xz plane; growing `u` turns counter-clockwise seen from above.
fn around(u: f32) -> Vec3 {
    let (sin, cos) = (TAU * u).sin_cos();
    Vec3::new(cos, 0.0, -sin)
}

/// Outward normal of a profile in (radius, height), averaged over the segments that meet at `row`.
fn profile_normal(profile: &[Vec2], row: usize) -> Vec2 {
    let before = profile[row] - profile[row.saturating_sub(1)];
    let after = profile[(row + 1).min(profile.len() - 1)] - profile[row];
    let along = before.normalize_or_zero() + after.normalize_or_zero();
    let normal = Vec2::new(along.y, -along.x).normalize_or(Vec2::X);
    if profile[row].x > CLOSED { normal } else { Vec2::new(0.0, if row == 0 { -1.0 } else { 1.0 }) }
}

fn spherical(direction: Vec3) -> Vec2 {
    Vec2::new(0.5 + direction.z.atan2(direction.x) / TAU, direction.y.clamp(-1.0, 1.0).acos() / PI)
}

fn icosphere(splits: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut directions = icosahedron_corners();
    let mut faces = ICOSAHEDRON_FACES.to_vec();
    for _ in 0..splits {
        let mut middles = BTreeMap::new();
        let mut split = Vec::with_capacity(faces.len() * 4);
        for [a, b, c] in faces {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                    directions.push((directions[p as usize] + directions[q as usize]).normalize());
                    directions.len() as u32 - 1
                })
            });
            split.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = split;
    }
    (directions, faces)
}

fn icosahedron_corners() -> Vec<Vec3> {
    let golden = 0.5 * (1.0 + 5.0_f32.sqrt());
    let corners = [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)];
    let xy = corners.map(|(a, b)| Vec3::new(a, b, 0.0));
    let yz = corners.map(|(a, b)| Vec3::new(0.0, a, b));
    let zx = corners.map(|(a, b)| Vec3::new(b, 0.0, a));
    xy.into_iter().chain(yz).chain(zx).map(Vec3::normalize).collect()
}

const ICOSAHEDRON_FACES: [[u32; 3]; 20] = [
    [0, 5, 1],
    [0, 1, 7],
    [0, 11, 5],
    [0, 7, 10],
    [0, 10, 11],
    [1, 5, 9],
    [1, 8, 7],
    [1, 9, 8],
    [2, 3, 4],
    [2, 6, 3],
    [2, 4, 11],
    [2, 10, 6],
    [2, 11, 10],
    [3, 9, 4],
    [3, 6, 8],
    [3, 8, 9],
    [4, 9, 5],
    [4, 5, 11],
    [6, 7, 8],
    [6, 10, 7],
];
