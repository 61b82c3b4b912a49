"""Writes small glTF files for the checks."""

import io
import json
import math
import pathlib
import struct

import numpy as np
import PIL.Image


class GlbWriter:
    """Just enough for a test scene: `json` is the document, to be changed at will before `write`."""

    def __init__(self):
        self.json = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': []}], 'nodes': [], 'meshes': [],
                     'materials': [], 'accessors': [], 'bufferViews': []}
        self.binary = b''

    def view(self, data):
        self.binary += b'\0' * (-len(self.binary) % 4)
        self.json['bufferViews'].append({'buffer': 0, 'byteOffset': len(self.binary), 'byteLength': len(data)})
        self.binary += data
        return len(self.json['bufferViews']) - 1

    def accessor(self, array, kind):
        component = 5125 if kind == 'SCALAR' else 5126
        return self.raw_accessor(np.asarray(array, np.uint32 if kind == 'SCALAR' else np.float32), component, kind)

    def raw_accessor(self, array, component, kind):
        """Of an array as it is."""
        entry = {'bufferView': self.view(array.tobytes()), 'componentType': component, 'count': len(array), 'type': kind}
        if kind == 'VEC3':
            entry |= {'min': array.min(axis=0).tolist(), 'max': array.max(axis=0).tolist()}
        self.json['accessors'].append(entry)
        return len(self.json['accessors']) - 1

    def material(self, base=(0.7, 0.7, 0.7, 1), roughness=1.0, metallic=0.0, emission=None, **more):
        entry = {'pbrMetallicRoughness': {'baseColorFactor': list(base), 'roughnessFactor': roughness,
                                          'metallicFactor': metallic}, **more}
        if emission:
            entry.setdefault('emissiveFactor', [1, 1, 1])
            entry.setdefault('extensions', {})['KHR_materials_emissive_strength'] = {'emissiveStrength': emission}
        self.json['materials'].append(entry)
        return len(self.json['materials']) - 1

    def mesh(self, material, positions, indices, normals=None, uvs=None, tangents=None, colors=None, **node):
        attributes = {'POSITION': self.accessor(positions, 'VEC3')}
        if normals is not None:
            attributes['NORMAL'] = self.accessor(normals, 'VEC3')
        if uvs is not None:
            attributes['TEXCOORD_0'] = self.accessor(uvs, 'VEC2')
        if tangents is not None:
            attributes['TANGENT'] = self.accessor(tangents, 'VEC4')
        if colors is not None:
            attributes['COLOR_0'] = self.accessor(colors, f'VEC{np.shape(colors)[1]}')
        primitive = {'attributes': attributes, 'indices': self.accessor(np.ravel(indices), 'SCALAR'),
                     'material': material}
        self.add_mesh(primitive, **node)

    def add_mesh(self, primitive, **node):
        self.json['meshes'].append({'primitives': [primitive]})
        self.node(mesh=len(self.json['meshes']) - 1, **node)

    def quad(self, material, corner, u, v, **node):
        """Front towards u × v."""
        corner, u, v = (np.array(x, float) for x in (corner, u, v))
        self.mesh(material, [corner, corner + u, corner + u + v, corner + v], [0, 1, 2, 0, 2, 3],
                  uvs=[[0, 1], [1, 1], [1, 0], [0, 0]], **node)

    def sphere(self, material, centre, radius, steps=48, **attributes):
        """Smooth; u runs eastwards, v from pole to pole."""
        theta, phi = np.meshgrid(np.linspace(0, math.pi, steps + 1), np.linspace(0, 2 * math.pi, 2 * steps + 1))
        normals = np.stack([np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], -1).reshape(-1, 3)
        row = steps + 1
        indices = [(k, k + row, k + row + 1, k, k + row + 1, k + 1)
                   for i in range(2 * steps) for k in range(i * row, i * row + steps)]
        uvs = np.stack([phi / (2 * math.pi), theta / math.pi], -1).reshape(-1, 2)
        self.mesh(material, normals * radius + np.array(centre), indices, normals, uvs, **attributes)

    def texture(self, rgba, filtering=9728, wrap=10497):
        """An image as a PNG, by default repeated, and looked up without filtering."""
        stream = io.BytesIO()
        PIL.Image.fromarray(rgba).save(stream, 'PNG')
        self.json.setdefault('images', []).append({'bufferView': self.view(stream.getvalue()), 'mimeType': 'image/png'})
        samplers, sampler = self.json.setdefault('samplers', []), {'magFilter': filtering, 'wrapS': wrap, 'wrapT': wrap}
        if sampler not in samplers:
            samplers.append(sampler)
        self.json.setdefault('textures', []).append({'source': len(self.json['images']) - 1, 'sampler': samplers.index(sampler)})
        return len(self.json['textures']) - 1

    def node(self, **entry):
        self.json['nodes'].append(entry)
        self.json['scenes'][0]['nodes'].append(len(self.json['nodes']) - 1)

    def group(self, build, **entry):
        """What `build` adds to the scene hangs under a node of its own."""
        roots = self.json['scenes'][0]['nodes']
        first = len(roots)
        build()
        children = roots[first:]
        del roots[first:]
        self.node(children=children, **entry)

    def camera(self, position, fov_degrees):
        """Looks down −Z."""
        lens = {'yfov': math.radians(fov_degrees), 'znear': 0.1}
        self.json['cameras'] = [{'type': 'perspective', 'perspective': lens}]
        self.node(camera=0, translation=list(position))

    def light(self, entry, **node):
        lights = self.json.setdefault('extensions', {}).setdefault('KHR_lights_punctual', {'lights': []})['lights']
        lights.append(entry)
        self.node(extensions={'KHR_lights_punctual': {'light': len(lights) - 1}}, **node)

    def write(self, path):
        self.json['buffers'] = [{'byteLength': len(self.binary)}]
        document = json.dumps(self.json).encode()
        document += b' ' * (-len(document) % 4)
        binary = self.binary + b'\0' * (-len(self.binary) % 4)
        data = struct.pack('<II', len(document), 0x4E4F534A) + document
        data += struct.pack('<II', len(binary), 0x004E4942) + binary
        pathlib.Path(path).write_bytes(struct.pack('<4sII', b'glTF', 2, 12 + len(data)) + data)
        return path
