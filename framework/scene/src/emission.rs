//! Which triangles give off light, and how much a texture leaves of it.

use crate::{Image, Material, Mesh, Scene, TextureRef, Wrap};
use glam::Vec2;
use std::collections::HashMap;

/// The emissive triangles of every mesh. Does not depend on time: made once a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Emitters {
    /// One a mesh.
    pub meshes: Vec<MeshEmitters>,
}

/// The emissive triangles of one mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshEmitters {
    /// Index into [`Mesh::triangles`], increasing.
    pub triangles: Vec<u32>,
    /// Mean luminance of the emitted radiance over each of `triangles`; positive wherever any point of the triangle emits.
    pub luminance: Vec<f32>,
    /// One a triangle of the mesh: its place in `triangles`, or [`MeshEmitters::DARK`]. Empty when the whole mesh is dark.
    pub ordinals: Vec<u32>,
}

impl MeshEmitters {
    /// Ordinal of a triangle that emits nothing.
    pub const DARK: u32 = u32::MAX;

    /// Place of a triangle of the mesh in `triangles`, if it emits.
    pub fn ordinal(&self, triangle: u32) -> Option<u32> {
        self.ordinals.get(triangle as usize).copied().filter(|&ordinal| ordinal != Self::DARK)
    }
}

/// Luminance of linear Rec. 709.
pub(crate) fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

impl Emitters {
    /// Looks through every triangle of the finished `scene`.
    pub fn find(scene: &Scene) -> Emitters {
        let mut sums = HashMap::new();
        Emitters { meshes: scene.meshes.iter().map(|mesh| find_in(mesh, scene, &mut sums)).collect() }
    }
}

fn find_in(mesh: &Mesh, scene: &Scene, sums: &mut HashMap<u32, AreaSums>) -> MeshEmitters {
    let mut found = MeshEmitters::default();
    for (triangle, &index) in mesh.materials.iter().enumerate() {
        let material = &scene.materials[index as usize];
        if !material.emits() {
            continue;
        }
        let mean = match &material.emission_texture {
            None => luminance(material.emission.into()),
            Some(texture) => {
                let sums = sums.entry(index).or_insert_with(|| AreaSums::new(material, &scene.images[texture.image as usize]));
                sums.mean_over(texture, mesh.triangles[triangle].map(|vertex| mesh.uvs[texture.uv_set as usize][vertex as usize]))
            }
        };
        if mean > 0.0 {
            found.triangles.push(triangle as u32);
            found.luminance.push(mean);
        }
    }
    if !found.triangles.is_empty() {
        found.ordinals = vec![MeshEmitters::DARK; mesh.triangles.len()];
        for (ordinal, &triangle) in found.triangles.iter().enumerate() {
            found.ordinals[triangle as usize] = ordinal as u32;
        }
    }
    found
}

/// Luminance of a material's textured emission, summed over rectangles in constant time (Crow 1984).
struct AreaSums {
    width: usize,
    height: usize,
    /// `(width + 1) × (height + 1)`: sum over all texels above and to the left.
    sums: Vec<f64>,
}

impl AreaSums {
    fn new(material: &Material, image: &Image) -> Self {
        let (width, height) = (image.width as usize, image.height as usize);
        let mut sums = vec![0.0; (width + 1) * (height + 1)];
        for y in 0..height {
            let mut row = 0.0;
            for x in 0..width {
                let texel = image.linear_rgb(y * width + x);
                row += f64::from(luminance((material.emission * texel).into()));
                sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + row;
            }
        }
        Self { width, height, sums }
    }

    /// Mean over the texels in `[x0, x1) × [y0, y1)`.
    fn mean(&self, x: [usize; 2], y: [usize; 2]) -> f32 {
        let at = |x: usize, y: usize| self.sums[y * (self.width + 1) + x];
        let sum = at(x[1], y[1]) - at(x[0], y[1]) - at(x[1], y[0]) + at(x[0], y[0]);
        let count = (x[1] - x[0]) * (y[1] - y[0]);
        // Differences of sums round: what is below their resolution may be dark or not, and counts as not.
        let resolution = at(self.width, self.height) * f64::EPSILON * 4.0;
        (if sum.abs() <= resolution { resolution } else { sum } / count as f64) as f32
    }

    /// Mean over the box round the triangle in texture space, with a margin for bilinear filtering: it holds every texel that can be
    /// seen on the triangle. Where the box wraps round an edge of the image, the mean over the whole image.
    fn mean_over(&self, texture: &TextureRef, uvs: [Vec2; 3]) -> f32 {
        let size = Vec2::new(self.width as f32, self.height as f32);
        let texels = uvs.map(|uv| texture.transform.transform_point2(uv) * size);
        let low = texels[0].min(texels[1]).min(texels[2]).floor() - Vec2::ONE;
        let high = texels[0].max(texels[1]).max(texels[2]).floor() + Vec2::splat(2.0);
        let x = span([low.x, high.x], self.width, texture.wrap[0]);
        let y = span([low.y, high.y], self.height, texture.wrap[1]);
        self.mean(x.unwrap_or([0, self.width]), y.unwrap_or([0, self.height]))
    }
}

/// The texels `[low, high)` of one axis inside the image, or `None` when they wrap.
fn span(range: [f32; 2], size: usize, wrap: Wrap) -> Option<[usize; 2]> {
    let length = size as f32;
    let [low, high] = match wrap {
        Wrap::Clamp => [range[0].clamp(0.0, length - 1.0), range[1].clamp(1.0, length)],
        Wrap::Repeat => {
            let tile = (range[0] / length).floor() * length;
            [range[0] - tile, range[1] - tile]
        }
        Wrap::Mirror => range,
    };
    let inside = low >= 0.0 && low < high && high <= length;
    inside.then_some([low as usize, high as usize])
}

impl Image {
    /// A texel as shaders see it: linear, 0 to 1.
    pub fn linear_rgb(&self, index: usize) -> glam::Vec3 {
        let [r, g, b, _] = self.rgba[index];
        let decode = |value: u8| {
            let stored = f32::from(value) / 255.0;
            if self.srgb { srgb_to_linear(stored) } else { stored }
        };
        glam::vec3(decode(r), decode(g), decode(b))
    }
}

/// IEC 61966-2-1.
fn srgb_to_linear(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat3, Vec3, vec2};

    fn image() -> Image {
        // 8 × 4, white in the left half.
        let rgba = (0..32).map(|i| if i % 8 < 4 { [255; 4] } else { [0, 0, 0, 255] }).collect();
        Image { name: String::new(), width: 8, height: 4, rgba, srgb: true }
    }

    fn texture(wrap: Wrap) -> TextureRef {
        TextureRef { image: 0, uv_set: 0, transform: Mat3::IDENTITY, wrap: [wrap; 2], linear: true }
    }

    fn mean(wrap: Wrap, uvs: [Vec2; 3]) -> f32 {
        let material = Material { emission: Vec3::splat(2.0), ..Material::default() };
        AreaSums::new(&material, &image()).mean_over(&texture(wrap), uvs)
    }

    #[test]
    fn a_box_inside_takes_its_own_texels() {
        // Corners in texels 2 to 3 by 1 to 2: with the margin texels 1 to 4, of which 4 is dark.
        let found = mean(Wrap::Repeat, [vec2(2.1, 1.1), vec2(3.9, 1.1), vec2(2.1, 2.9)].map(|t| t / vec2(8.0, 4.0)));
        assert!((found - 2.0 * 3.0 / 4.0).abs() < 1e-6, "{found}");
        // A tile further on it is the same.
        let found = mean(Wrap::Repeat, [vec2(10.1, 1.1), vec2(11.9, 1.1), vec2(10.1, 2.9)].map(|t| t / vec2(8.0, 4.0)));
        assert!((found - 1.5).abs() < 1e-6, "{found}");
    }

    #[test]
    fn a_box_over_an_edge_takes_the_whole_image() {
        let over = [vec2(7.5, 0.5), vec2(8.5, 0.5), vec2(7.5, 3.5)].map(|t| t / vec2(8.0, 4.0));
        assert!((mean(Wrap::Repeat, over) - 1.0).abs() < 1e-6);
        assert!((mean(Wrap::Clamp, over) - 0.0).abs() < 1e-6);
    }

    #[test]
    fn dark_only_when_every_texel_in_reach_is() {
        let beside = [vec2(5.0, 1.5), vec2(6.0, 1.5), vec2(5.0, 2.5)].map(|t| t / vec2(8.0, 4.0));
        assert!(mean(Wrap::Repeat, beside) < 1e-6);
        let touching = [vec2(4.4, 1.5), vec2(6.0, 1.5), vec2(4.4, 2.5)].map(|t| t / vec2(8.0, 4.0));
        assert!(mean(Wrap::Repeat, touching) > 0.1, "the filter reaches the white half");
    }
}
