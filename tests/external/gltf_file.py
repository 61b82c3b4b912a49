"""Reads a glTF 2.0 file (.glb or .gltf) into NumPy arrays, from the specification, with no other library.

Sections named below are those of the glTF 2.0 specification.
"""

import base64
import json
import pathlib
import struct
import urllib.parse

import numpy as np

COMPONENT = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTH = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT2': 4, 'MAT3': 9, 'MAT4': 16}


class Unsupported(Exception):
    """The file asks for something that this converter does not do."""


class GltfFile:
    """`json` is the document; the methods follow its references."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        data = self.path.read_bytes()
        self.json, self.binary = split_glb(data) if data[:4] == b'glTF' else (json.loads(data), None)
        self.buffers = {}

    def get(self, kind, index):
        return self.json[kind][index]

    def buffer(self, index):
        if index not in self.buffers:
            uri = self.get('buffers', index).get('uri')
            self.buffers[index] = self.binary if uri is None else self.fetch(uri)
        return self.buffers[index]

    def fetch(self, uri):
        """A data URI's bytes, or those of a file beside this one."""
        if uri.startswith('data:'):
            return base64.b64decode(uri.split(',', 1)[1])
        return (self.path.parent / urllib.parse.unquote(uri)).read_bytes()

    def view(self, index):
        view = self.get('bufferViews', index)
        start = view.get('byteOffset', 0)
        return self.buffer(view['buffer'])[start:start + view['byteLength']], view.get('byteStride')

    def accessor(self, index):
        """Section 3.6.2: an array of shape (count, width); normalised integers become floats."""
        accessor = self.get('accessors', index)
        width, dtype, count = WIDTH[accessor['type']], COMPONENT[accessor['componentType']], accessor['count']
        if 'bufferView' in accessor:
            array = self._elements(accessor['bufferView'], accessor.get('byteOffset', 0), dtype, width, count)
        else:
            array = np.zeros((count, width), dtype)
        if 'sparse' in accessor:
            sparse = accessor['sparse']
            at = sparse['indices']
            rows = self._elements(at['bufferView'], at.get('byteOffset', 0), COMPONENT[at['componentType']], 1,
                                  sparse['count'])
            at = sparse['values']
            array[rows[:, 0]] = self._elements(at['bufferView'], at.get('byteOffset', 0), dtype, width, sparse['count'])
        if accessor.get('normalized'):
            array = np.maximum(array.astype(np.float32) / np.iinfo(dtype).max, -1.0)
        return array

    def _elements(self, view, offset, dtype, width, count):
        data, stride = self.view(view)
        size = np.dtype(dtype).itemsize
        stride = stride or size * width
        rows = np.lib.stride_tricks.as_strided(np.frombuffer(data, np.uint8, offset=offset),
                                               shape=(count, size * width), strides=(stride, 1))
        return np.ascontiguousarray(rows).view(dtype).reshape(count, width).copy()

    def image_bytes(self, index):
        image = self.get('images', index)
        return self.view(image['bufferView'])[0] if 'bufferView' in image else self.fetch(image['uri'])

    def nodes(self):
        """Section 3.5: (node index, node, world matrix) of the default scene, parents before children."""
        if 'scenes' in self.json:
            roots = self.get('scenes', self.json.get('scene', 0)).get('nodes', [])
        else:
            children = {c for node in self.json.get('nodes', []) for c in node.get('children', [])}
            roots = [i for i in range(len(self.json.get('nodes', []))) if i not in children]
        waiting = [(root, np.eye(4)) for root in reversed(roots)]
        while waiting:
            index, parent = waiting.pop()
            node = self.get('nodes', index)
            world = parent @ local_matrix(node)
            yield index, node, world
            waiting.extend((child, world) for child in reversed(node.get('children', [])))


def split_glb(data):
    """Section 4.4: the JSON chunk and the optional binary chunk."""
    _, version, length = struct.unpack_from('<4sII', data)
    if version != 2:
        raise Unsupported(f'GLB version {version}')
    document, binary, at = None, None, 12
    while at < length:
        size, kind = struct.unpack_from('<II', data, at)
        chunk = data[at + 8:at + 8 + size]
        if kind == 0x4E4F534A:
            document = json.loads(chunk)
        elif kind == 0x004E4942:
            binary = chunk
        at += 8 + size
    return document, binary


def local_matrix(node):
    """A node's matrix, or translation · rotation · scale."""
    if 'matrix' in node:
        return np.array(node['matrix'], np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get('rotation', [0, 0, 0, 1]), np.float64)
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.array(node.get('scale', [1, 1, 1]), np.float64)
    matrix[:3, 3] = node.get('translation', [0, 0, 0])
    return matrix
