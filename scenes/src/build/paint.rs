//! Images painted by a function.

use aquifer_scene::{Image, TextureRef, Wrap};
use glam::{Mat3, Vec2, Vec3, Vec4};

/// Paints a colour image: the function gives linear RGB and opacity at (u, v), v growing downward; RGB is stored sRGB encoded.
pub fn paint(name: &str, size: [u32; 2], color: impl Fn(Vec2) -> Vec4) -> Image {
    let encode = |c: Vec4| Vec4::new(srgb(c.x), srgb(c.y), srgb(c.z), c.w);
    Image { srgb: true, ..paint_data(name, size, |uv| encode(color(uv))) }
}

/// Paints an image of plain numbers in \[0, 1\], stored as they are.
pub fn paint_data(name: &str, size: [u32; 2], value: impl Fn(Vec2) -> Vec4) -> Image {
    let [width, height] = size;
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| Vec2::new(x as f32 + 0.5, y as f32 + 0.5)));
    let extent = Vec2::new(width as f32, height as f32);
    let rgba = texels.map(|texel| value(texel / extent).to_array().map(byte)).collect();
    Image { name: name.into(), width, height, rgba, srgb: false }
}

/// A tangent-space normal map of a height field that tiles, by differences between neighbouring texels. `slope` is the height's scale over
/// the size of one tile; +Y of the map is up the image.
pub fn heights_to_normals(name: &str, size: [u32; 2], slope: f32, height: impl Fn(Vec2) -> f32) -> Image {
    let [width, rows] = size;
    let extent = Vec2::new(width as f32, rows as f32);
    let texels = (0..rows).flat_map(|y| (0..width).map(move |x| [x, y]));
    let heights: Vec<f32> = texels.clone().map(|[x, y]| height(Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / extent)).collect();
    let at = |x: u32, y: u32| heights[((y % rows) * width + x % width) as usize];
    let normals = texels.map(|[x, y]| {
        let across = at(x + 1, y) - at(x + width - 1, y);
        let down = at(x, y + 1) - at(x, y + rows - 1);
        let gradient = Vec2::new(across, -down) * extent * 0.5 * slope;
        let normal = Vec3::new(-gradient.x, -gradient.y, 1.0).normalize();
        (normal * 0.5 + 0.5).extend(1.0).to_array().map(byte)
    });
    Image { name: name.into(), width, height: rows, rgba: normals.collect(), srgb: false }
}

/// A use of an image that repeats, filtered, on the first set of texture coordinates.
pub fn tiled(image: u32) -> TextureRef {
    TextureRef { image, uv_set: 0, transform: Mat3::IDENTITY, wrap: [Wrap::Repeat; 2], linear: true }
}

/// The affine map of KHR_texture_transform: scaled, then turned, then moved. The angle turns the coordinates counter-clockwise as seen
/// with v downward: the extension's own example (offset (0, 1), a quarter turn, scale ½: the lower left quadrant) fixes the sign.
pub fn transformed(texture: TextureRef, offset: [f32; 2], radians: f32, scale: [f32; 2]) -> TextureRef {
    let turn = Mat3::from_rotation_z(-radians);
    let transform = Mat3::from_translation(offset.into()) * turn * Mat3::from_scale(scale.into());
    TextureRef { transform, ..texture }
}

fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// IEC 61966-2-1.
fn srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texture_transform_turns_as_the_extensions_example_says() {
        let quadrant = transformed(tiled(0), [0.0, 1.0], std::f32::consts::FRAC_PI_2, [0.5, 0.5]).transform;
        for corner in [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE] {
            let uv = quadrant.transform_point2(corner);
            assert!((-1e-6..=0.500_001).contains(&uv.x) && (0.499_999..=1.000_001).contains(&uv.y), "{corner} went to {uv}");
        }
    }

    #[test]
    fn a_flat_height_field_has_straight_normals() {
        let image = heights_to_normals("flat", [4, 4], 1.0, |_| 0.3);
        assert!(image.rgba.iter().all(|texel| *texel == [128, 128, 255, 255]));
    }

    #[test]
    fn a_rise_to_the_right_leans_the_normal_to_the_left() {
        let image = heights_to_normals("ramp", [4, 4], 1.0, |uv| uv.x);
        assert!(image.rgba[5][0] < 64 && image.rgba[5][1] == 128);
        // Where the tile begins again the ramp falls.
        assert!(image.rgba[4][0] > 192);
    }
}
