"""Checks of window_path.py, gltf_scene.py and gltf_lights.py on scenes made here, against Mitsuba's own parts.

    python check_integrator.py        exit code 0 when all pass, 1 otherwise

Most scenes are a room with a sphere: diffuse, glossy and metal surfaces, an area light. Two renderings are compared by
a z-test over pixels: at most 0.5 % of them may lie beyond 3.3 standard errors (0.1 % are expected), and the mean of the
image within 4. The rest has closed forms.
"""

import math
import pathlib
import sys
import tempfile

import numpy as np

import check_bsdf
import gltf_scene
import render as tool
from glb_writer import GlbWriter
from gltf_materials import srgb_to_linear
from variant import mi

SIZE = (48, 27)


def room(light=True):
    """Floor, back wall, left wall, a glossy sphere; the light faces down."""
    glb = GlbWriter()
    white, red = glb.material(), glb.material((0.7, 0.2, 0.1, 1), 0.5)
    glb.quad(white, (-2, 0, 2), (4, 0, 0), (0, 0, -4))
    glb.quad(red, (-2, 0, -2), (4, 0, 0), (0, 3, 0))
    glb.quad(white, (-2, 0, 2), (0, 0, -4), (0, 3, 0))
    glb.sphere(glb.material((0.9, 0.7, 0.3, 1), 0.3, 1.0), (0.8, 0.6, -0.5), 0.6)
    if light:
        glb.quad(glb.material((0.5, 0.5, 0.5, 1), emission=8.0), (-0.5, 2.9, -0.5), (1, 0, 0), (0, 0, 1))
    glb.camera((0, 1.4, 4), 45)
    return glb


class Checks:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.failures = 0

    def load(self, glb, size=SIZE, **options):
        return gltf_scene.load(glb.write(self.folder / 'scene.glb'), size, **options)

    def verdict(self, name, passed, detail):
        self.failures += not passed
        print(f'{"ok  " if passed else "FAIL"} {name}: {detail}', flush=True)

    def same(self, name, one, other):
        """z-test of two (mean, error) images."""
        spread = np.hypot(one[1], other[1])
        lit = spread > 0
        z = (one[0] - other[0])[lit] / spread[lit]
        apart = float(np.mean(np.abs(z) > 3.3))
        dark = bool(np.all(np.abs((one[0] - other[0])[~lit]) < 1e-6))
        mean = self.mean_z(one, other)
        self.verdict(name, apart <= 0.005 and abs(mean) < 4 and dark and lit.any(),
                     f'{100 * apart:.2f} % beyond 3.3, mean z {mean:.2f}, value {one[0].mean():.4f}')

    def differs(self, name, one, other):
        mean = self.mean_z(one, other)
        self.verdict(name, abs(mean) > 10, f'mean z {mean:.1f}')

    @staticmethod
    def mean_z(one, other):
        """z of the difference of the means; the channels of a pixel share their paths, so their errors add up."""
        spread = np.hypot(one[1], other[1]).sum(axis=2)
        return (one[0] - other[0]).sum() / np.sqrt((spread**2).sum())


def own(loaded, transport, spp=2048, seed=0):
    scene, facts = loaded
    return tool.render(scene, tool.integrator(transport, facts), spp, 32, seed)


def mitsuba_path(loaded, depth, spp=2048, seed=5000):
    how = mi.load_dict({'type': 'path', 'max_depth': depth, 'rr_depth': 1000})
    return tool.render(loaded[0], how, spp, 32, seed)


def add(*images):
    return sum(i[0] for i in images), np.sqrt(sum(i[1]**2 for i in images))


def windows(checks):
    loaded = checks.load(room())
    for bounces in (0, 1, 4):
        checks.same(f'full:{bounces} = path with max_depth {bounces + 2}', own(loaded, f'full:{bounces}'),
                    mitsuba_path(loaded, bounces + 2))
    parts = add(own(loaded, 'emission'), own(loaded, 'direct', seed=100), own(loaded, 'indirect:2', seed=200))
    checks.same('emission + direct + indirect:2 = full:2', parts, own(loaded, 'full:2', seed=300))
    checks.differs('a missing bounce is seen: full:1 against max_depth 4', own(loaded, 'full:1'),
                   mitsuba_path(loaded, 4))


def emitters(checks):
    """gltf_surface against Mitsuba's area light; a double-sided light against two back to back."""
    glb = room()
    glb.json['materials'][-1]['doubleSided'] = True
    double = checks.load(glb)
    glb = room(light=False)
    shine = glb.material((0.5, 0.5, 0.5, 1), emission=8.0)
    glb.quad(shine, (-0.5, 2.9, -0.5), (1, 0, 0), (0, 0, 1))
    glb.quad(shine, (-0.5, 2.9 + 1e-4, -0.5), (0, 0, 1), (1, 0, 0))
    checks.same('double-sided light = two lights back to back', own(double, 'full:2'),
                own(checks.load(glb), 'full:2', seed=50))
    checks.same('double-sided light, by Mitsuba\'s path', own(double, 'full:2'), mitsuba_path(double, 4))
    for double_sided, radiance in ((False, 0.0), (True, 8.0)):
        glb = GlbWriter()
        glb.quad(glb.material(emission=8.0, doubleSided=double_sided), (-5, -5, 0), (0, 10, 0), (10, 0, 0))
        glb.camera((0, 0, 1), 45)
        image = own(checks.load(glb), 'emission', spp=64)[0]
        checks.verdict(f'the back of a light shines {radiance}', np.abs(image - radiance).max() < 1e-5,
                       f'{image.mean()}')


def punctual(checks):
    """gltf_punctual against Mitsuba's point light and against a closed form."""
    intensity, at = 5.0, np.array([0.3, 2.0, 0.2])
    glb = room(light=False)
    glb.light({'type': 'point', 'intensity': intensity}, translation=at.tolist())
    loaded = checks.load(glb)
    checks.same('point light, by Mitsuba\'s path', own(loaded, 'full:2'), mitsuba_path(loaded, 4))
    for name, entry in (('point', {'type': 'point', 'range': 3.0}),
                        ('spot', {'type': 'spot', 'spot': {'innerConeAngle': 0.2, 'outerConeAngle': 0.5}})):
        glb = GlbWriter()
        glb.quad(glb.material(), (-3, -3, 0), (6, 0, 0), (0, 6, 0))
        glb.camera((0, 0, 2), 45)
        s = math.sin(math.radians(10)), math.cos(math.radians(10))
        glb.light({**entry, 'intensity': intensity}, translation=[0.2, 0.1, 2.0], rotation=[s[0], 0, 0, s[1]])
        image = own(checks.load(glb), 'direct', spp=4096)[0][..., 0]
        exact = closed_form(entry, intensity, np.array([0.2, 0.1, 2.0]), math.radians(20))
        inside = (exact > 0.05 * exact.max()) & (image > 0)
        worst = np.max(np.abs(image[inside] / exact[inside] - 1))
        checks.verdict(f'{name} light against its closed form', worst < 0.02 and inside.mean() > 0.05,
                       f'largest difference {100 * worst:.2f} % in {100 * inside.mean():.0f} % of the pixels')


def closed_form(entry, intensity, light, tilt):
    """Radiance of a wall in z = 0 seen from (0, 0, 2): Appendix B, base colour 0.7, roughness 1; 16 points by pixel."""
    half = math.tan(math.radians(22.5)) * 2
    steps = 4
    x = ((np.arange(SIZE[0] * steps) + 0.5) / steps * 2 - SIZE[0]) / SIZE[1] * half
    y = (SIZE[1] - (np.arange(SIZE[1] * steps) + 0.5) / steps * 2) / SIZE[1] * half
    x, y = np.meshgrid(x, y)
    p = np.stack([x, y, np.zeros_like(x)], -1)
    l, v = light - p, np.array([0, 0, 2.0]) - p
    distance = np.linalg.norm(l, axis=-1)
    l, v = l / distance[..., None], v / np.linalg.norm(v, axis=-1, keepdims=True)
    h = l + v
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    f = 0.04 + 0.96 * (1 - (v * h).sum(-1))**5
    value = (1 - f) * 0.7 / np.pi + f * 0.5 / (l[..., 2] + v[..., 2]) / np.pi
    falloff = 1 / distance**2
    if 'range' in entry:
        falloff *= np.clip(1 - (distance / entry['range'])**4, 0, 1)
    if 'spot' in entry:
        # −Z turned by `tilt` about X.
        shining = np.array([0, math.sin(tilt), -math.cos(tilt)])
        cos = -(l @ shining)
        low, high = math.cos(entry['spot']['outerConeAngle']), math.cos(entry['spot']['innerConeAngle'])
        falloff *= np.clip((cos - low) / (high - low), 0, 1)**2
    image = value * l[..., 2] * intensity * falloff
    return image.reshape(SIZE[1], steps, SIZE[0], steps).mean(axis=(1, 3))


def holes(checks):
    """A masked screen against one with a real hole: seen by the camera, by paths and by shadow rays."""
    def scene(build):
        glb = room()
        build(glb)
        return checks.load(glb)

    def masked(glb):
        image = np.full((8, 8, 4), 255, np.uint8)
        image[:, 4:, 3] = 0
        glb.texture(image)
        screen = glb.material(alphaMode='MASK')
        glb.json['materials'][screen]['pbrMetallicRoughness'] |= {'baseColorTexture': {'index': 0}}
        glb.json['materials'][screen]['pbrMetallicRoughness']['baseColorFactor'] = [0.5, 0.5, 0.5, 1]
        glb.quad(screen, (-1.5, 1.5, 0.8), (3, 0, 0), (0, 0, -2))

    def cut(glb):
        glb.quad(glb.material((0.5, 0.5, 0.5, 1)), (-1.5, 1.5, 0.8), (1.5, 0, 0), (0, 0, -2))

    one, other = scene(masked), scene(cut)
    for transport in ('direct', 'full:3'):
        checks.same(f'alpha mask = real hole, {transport}', own(one, transport), own(other, transport, seed=50))

    def blend(glb):
        glb.quad(glb.material((0, 0, 0, 0.25), 1.0, alphaMode='BLEND'), (-3, -1, 3), (6, 0, 0), (0, 6, 0))

    clear, veiled = scene(lambda glb: None), scene(blend)
    image = own(veiled, 'full:0', spp=4096)
    # The veil is a dielectric with black base: its own highlight adds light, so compare where it sees none (emission).
    through, direct = own(veiled, 'emission', spp=8192), own(clear, 'emission', spp=2048)
    expected = 0.75 * direct[0], 0.75 * direct[1]
    checks.same('a veil of coverage 0.25 keeps 0.75', through, expected)
    checks.verdict('full:0 holds the emission', image[0].sum() > through[0].sum(), f'{image[0].mean():.4f}')


def textures(checks):
    """An emissive picture fills the film exactly: which way is up, sRGB, factors."""
    rgba = np.zeros((27, 48, 4), np.uint8)
    rgba[..., 3] = 255
    rgba[:9, :, 0], rgba[:, :16, 1], rgba[-3:, -3:, 2] = 200, 120, 255
    glb = GlbWriter()
    glb.texture(rgba)
    shine = glb.material((0, 0, 0, 1), emission=3.0, emissiveTexture={'index': 0})
    half = math.tan(math.radians(22.5))
    glb.quad(shine, (-half * 48 / 27, -half, 0), (2 * half * 48 / 27, 0, 0), (0, 2 * half, 0))
    glb.camera((0, 0, 1), 45)
    image = own(checks.load(glb), 'emission', spp=64)[0]
    worst = np.max(np.abs(image - 3 * srgb_to_linear(rgba[..., :3] / 255)))
    checks.verdict('emissive picture', worst < 1e-3, f'largest difference {worst:.1e}')


def texture_transform(checks):
    """The example of KHR_texture_transform: "the lower left quadrant of the source image, rotated clockwise 90°"."""
    rgba = np.random.default_rng(1).integers(0, 256, (8, 8, 4), np.uint8)
    rgba[..., 3] = 255
    transform = {'offset': [0, 1], 'rotation': math.pi / 2, 'scale': [0.5, 0.5]}
    glb = GlbWriter()
    glb.texture(rgba)
    shine = glb.material((0, 0, 0, 1), emission=1.0, emissiveTexture={
        'index': 0, 'extensions': {'KHR_texture_transform': transform}})
    half = math.tan(math.radians(22.5))
    glb.quad(shine, (-half, -half, 0), (2 * half, 0, 0), (0, 2 * half, 0))
    glb.camera((0, 0, 1), 45)
    image = own(checks.load(glb, size=(4, 4)), 'emission', spp=64)[0]
    expected = srgb_to_linear(np.rot90(rgba[4:, :4, :3], -1) / 255)
    worst = np.max(np.abs(image - expected))
    checks.verdict('texture transform', worst < 1e-3, f'largest difference {worst:.1e}')


def lit_wall(checks, build, base=(0.6, 0.5, 0.4, 1)):
    """`build` adds a mesh of the given material; one point light, seen from the front."""
    glb = GlbWriter()
    corners = np.array([[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]])
    build(glb, glb.material(base, 0.4, 0.3), corners, [0, 1, 2, 0, 2, 3], [[0, 1], [1, 1], [1, 0], [0, 0]])
    glb.light({'type': 'point', 'intensity': 5.0}, translation=[0.5, 1.0, 2.0])
    glb.camera((0, 0, 2), 45)
    return own(checks.load(glb), 'direct', spp=4096)[0]


def vertex_attributes(checks):
    """Constant attributes against the same thing said otherwise: normal maps as tilted normals, colours as factors."""
    texel = np.array([160, 90, 220], np.uint8)
    x, y, z = texel / 255 * 2 - 1

    def bumpy(**more):
        def build(glb, material, corners, indices, uvs):
            glb.texture(np.tile(np.append(texel, 255).astype(np.uint8), (4, 4, 1)))
            glb.json['materials'][material]['normalTexture'] = {'index': 0}
            glb.mesh(material, corners, indices, np.tile([0, 0, 1], (4, 1)), uvs, **more)
        return build

    def tilted(normal):
        return lambda glb, material, corners, indices, uvs: glb.mesh(
            material, corners, indices, np.tile(normal / np.linalg.norm(normal), (4, 1)), uvs)

    def colored(glb, material, corners, indices, uvs):
        glb.mesh(material, corners, indices, colors=np.tile([0.5, 0.8, 1.0], (4, 1)))

    def plain(glb, material, corners, indices, uvs):
        glb.mesh(material, corners, indices)

    cases = [('normal map along u and −v', bumpy(), (x, y, z)),
             ('normal map, tangent +y, right-handed', bumpy(tangents=np.tile([0, 1, 0, 1], (4, 1))), (-y, x, z)),
             ('normal map, tangent +y, left-handed', bumpy(tangents=np.tile([0, 1, 0, -1], (4, 1))), (y, x, z))]
    for name, build, normal in cases:
        worst = np.max(np.abs(lit_wall(checks, build) / lit_wall(checks, tilted(normal)) - 1))
        checks.verdict(name, worst < 1e-3, f'largest difference {worst:.1e}')
    worst = np.max(np.abs(lit_wall(checks, colored) / lit_wall(checks, plain, (0.3, 0.4, 0.4, 1)) - 1))
    checks.verdict('vertex colours', worst < 1e-3, f'largest difference {worst:.1e}')


def mirrored(checks):
    """A mirroring node keeps the front in front."""
    for scale, radiance in (((-1, 1, 1), 8.0), ((1, 1, -1), 0.0)):
        glb = GlbWriter()
        glb.quad(glb.material(emission=8.0), (-5, -5, 0), (10, 0, 0), (0, 10, 0), scale=list(scale))
        glb.camera((0, 0, 1), 45)
        image = own(checks.load(glb), 'emission', spp=64)[0]
        checks.verdict(f'scale {scale} shines {radiance}', np.abs(image - radiance).max() < 1e-5, f'{image.mean()}')


def unlit(checks):
    """An unlit card shows its base colour under any light, and is a black body to the rest of the room."""
    def scene(material):
        glb = room()
        glb.quad(glb.material(*material[0], **material[1]), (-1.5, 0.5, 0.8), (1, 0, 0), (0, 1, 0))
        return checks.load(glb)

    card = scene((((0.2, 0.4, 0.6, 1),), {'extensions': {'KHR_materials_unlit': {}}}))
    nothing = {'KHR_materials_specular': {'specularFactor': 0.0}}
    black = scene((((0, 0, 0, 1),), {'extensions': nothing}))
    checks.same('an unlit card lights nothing', own(card, 'direct'), own(black, 'direct', seed=50))
    mask = own(black, 'emission', spp=64)[0].sum(axis=2) == 0
    shown = own(card, 'emission', spp=64)[0]
    exact = np.isclose(shown, [0.2, 0.4, 0.6], atol=1e-6).all(axis=2) & mask
    checks.verdict('an unlit card shows its base colour', exact.sum() > 40, f'in {exact.sum()} pixels')


def environment(checks):
    """A constant sky is a furnace; a sky with one bright texel shines from where the convention says."""
    glb = GlbWriter()
    glb.quad(glb.material((1, 1, 1, 1), 1.0, 1.0), (-50, -50, 0), (100, 0, 0), (0, 100, 0))
    glb.camera((0, 0, 2), 45)
    sky = np.ones((16, 32, 3), np.float32)
    mi.Bitmap(sky).write(str(checks.folder / 'sky.exr'))
    image = own(checks.load(glb, environment=checks.folder / 'sky.exr'), 'direct')
    centre = image[0][12:15, 22:26].mean()
    exact = check_bsdf.albedo_quadrature(1.0, 1.0, 1.0, (1.0, 1.0, 1.0))[0]
    checks.verdict('a white sky shows the albedo', abs(centre / exact - 1) < 0.01, f'{centre:.4f}, exact {exact:.4f}')

    # A view down −Z sees u = 0.5, up at v = 0; x grows with u. Bilinear between texel centres.
    sky[:] = np.random.default_rng(2).random((16, 32, 1)) + 0.5
    mi.Bitmap(sky).write(str(checks.folder / 'sky.exr'))
    glb = GlbWriter()
    glb.quad(glb.material(), (-1, -1, 50), (2, 0, 0), (0, 2, 0))
    glb.camera((0, 0, 0), 80)
    image = own(checks.load(glb, environment=checks.folder / 'sky.exr'), 'emission', spp=4096)[0][..., 0]
    half, steps = math.tan(math.radians(40)), 8
    x = ((np.arange(SIZE[0] * steps) + 0.5) / steps * 2 - SIZE[0]) / SIZE[1] * half
    y = (SIZE[1] - (np.arange(SIZE[1] * steps) + 0.5) / steps * 2) / SIZE[1] * half
    x, y = np.meshgrid(x, y)
    u = (0.5 + np.arctan2(x, 1) / (2 * math.pi)) * 32 - 0.5
    v = np.arccos(y / np.sqrt(x * x + y * y + 1)) / math.pi * 16 - 0.5
    left, top = np.floor(u).astype(int), np.floor(v).astype(int)
    du, dv = u - left, v - top
    texel = sky[..., 0].astype(np.float64)
    exact = (texel[top, left] * (1 - du) + texel[top, left + 1] * du) * (1 - dv)
    exact += (texel[top + 1, left] * (1 - du) + texel[top + 1, left + 1] * du) * dv
    exact = exact.reshape(SIZE[1], steps, SIZE[0], steps).mean(axis=(1, 3))
    worst = np.max(np.abs(image / exact - 1))
    checks.verdict('the sky is where the convention says', worst < 0.01, f'largest difference {100 * worst:.2f} %')


def main():
    tool.register()
    with tempfile.TemporaryDirectory() as folder:
        checks = Checks(folder)
        for check in (windows, emitters, punctual, holes, textures, texture_transform, vertex_attributes,
                  mirrored, unlit, environment):
            check(checks)
    print(f'{checks.failures} failed' if checks.failures else 'all passed')
    return 1 if checks.failures else 0


if __name__ == '__main__':
    sys.exit(main())
