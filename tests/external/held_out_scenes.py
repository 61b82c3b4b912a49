"""Small scenes of what glTF allows and the built-in scenes do not show: each a function that fills a GlbWriter.

    python held_out_scenes.py FOLDER [SCENE …]        writes them as .glb files

`ALL` names them; a function's head says what it tries. Where a scene has an environment, the function returns its texels.
"""

import math
import pathlib
import sys

import numpy as np

from glb_writer import GlbWriter

LINEAR, REPEAT, MIRROR, CLAMP = 9729, 10497, 33648, 33071


def turn(axis, degrees):
    """Quaternion of a rotation about x, y or z."""
    half = math.radians(degrees) / 2
    return [math.sin(half) * (axis == name) for name in 'xyz'] + [math.cos(half)]


def floor_and_wall(glb, light=True):
    """A grey floor and back wall; a broad lamp above, facing down."""
    grey = glb.material((0.6, 0.6, 0.6, 1))
    glb.quad(grey, (-3, 0, 3), (6, 0, 0), (0, 0, -6))
    glb.quad(grey, (-3, 0, -2), (6, 0, 0), (0, 4, 0))
    if light:
        glb.quad(glb.material((0, 0, 0, 1), emission=4.0), (-1, 3.5, -1), (2, 0, 0), (0, 0, 2))


def noise(seed, size=16, low=0, high=256):
    image = np.random.default_rng(seed).integers(low, high, (size, size, 4)).astype(np.uint8)
    image[..., 3] = 255
    return image


def mirrored(glb):
    """non-uniform scales, some mirroring, nested with rotations; a lamp under a mirroring node"""
    floor_and_wall(glb, light=False)
    gold = glb.material((0.9, 0.6, 0.2, 1), 0.35, 1.0)

    def shapes():
        glb.sphere(gold, (0, 0, 0), 0.5, 24)
        glb.mesh(glb.material((0.3, 0.5, 0.8, 1), 0.4), [[1, 0, 0], [2, 0, 0], [1, 1, 0.4]], [0, 1, 2], [[0, 0.6, 0.8], [0.6, 0, 0.8], [0, 0, 1]])

    glb.group(lambda: glb.group(shapes, scale=[1.8, 0.6, -0.9], rotation=turn('x', 25)), rotation=turn('z', 35), scale=[0.8, 1.5, 1],
              translation=[-0.6, 0.9, -0.5])
    lamp = glb.material((0, 0, 0, 1), emission=4.0)
    glb.group(lambda: glb.quad(lamp, (-1, -3.5, -1), (0, 0, 2), (2, 0, 0)), scale=[1, -1, 1])
    glb.camera((0, 1.4, 4), 45)


def metals(glb):
    """metallic-roughness textures on spheres, filtered, factors below 1, a scaled normal map"""
    floor_and_wall(glb)
    for place, (roughness, metallic) in enumerate(((1.0, 1.0), (0.5, 1.0), (1.0, 0.6))):
        material = glb.material((0.9, 0.8, 0.6, 1), roughness, metallic)
        image = glb.texture(noise(place, low=60), LINEAR, (REPEAT, MIRROR, CLAMP)[place])
        glb.json['materials'][material]['pbrMetallicRoughness']['metallicRoughnessTexture'] = {
            'index': image, 'extensions': {'KHR_texture_transform': {'scale': [2.5, 1.5], 'offset': [0.3, -0.2]}}}
        glb.sphere(material, (1.3 * place - 1.3, 0.6, -0.3), 0.55)
    bumps = noise(7, 32, 90, 166)
    bumps[..., 2] = 230
    plate = glb.material((0.7, 0.3, 0.2, 1), 0.5, 0.5, normalTexture={'index': glb.texture(bumps, LINEAR), 'scale': 0.7})
    glb.quad(plate, (-1.5, 0.01, 1.9), (3, 0, 0), (0, 0, -1.2))
    glb.camera((0, 1.4, 4), 45)


def signs(glb):
    """emissive textures with transforms, on tilted, two-sided and curved lamps that also reflect"""
    floor_and_wall(glb, light=False)
    image = glb.texture(noise(3, 8), LINEAR)
    use = {'index': image, 'extensions': {'KHR_texture_transform': {'rotation': 0.6, 'scale': [1.5, 0.7], 'offset': [0.2, 0.4]}}}
    board = glb.material((0.5, 0.5, 0.5, 1), 0.4, emission=6.0, emissiveFactor=[1, 0.7, 0.4], emissiveTexture=use, doubleSided=True)
    glb.quad(board, (-1.6, 0.7, -1), (1.2, 0.4, 0.3), (-0.2, 1.1, 0.5))
    ball = glb.material((0.1, 0.1, 0.1, 1), 0.3, emission=3.0, emissiveFactor=[0.4, 0.8, 1], emissiveTexture={'index': image})
    glb.sphere(ball, (1.0, 0.8, -0.4), 0.5)
    glb.camera((0, 1.4, 4), 45)


def spots(glb):
    """spot lights of several cones, one with a range, one under a scaled and turned node, none but them"""
    floor_and_wall(glb, light=False)
    glb.sphere(glb.material((0.8, 0.8, 0.8, 1), 0.3, 0.2), (0, 0.6, -0.4), 0.6, 24)
    for x, inner, outer, more in ((-1.5, 0.0, 0.7, {}), (0.0, 0.45, 0.5, {'range': 3.5}), (1.6, 0.3, 1.2, {})):
        light = {'type': 'spot', 'color': [1, 0.8 - 0.2 * x / 2, 0.6], 'intensity': 12.0, 'spot': {'innerConeAngle': inner, 'outerConeAngle': outer}}
        glb.light(light | more, translation=[x, 3, 0.5], rotation=turn('x', -70))
    glb.group(lambda: glb.light({'type': 'spot', 'spot': {}, 'intensity': 20.0, 'color': [0.3, 0.5, 1.0]}, translation=[0.4, 0.5, 0.2]),
              scale=[2, 0.5, 3], rotation=turn('y', 60), translation=[2, 1, 0])
    glb.camera((0, 1.4, 4), 45)


def lamps(glb):
    """the kinds of punctual light, each in a channel of its own: directional red, point green, spot blue"""
    floor_and_wall(glb, light=False)
    block = glb.material((0.7, 0.7, 0.7, 1), 0.5)
    for corner, u, v in (((-0.4, 0, 0.4), (0.8, 0, 0), (0, 0.9, 0)), ((-0.4, 0.9, 0.4), (0.8, 0, 0), (0, 0, -0.8)), ((0.4, 0, 0.4), (0, 0, -0.8), (0, 0.9, 0)),
                         ((-0.4, 0, -0.4), (0, 0, 0.8), (0, 0.9, 0))):
        glb.quad(block, corner, u, v)

    def lights():
        glb.light({'type': 'directional', 'intensity': 2.5, 'color': [1, 0, 0]}, rotation=turn('x', -40))
        glb.light({'type': 'point', 'intensity': 7.0, 'color': [0, 1, 0], 'range': 9.0}, translation=[-1.2, 1.4, 1.1])
        spot = {'innerConeAngle': 0.25, 'outerConeAngle': 0.6}
        glb.light({'type': 'spot', 'intensity': 30.0, 'color': [0, 0, 1], 'spot': spot}, translation=[1.5, 2.4, 2.0], rotation=turn('x', -35))

    glb.group(lights, rotation=turn('y', 25), scale=[1.1, 0.9, 1.3])
    glb.camera((0, 1.4, 4), 45)


def veils(glb):
    """overlapping blend and mask, their opacity from textures, factors and vertices; vertex colours; a lamp behind a veil"""
    floor_and_wall(glb)
    grid = noise(5, 8, 100)
    grid[..., 3] = np.random.default_rng(6).integers(0, 256, (8, 8))
    image = glb.texture(grid, LINEAR)
    for number, (mode, cutoff) in enumerate((('BLEND', None), ('MASK', 0.4), ('BLEND', None))):
        more = {'alphaCutoff': cutoff} if cutoff else {}
        veil = glb.material((0.8, 0.9, 0.7, 0.8), 0.5, 0.0, alphaMode=mode, doubleSided=number == 2, **more)
        glb.json['materials'][veil]['pbrMetallicRoughness']['baseColorTexture'] = {'index': image}
        glb.quad(veil, (-1.5 + 0.4 * number, 0.2 + 0.3 * number, 0.8 - 0.5 * number), (1.8, 0, 0.2), (0, 1.6, 0))
    glb.quad(glb.material((0.2, 0.1, 0.4, 0.3), 0.3, alphaMode='BLEND'), (-1.2, 3, -1.2), (0, 0, 2.4), (2.4, 0, 0))
    for x, mode in ((0.2, 'MASK'), (1.3, 'BLEND')):
        card = glb.material((1, 0.9, 0.8, 0.9), 0.6, alphaMode=mode)
        colors = np.random.default_rng(8).random((4, 4))
        glb.mesh(card, [[x, 0, 0], [x + 0.9, 0, 0], [x + 0.9, 1.5, -1], [x, 1.5, -1]], [0, 1, 2, 0, 2, 3], colors=colors)
    glb.camera((0, 1.4, 4), 45)


def dielectrics(glb):
    """index of refraction from 1 to 2.4, specular factors and colours, roughness down to 0.05"""
    floor_and_wall(glb)
    rows = (({'KHR_materials_ior': {'ior': 1.0}}, 0.2), ({'KHR_materials_ior': {'ior': 2.4}}, 0.05),
            ({'KHR_materials_specular': {'specularFactor': 0.3}}, 0.2),
            ({'KHR_materials_specular': {'specularColorFactor': [1, 0.5, 0.1]}, 'KHR_materials_ior': {'ior': 1.9}}, 0.3),
            ({'KHR_materials_specular': {'specularColorFactor': [4, 3, 2], 'specularFactor': 0.9}}, 0.4))
    for place, (extensions, roughness) in enumerate(rows):
        glb.sphere(glb.material((0.25, 0.3, 0.4, 1), roughness, extensions=extensions), (0.8 * place - 1.6, 0.4, 0.2 - 0.5 * (place % 2)), 0.38, 32)
    glb.camera((0, 1.4, 4), 45)


def hierarchy(glb):
    """camera, lamp and meshes deep inside scaled and turned nodes; one mesh in two places; matrices beside TRS"""
    floor_and_wall(glb, light=False)
    red = glb.material((0.7, 0.2, 0.1, 1), 0.4, 0.3)
    glb.sphere(red, (0, 0, 0), 0.5, 16)
    mesh = len(glb.json['meshes']) - 1
    glb.json['scenes'][0]['nodes'].pop()
    c, s = math.cos(0.7), math.sin(0.7)
    matrix = np.array([[1.2 * c, 0, -0.5 * s, -1.0], [0, -0.8, 0, 0.7], [1.2 * s, 0, 0.5 * c, 0], [0, 0, 0, 1]])
    glb.node(mesh=mesh, matrix=matrix.T.ravel().tolist())

    def inside():
        glb.node(mesh=mesh, translation=[0.5, 0.3, -0.6], scale=[1.5, 1.5, 0.5])
        glb.quad(glb.material((0, 0, 0, 1), emission=5.0), (-1, 2.4, -1), (1.5, 0, 0), (0, 0, 1.5))
        glb.light({'type': 'point', 'intensity': 4.0, 'color': [0.4, 1, 0.6]}, translation=[-1, 1, 1])
        glb.camera((0.2, 0.8, 2.8), 50)

    glb.group(lambda: glb.group(inside, rotation=turn('y', 20), scale=[1.3, 1.3, 1.3]), rotation=turn('x', -6), translation=[0, 0.4, 0])


def sky(glb):
    """an environment with a small sun, together with a directional light, a point light and a lamp"""
    grey = glb.material((0.5, 0.5, 0.5, 1), 0.7)
    glb.quad(grey, (-3, 0, 3), (6, 0, 0), (0, 0, -6))
    glb.sphere(glb.material((0.9, 0.9, 0.9, 1), 0.2, 1.0), (-0.7, 0.6, -0.5), 0.6, 32)
    glb.sphere(glb.material((0.2, 0.5, 0.3, 1), 0.5), (0.8, 0.5, 0.2), 0.5, 32)
    glb.quad(glb.material((0, 0, 0, 1), emission=3.0), (1.5, 0.2, -1.5), (0, 0, 1.5), (0, 1, 0))
    glb.light({'type': 'directional', 'intensity': 1.5, 'color': [1, 0.9, 0.7]}, rotation=turn('x', -50))
    glb.light({'type': 'point', 'intensity': 3.0}, translation=[0, 2, 1])
    glb.camera((0, 1.4, 4), 45)
    v, u = np.meshgrid(np.arange(32) / 32, np.arange(64) / 64, indexing='ij')
    texels = np.stack([0.3 + 0.5 * v, 0.5 - 0.2 * v, 0.8 - 0.6 * v + 0.2 * np.sin(2 * np.pi * u)], -1)
    texels[8:10, 40:42] = 60.0
    return texels.astype(np.float32)


def smooth(glb):
    """few triangles with smooth normals: shading and geometric normals far apart, also at silhouettes"""
    floor_and_wall(glb)
    for place, (roughness, metallic) in enumerate(((0.2, 1.0), (1.0, 0.0), (0.3, 0.0))):
        glb.sphere(glb.material((0.8, 0.6, 0.4, 1), roughness, metallic), (1.3 * place - 1.3, 0.6, -0.2), 0.6, 4)
    glb.camera((0, 1.4, 4), 45)


def formats(glb):
    """strips, fans, sparse and interleaved accessors, indices of 8 and 16 bits, normalised integers"""
    floor_and_wall(glb)
    checks = glb.texture(noise(9, 8, 40), LINEAR)
    painted = glb.material((1, 1, 1, 1), 0.6)
    glb.json['materials'][painted]['pbrMetallicRoughness']['baseColorTexture'] = {'index': checks}
    packed_strip(glb, painted, translation=[-1.5, 0.3, 0], rotation=turn('y', 20))
    sparse_roof(glb, glb.material((0.3, 0.6, 0.4, 1), 0.4), translation=[0.3, 0.2, 0.2])
    fan(glb, glb.material((0.8, 0.4, 0.3, 1), 0.5, 0.5), translation=[1.5, 0.7, 0], rotation=turn('y', -30))
    glb.camera((0, 1.4, 4), 45)


def packed_strip(glb, material, **node):
    """A wavy strip: 5 corners a side, all attributes in one view, texture coordinates as 16-bit shares, 8-bit indices."""
    corners = [(i, j) for i in range(5) for j in (0, 1)]
    vertex = np.dtype([('position', '<f4', 3), ('normal', '<f4', 3), ('uv', '<u2', 2)])
    data = np.zeros(len(corners), vertex)
    for row, (i, j) in zip(data, corners):
        slope = (-1)**i * 0.3
        row['position'], row['normal'], row['uv'] = (0.3 * i, j, 0.1 * (i % 2)), unit(slope, 0, 1), (i * 16383, j * 65535)
    view = glb.view(data.tobytes())
    glb.json['bufferViews'][view]['byteStride'] = vertex.itemsize
    for offset, component, kind, more in ((0, 5126, 'VEC3', {}), (12, 5126, 'VEC3', {}), (24, 5123, 'VEC2', {'normalized': True})):
        glb.json['accessors'].append({'bufferView': view, 'byteOffset': offset, 'componentType': component, 'count': len(data), 'type': kind, **more})
    first = len(glb.json['accessors']) - 3
    glb.json['accessors'][first] |= {'min': data['position'].min(0).tolist(), 'max': data['position'].max(0).tolist()}
    indices = glb.raw_accessor(np.arange(len(data), dtype=np.uint8), 5121, 'SCALAR')
    primitive = {'attributes': {'POSITION': first, 'NORMAL': first + 1, 'TEXCOORD_0': first + 2}, 'indices': indices, 'material': material, 'mode': 5}
    glb.add_mesh(primitive, **node)


def sparse_roof(glb, material, **node):
    """A square whose middle row a sparse accessor lifts."""
    flat = np.array([[x, 0, -z] for z in (0, 0.5, 1) for x in (0, 0.5, 1)], np.float32)
    positions = glb.accessor(flat, 'VEC3')
    at, lifted = np.array([3, 4, 5], np.uint16), flat[3:6] + np.array([0, 0.7, 0], np.float32)
    glb.json['accessors'][positions]['max'][1] = float(lifted[:, 1].max())
    glb.json['accessors'][positions]['sparse'] = {'count': 3, 'indices': {'bufferView': glb.view(at.tobytes()), 'componentType': 5123},
                                                  'values': {'bufferView': glb.view(lifted.tobytes())}}
    quads = [(k, k + 1, k + 4, k, k + 4, k + 3) for k in (0, 1, 3, 4)]
    indices = glb.raw_accessor(np.ravel(quads).astype(np.uint16), 5123, 'SCALAR')
    glb.add_mesh({'attributes': {'POSITION': positions}, 'indices': indices, 'material': material}, **node)


def fan(glb, material, **node):
    """A shallow cone of seven triangles, without indices."""
    rim = [[0.6 * math.cos(a), 0.6 * math.sin(a), 0] for a in np.linspace(0, 2 * math.pi, 8)]
    glb.add_mesh({'attributes': {'POSITION': glb.accessor([[0, 0, 0.3], *rim], 'VEC3')}, 'material': material, 'mode': 6}, **node)


def unit(*vector):
    return np.array(vector) / np.linalg.norm(vector)


def large(glb):
    """thirty times the size, and off the origin"""
    glb.group(lambda: (floor_and_wall(glb), glb.sphere(glb.material((0.4, 0.5, 0.7, 1), 0.3), (0, 0.6, -0.4), 0.6, 24),
                       glb.camera((0, 1.4, 4), 45)), scale=[30, 30, 30], translation=[200, 0, -100])


def unlit(glb):
    """unlit cards, painted and cut out, between lit things"""
    floor_and_wall(glb)
    image = noise(11, 8, 60)
    image[:, 4:, 3] = 40
    card = glb.material((0.9, 0.8, 0.7, 1), alphaMode='MASK', extensions={'KHR_materials_unlit': {}})
    glb.json['materials'][card]['pbrMetallicRoughness']['baseColorTexture'] = {'index': glb.texture(image)}
    glb.quad(card, (-1.4, 0.3, 0.5), (1.4, 0, 0), (0, 1.2, 0.2))
    glb.sphere(glb.material((0.9, 0.9, 0.9, 1), 0.15, 1.0), (0.9, 0.6, -0.2), 0.6, 24)
    glb.camera((0, 1.4, 4), 45)


ALL = (mirrored, metals, signs, spots, lamps, veils, dielectrics, hierarchy, sky, smooth, formats, large, unlit)


def build(scene):
    """(GlbWriter, texels of the environment or None)."""
    glb = GlbWriter()
    return glb, scene(glb)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for scene in ALL:
        if scene.__name__ in (sys.argv[2:] or [scene.__name__]):
            build(scene)[0].write(folder / f'{scene.__name__}.glb')


if __name__ == '__main__':
    main()
