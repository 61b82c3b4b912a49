//! Walls with a hole in them.

use super::Shape;
use glam::{Vec2, Vec3};

/// A wall that starts at `corner` and spans `right` × `up` (metres along unit directions); its front points along `right_dir × up_dir`.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    /// Lower left corner seen from the front.
    pub corner: Vec3,
    /// Unit direction to the right.
    pub right: Vec3,
    /// Unit direction up.
    pub up: Vec3,
    /// Width and height, metres.
    pub size: Vec2,
}

impl Shape {
    /// The wall with a rectangular hole from `low` to `high` (metres from its corner), and the four faces of the hole's reveal, which reach
    /// `depth` metres back. A hole that touches an edge of the wall leaves no strip there; without
    /// depth there is no reveal.
    pub fn pierced_wall(&mut self, material: u32, wall: Wall, low: Vec2, high: Vec2, depth: f32) {
        let Wall { corner, right, up, size } = wall;
        let at = |p: Vec2| corner + right * p.x + up * p.y;
        let mut strip = |from: Vec2, to: Vec2| {
            let extent = to - from;
            if extent.min_element() > 0.0 {
                self.quad(material, at(from), right * extent.x, up * extent.y);
            }
        };
        strip(Vec2::ZERO, Vec2::new(low.x, size.y));
        strip(Vec2::new(high.x, 0.0), size);
        strip(Vec2::new(low.x, 0.0), Vec2::new(high.x, low.y));
        strip(Vec2::new(low.x, high.y), Vec2::new(high.x, size.y));

        if depth <= 0.0 {
            return;
        }
        let back = -right.cross(up) * depth;
        let (across, along) = (right * (high.x - low.x), up * (high.y - low.y));
        self.quad(material, at(low), back, along);
        self.quad(material, at(Vec2::new(high.x, low.y)) + back, -back, along);
        self.quad(material, at(low), across, back);
        self.quad(material, at(Vec2::new(low.x, high.y)) + back, across, -back);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wall_and_reveal_face_the_open_side() {
        let mut shape = Shape::new("wall");
        let wall = Wall { corner: Vec3::ZERO, right: Vec3::X, up: Vec3::Y, size: Vec2::new(4.0, 3.0) };
        shape.pierced_wall(0, wall, Vec2::new(1.0, 0.0), Vec2::new(2.0, 2.0), 0.2);
        let mesh = shape.into_mesh();
        assert_eq!(mesh.triangles.len(), 2 * (3 + 4));
        let middle = Vec3::new(1.5, 1.0, -0.1);
        let mut area = 0.0;
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            let normal = (b - a).cross(c - a);
            area += 0.5 * normal.length();
            let in_front = normal.normalize().abs_diff_eq(Vec3::Z, 1e-6) || normal.dot(middle - a) > 0.0;
            assert!(in_front, "{a} {b} {c} faces away");
        }
        assert!((area - (12.0 - 2.0 + 0.2 * 6.0)).abs() < 1e-5);
    }
}
