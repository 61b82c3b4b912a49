"""Materials and textures of glTF as Mitsuba plugins: `gltf_pbr`, `gltf_unlit`, `area`, `gltf_surface`."""

import io
import math

import numpy as np
import PIL.Image

from blocks import LUMINANCE
from gltf_file import Unsupported
from variant import mi

WRAP = {10497: 'repeat', 33071: 'clamp', 33648: 'mirror'}
NEAREST = {9728, 9984, 9986}


class Materials:
    """Turns materials into `gltf_pbr` and `gltf_surface` plugins."""

    def __init__(self, file):
        self.file = file
        self.pixels = {}

    def material(self, index):
        return {} if index is None else self.file.get('materials', index)

    def unlit(self, index):
        return 'KHR_materials_unlit' in self.material(index).get('extensions', {})

    def bsdf(self, index, surface):
        material = self.material(index)
        self.choose_uvs(index, surface)
        pbr = material.get('pbrMetallicRoughness', {})
        base = np.array(pbr.get('baseColorFactor', [1, 1, 1, 1]), np.float64)
        plugin = {'type': 'gltf_unlit' if self.unlit(index) else 'gltf_pbr', 'vertex_color': 'COLOR_0' in surface}
        painted = self.texture(pbr.get('baseColorTexture'), lambda t: srgb_to_linear(t[..., :3]) * base[:3])
        plugin['base_color'] = painted or {'type': 'rgb', 'value': base[:3].tolist()}
        packed = pbr.get('metallicRoughnessTexture')
        roughness, metallic = pbr.get('roughnessFactor', 1.0), pbr.get('metallicFactor', 1.0)
        plugin['roughness'] = self.texture(packed, lambda t: t[..., 1:2] * roughness) or float(roughness)
        plugin['metallic'] = self.texture(packed, lambda t: t[..., 2:3] * metallic) or float(metallic)
        if 'normalTexture' in material:
            plugin['normal_map'] = self.texture(material['normalTexture'], lambda t: t[..., :3])
            plugin['vertex_tangent'] = 'TANGENT' in surface
            plugin['normal_scale'] = float(material['normalTexture'].get('scale', 1.0))
        opacity = self.opacity(index)
        if opacity is not None:
            plugin['opacity'], plugin['cutoff'] = opacity
        extensions = material.get('extensions', {})
        plugin['ior'] = float(extensions.get('KHR_materials_ior', {}).get('ior', 1.5))
        specular = extensions.get('KHR_materials_specular', {})
        if 'specularTexture' in specular or 'specularColorTexture' in specular:
            raise Unsupported(f'/materials/{index}/extensions/KHR_materials_specular: textures')
        plugin['specular'] = float(specular.get('specularFactor', 1.0))
        plugin['specular_color'] = mi.ScalarColor3f(specular.get('specularColorFactor', [1.0, 1.0, 1.0]))
        return plugin

    def opacity(self, index):
        """(texture or number, cutoff); None where the surface is whole. Cutoff −1 stands for BLEND."""
        material = self.material(index)
        mode = material.get('alphaMode', 'OPAQUE')
        if mode == 'OPAQUE':
            return None
        pbr = material.get('pbrMetallicRoughness', {})
        factor = pbr.get('baseColorFactor', [1, 1, 1, 1])[3]
        value = self.texture(pbr.get('baseColorTexture'), lambda t: t[..., 3:4] * factor) or float(factor)
        return value, float(material.get('alphaCutoff', 0.5)) if mode == 'MASK' else -1.0

    def light(self, index, surface):
        """The emitter of a material, or None."""
        material = self.material(index)
        strength = material.get('extensions', {}).get('KHR_materials_emissive_strength', {})
        strength = strength.get('emissiveStrength', 1.0)
        radiance = np.array(material.get('emissiveFactor', [0, 0, 0]), np.float64) * strength
        if not radiance.any() or self.unlit(index):
            return None
        self.choose_uvs(index, surface)
        a, b, c = surface['positions'].reshape(-1, 3, 3).transpose(1, 0, 2)
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        double_sided = material.get('doubleSided', False)
        texture = self.texture(material.get('emissiveTexture'), lambda t: srgb_to_linear(t[..., :3]) * radiance)
        power = math.pi * area * (LUMINANCE @ radiance) * (2 if double_sided else 1)
        if texture is None and not double_sided:
            return {'type': 'area', 'radiance': {'type': 'rgb', 'value': radiance.tolist()}, 'power': power}
        return {'type': 'gltf_surface', 'double_sided': double_sided, 'power': power,
                'radiance': texture or {'type': 'rgb', 'value': radiance.tolist()}}

    def references(self, index):
        """All uses of textures in a material."""
        material = self.material(index)
        pbr = material.get('pbrMetallicRoughness', {})
        uses = [pbr.get('baseColorTexture'), pbr.get('metallicRoughnessTexture'), material.get('normalTexture'),
                material.get('emissiveTexture')]
        return [use for use in uses if use]

    def choose_uvs(self, index, surface):
        """Mitsuba's meshes hold one set of coordinates."""
        sets = {self.transform(use)[0] for use in self.references(index)}
        if len(sets) > 1:
            raise Unsupported(f'/materials/{index}: two sets of texture coordinates')
        if sets:
            name = f'TEXCOORD_{sets.pop()}'
            surface['uvs'] = surface.get(name, np.zeros((len(surface['positions']), 2)))

    def transform(self, use):
        """(uv set, matrix) of one use: KHR_texture_transform, translation · rotation · scale.

        The extension turns counter-clockwise as seen on the image, whose v grows downwards."""
        extension = use.get('extensions', {}).get('KHR_texture_transform', {})
        angle = extension.get('rotation', 0.0)
        c, s = math.cos(angle), math.sin(angle)
        matrix = np.eye(3)
        matrix[:2, :2] = np.array([[c, s], [-s, c]]) * np.array(extension.get('scale', [1.0, 1.0]))
        matrix[:2, 2] = extension.get('offset', [0.0, 0.0])
        return extension.get('texCoord', use.get('texCoord', 0)), matrix

    def texture(self, use, channels):
        """A bitmap plugin of linear floats, or None; `channels` maps stored RGBA in [0, 1] to what is wanted."""
        if use is None:
            return None
        texture = self.file.get('textures', use['index'])
        sampler = self.file.get('samplers', texture['sampler']) if 'sampler' in texture else {}
        wrap = {WRAP[sampler.get(key, 10497)] for key in ('wrapS', 'wrapT')}
        if len(wrap) > 1:
            raise Unsupported('a sampler that wraps differently in u and v')
        pixels = np.ascontiguousarray(channels(self.image(texture['source'])).astype(np.float32))
        return {'type': 'bitmap', 'data': mi.TensorXf(pixels), 'raw': True, 'wrap_mode': wrap.pop(),
                'filter_type': 'nearest' if sampler.get('magFilter', 9729) in NEAREST else 'bilinear',
                'to_uv': mi.ScalarTransform3f(self.transform(use)[1])}

    def image(self, index):
        if index not in self.pixels:
            self.pixels[index] = decode_image(self.file.image_bytes(index))
        return self.pixels[index]


def decode_image(data):
    """PNG or JPEG to RGBA in [0, 1], as stored."""
    image = PIL.Image.open(io.BytesIO(data))
    if image.mode in ('I;16', 'I'):
        grey = np.asarray(image, np.float64)[..., None] / 65535
        return np.concatenate([grey, grey, grey, np.ones_like(grey)], axis=2)
    return np.asarray(image.convert('RGBA'), np.float64) / 255


def srgb_to_linear(encoded):
    """IEC 61966-2-1."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055)**2.4)


def linear_to_srgb(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308)**(1 / 2.4) - 0.055)
