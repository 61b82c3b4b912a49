"""A glTF 2.0 file as a Mitsuba scene.

Conventions
- Rays see both sides of every surface; the frame of reflection is turned to the viewer. Only emission asks for the
  side: it leaves the front (counter-clockwise) side, and both sides of a double-sided material.
- emissiveFactor × KHR_materials_emissive_strength is radiance; KHR_lights_punctual as in gltf_lights.py.
- A camera looks down −Z of its node, +Y up; scale in the node is ignored; yfov holds for the height of the film,
  whatever the camera's aspectRatio.
- Primitives without normals are flat. A mirroring node swaps the winding, as section 3.7.4 asks.
- Opacity: MASK is thresholded after filtering, BLEND is coverage.
- An environment map is a file beside the glTF (`environment=`): equirectangular, u = 0.5 + atan2(x, −z) / 2π,
  v = acos(y) / π, bilinear between texel centres.
Not converted, with an error: two UV sets in one material, different wrapping in u and v, textures of
KHR_materials_specular, other extensionsRequired. Skins, morph targets and animation are left in the rest pose, with a
warning.
"""

import math
import sys

import numpy as np

from blocks import LUMINANCE
from gltf_file import GltfFile, Unsupported
from gltf_materials import Materials
from variant import mi

KNOWN_EXTENSIONS = {'KHR_lights_punctual', 'KHR_materials_emissive_strength', 'KHR_materials_ior',
                    'KHR_materials_specular', 'KHR_materials_unlit', 'KHR_texture_transform'}


def load(path, size, camera=None, environment=None):
    """Returns (Mitsuba scene, what the integrator has to know of it)."""
    file = GltfFile(path)
    check_extensions(file)
    nodes = list(file.nodes())
    surfaces = gather_surfaces(file, nodes)
    scene = {'type': 'scene', 'sensor': sensor(file, nodes, size, camera)}
    materials = Materials(file)
    lights = punctual_lights(file, nodes)
    for index, surface in surfaces.items():
        light = materials.light(index, surface)
        if light:
            lights[f'surface light of material {index}'] = light
    bounds = np.concatenate([s['positions'] for s in surfaces.values()]) if surfaces else np.zeros((1, 3))
    radius = 0.5 * np.linalg.norm(bounds.max(axis=0) - bounds.min(axis=0))
    if environment:
        lights['environment'] = environment_light(environment)
    share_samples(lights, radius)
    facts = {'see_through': False, 'unlit': False}
    for index, surface in surfaces.items():
        facts['see_through'] |= materials.opacity(index) is not None
        facts['unlit'] |= materials.unlit(index)
        light = lights.pop(f'surface light of material {index}', None)
        scene[f'surface_{index}'] = mesh(index, surface, materials.bsdf(index, surface), light)
    for number, light in enumerate(lights.values()):
        scene[f'light_{number}'] = light
    return mi.load_dict(scene), facts


def check_extensions(file):
    unknown = set(file.json.get('extensionsRequired', [])) - KNOWN_EXTENSIONS
    if unknown:
        raise Unsupported(f'extensionsRequired: {", ".join(sorted(unknown))}')
    for kind in ('animations', 'skins'):
        if file.json.get(kind):
            print(f'warning: {kind} are ignored, the rest pose is used', file=sys.stderr)


# Geometry

def gather_surfaces(file, nodes):
    """All triangles in world space, by material (None: glTF's default material)."""
    parts = {}
    for _, node, world in nodes:
        if 'mesh' not in node:
            continue
        for primitive in file.get('meshes', node['mesh'])['primitives']:
            part = read_primitive(file, primitive, world)
            if part:
                parts.setdefault(primitive.get('material'), []).append(part)
    return {index: join(list_) for index, list_ in parts.items()}


def read_primitive(file, primitive, world):
    """One primitive as unindexed corners: positions, normals, and uvs, colors where present."""
    if 'targets' in primitive:
        print('warning: morph targets are ignored', file=sys.stderr)
    attributes = {name: file.accessor(index) for name, index in primitive['attributes'].items()}
    count = len(attributes['POSITION'])
    order = file.accessor(primitive['indices'])[:, 0] if 'indices' in primitive else np.arange(count)
    triangles = to_triangles(order.astype(np.int64), primitive.get('mode', 4))
    if len(triangles) == 0:
        return None
    linear = world[:3, :3]
    if np.linalg.det(linear) < 0:
        triangles = triangles[:, [0, 2, 1]]
    corners = triangles.reshape(-1)
    positions = (attributes['POSITION'] @ linear.T + world[:3, 3])[corners]
    if 'NORMAL' in attributes:
        normals = (attributes['NORMAL'] @ np.linalg.inv(linear))[corners]
    else:
        a, b, c = positions.reshape(-1, 3, 3).transpose(1, 0, 2)
        normals = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    part = {'positions': positions, 'normals': normals / np.where(length > 0, length, 1)}
    for name in ('TEXCOORD_0', 'TEXCOORD_1'):
        if name in attributes:
            part[name] = attributes[name][corners].astype(np.float64)
    if 'COLOR_0' in attributes:
        colors = attributes['COLOR_0'][corners].astype(np.float64)
        part['COLOR_0'] = np.concatenate([colors, np.ones((len(corners), 4 - colors.shape[1]))], axis=1)
    if 'TANGENT' in attributes:
        tangents = attributes['TANGENT'][corners].astype(np.float64)
        handedness = tangents[:, 3:] * np.sign(np.linalg.det(linear))
        part['TANGENT'] = np.concatenate([tangents[:, :3] @ linear.T, handedness], axis=1)
    return drop_degenerate(part)


def to_triangles(order, mode):
    """Section 3.7.2.1: lists, strips and fans; points and lines have no surface."""
    if mode == 4:
        return order[:len(order) // 3 * 3].reshape(-1, 3)
    if mode == 5:
        strip = np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
        strip[1::2] = strip[1::2][:, [1, 0, 2]]
        return strip
    if mode == 6:
        return np.stack([order[1:-1], order[2:], np.full(len(order) - 2, order[0])], axis=1)
    print('warning: a primitive of points or lines is dropped', file=sys.stderr)
    return np.empty((0, 3), np.int64)


def drop_degenerate(part):
    a, b, c = part['positions'].reshape(-1, 3, 3).transpose(1, 0, 2)
    keep = np.repeat(np.linalg.norm(np.cross(b - a, c - a), axis=1) > 0, 3)
    return {name: array[keep] for name, array in part.items()} if keep.any() else None


def join(parts):
    """Concatenates; an attribute that only some parts have gets its neutral value in the others."""
    names = {name for part in parts for name in part}
    if 'TANGENT' in names and not all('TANGENT' in part for part in parts):
        raise Unsupported('a material whose primitives have tangents only in part')
    joined = {}
    for name in names:
        width = next(part[name].shape[1] for part in parts if name in part)
        neutral = 1.0 if name == 'COLOR_0' else 0.0
        columns = [part.get(name, np.full((len(part['positions']), width), neutral)) for part in parts]
        joined[name] = np.concatenate(columns)
    return joined


def mesh(name, surface, bsdf, light):
    """A Mitsuba mesh with its material and, if it shines, its emitter."""
    props = mi.Properties()
    props['bsdf'] = mi.load_dict(bsdf)
    if light:
        props['emitter'] = mi.load_dict(light)
    count = len(surface['positions'])
    uvs = surface.get('uvs')
    shape = mi.Mesh(f'material {name}', count, count // 3, props, True, uvs is not None)
    if 'COLOR_0' in surface:
        shape.add_attribute('vertex_color', 3, mi.Float(surface['COLOR_0'][:, :3].astype(np.float32).ravel()))
        shape.add_attribute('vertex_opacity', 1, mi.Float(surface['COLOR_0'][:, 3].astype(np.float32)))
    if 'TANGENT' in surface:
        shape.add_attribute('vertex_tangent', 3, mi.Float(surface['TANGENT'][:, :3].astype(np.float32).ravel()))
        shape.add_attribute('vertex_handedness', 1, mi.Float(surface['TANGENT'][:, 3].astype(np.float32)))
    params = mi.traverse(shape)
    params['vertex_positions'] = mi.Float(surface['positions'].astype(np.float32).ravel())
    params['vertex_normals'] = mi.Float(surface['normals'].astype(np.float32).ravel())
    params['faces'] = mi.UInt32(np.arange(count, dtype=np.uint32))
    if uvs is not None:
        params['vertex_texcoords'] = mi.Float(uvs.astype(np.float32).ravel())
    params.update()
    return shape


# Lights and camera

def punctual_lights(file, nodes):
    """KHR_lights_punctual; each shines down −Z of its node, scale changes nothing."""
    lights = {}
    defined = file.json.get('extensions', {}).get('KHR_lights_punctual', {}).get('lights', [])
    for index, node, world in nodes:
        use = node.get('extensions', {}).get('KHR_lights_punctual')
        if not use:
            continue
        light = defined[use['light']]
        intensity = np.array(light.get('color', [1, 1, 1]), np.float64) * light.get('intensity', 1.0)
        direction = -world[:3, 2] / np.linalg.norm(world[:3, 2])
        lights[f'light of node {index}'] = punctual_light(light, intensity, world[:3, 3], direction)
    return lights


def punctual_light(light, intensity, position, direction):
    luminance = LUMINANCE @ intensity
    if light['type'] == 'directional':
        return {'type': 'directional', 'direction': direction.tolist(), 'irradiance': luminance,
                'spectrum': intensity.tolist()}
    plugin = {'type': 'gltf_punctual', 'position': mi.ScalarPoint3f(position),
              'direction': mi.ScalarVector3f(direction), 'intensity': mi.ScalarColor3f(intensity),
              'range': float(light.get('range', 0.0)), 'power': 4 * math.pi * luminance}
    if light['type'] == 'spot':
        spot = light.get('spot', {})
        outer = spot.get('outerConeAngle', math.pi / 4)
        plugin['cos_inner'] = math.cos(spot.get('innerConeAngle', 0.0))
        plugin['cos_outer'] = math.cos(outer)
        plugin['power'] = 2 * math.pi * (1 - math.cos(outer)) * luminance
    return plugin


def environment_light(path):
    """Mitsuba's map looks the other way round, and its rows go from v = 0 to v = 1: two rows a texel hold the same bilinear map."""
    image = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    image = np.array(image, np.float64)
    height, width = image.shape[:2]
    u = np.arange(width) + width / 2
    v = np.clip(np.arange(2 * height + 1) / 2 - 0.5, 0, height - 1)
    left, top = np.floor(u).astype(int), np.minimum(np.floor(v).astype(int), height - 2)
    du, dv = (u - left)[None, :, None], (v - top)[:, None, None]
    rows = image[top] * (1 - dv) + image[top + 1] * dv
    turned = rows[:, left % width] * (1 - du) + rows[:, (left + 1) % width] * du
    weight = np.sin(np.pi * (np.arange(height) + 0.5) / height)[:, None, None]
    mean = (image * weight).sum(axis=(0, 1)) / (weight.sum() * width)
    return {'type': 'envmap', 'bitmap': mi.Bitmap(np.ascontiguousarray(turned.astype(np.float32))),
            'irradiance': math.pi * (LUMINANCE @ mean)}


def share_samples(lights, radius):
    """How often each light is drawn: half by power, half evenly. Removes the keys that Mitsuba does not know."""
    power = {}
    for name, light in lights.items():
        irradiance = light.pop('irradiance', None)
        power[name] = light.pop('power') if irradiance is None else math.pi * radius**2 * irradiance
        if 'spectrum' in light:
            light['irradiance'] = {'type': 'rgb', 'value': light.pop('spectrum')}
    total = sum(power.values())
    for name, light in lights.items():
        light['sampling_weight'] = 0.5 * power[name] / total + 0.5 / len(lights)


def sensor(file, nodes, size, name):
    """The camera of that name (the node's or the camera's own), else the first one."""
    choices = []
    for _, node, world in nodes:
        if 'camera' in node:
            camera = file.get('cameras', node['camera'])
            choices.append(({node.get('name'), camera.get('name')}, camera, world))
    chosen = [choice for choice in choices if name is None or name in choice[0]]
    if not chosen:
        raise Unsupported(f'no camera {name or ""}; the file has {[sorted(map(str, c[0])) for c in choices]}')
    _, camera, world = chosen[0]
    if camera['type'] != 'perspective':
        raise Unsupported(f'a camera of type {camera["type"]}')
    to_world = np.eye(4)
    to_world[:3, :3] = world[:3, :3] / np.linalg.norm(world[:3, :3], axis=0)
    to_world[:3, 3] = world[:3, 3]
    # Mitsuba's camera looks down +Z with +X to the left: half a turn about Y.
    to_world = to_world @ np.diag([-1.0, 1.0, -1.0, 1.0])
    return {'type': 'perspective', 'fov_axis': 'y', 'fov': math.degrees(camera['perspective']['yfov']),
            'near_clip': 1e-3, 'far_clip': 1e6, 'to_world': mi.ScalarTransform4f(to_world),
            'film': {'type': 'hdrfilm', 'width': size[0], 'height': size[1], 'pixel_format': 'rgb',
                     'component_format': 'float32', 'rfilter': {'type': 'box'}},
            'sampler': {'type': 'independent'}}
