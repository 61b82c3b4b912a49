//! The few surfaces that most scenes need.

use aquifer_scene::Material;
use glam::Vec3;

/// Purely diffuse: KHR_materials_specular takes the dielectric's 4 % reflection away, so that closed forms hold exactly.
pub fn matte(name: &str, color: [f32; 3]) -> Material {
    Material { specular: 0.0, ..plastic(name, color, 1.0) }
}

/// A dielectric of index 1.5 over a diffuse base: plastic, paint, varnished wood, stone.
pub fn plastic(name: &str, color: [f32; 3], roughness: f32) -> Material {
    let base_color = Vec3::from(color).extend(1.0);
    Material { name: name.into(), base_color, metallic: 0.0, roughness, ..Material::default() }
}

/// A metal; `color` is its reflectance at normal incidence.
pub fn metal(name: &str, color: [f32; 3], roughness: f32) -> Material {
    Material { metallic: 1.0, ..plastic(name, color, roughness) }
}

/// A lamp: emits `radiance` (W·m⁻²·sr⁻¹) from its front faces and reflects nothing.
pub fn glow(name: &str, radiance: [f32; 3]) -> Material {
    Material { emission: radiance.into(), ..matte(name, [0.0; 3]) }
}
