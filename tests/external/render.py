"""Renders a glTF scene with Mitsuba 3, with the standard error of every pixel.

    python render.py SCENE.glb --transport full:4 --size 64x36 --spp 65536 --target 0.003 -o out.exr

The image is the mean of independent batches; their spread gives the standard error of that mean. The EXR holds R, G, B
and SE.R, SE.G, SE.B as 32-bit floats, and attributes `reference:…` that say how it was made; stdout says the same.
With --keep a run that was stopped goes on where it was, from `out.exr.state.npz`.
Transports: emission, direct, indirect:N, full:N (window_path.py says what they hold).
"""

import argparse
import hashlib
import json
import pathlib
import sys
import time

import numpy as np
import OpenEXR

import appendix_b
import blocks
import gltf_lights
import gltf_scene
import window_path
from gltf_file import Unsupported
from variant import mi

# Batches rendered before the error is looked at: enough for a steady estimate of it.
ROUND = 32


def register():
    appendix_b.register()
    gltf_lights.register()
    window_path.register()


def integrator(transport, facts):
    fewest, most = window_path.window(transport)
    return mi.load_dict({'type': 'window_path', 'fewest': fewest, 'most': most, **facts})


class Accumulator:
    """Mean and standard error of the mean, float64, of independent images."""

    def __init__(self):
        self.count, self.total, self.square = 0, 0.0, 0.0

    def add(self, image):
        self.count += 1
        self.total, self.square = self.total + image, self.square + image**2

    def save(self, path, facts):
        partial = path.with_name('partial-' + path.name)
        np.savez(partial, facts=json.dumps(facts), count=self.count, total=self.total, square=self.square)
        partial.replace(path)

    @classmethod
    def resume(cls, path, facts):
        """What was saved of the same facts, else nothing yet."""
        found = cls()
        if path.exists():
            with np.load(path) as saved:
                if str(saved['facts']) == json.dumps(facts):
                    found.count, found.total, found.square = int(saved['count']), saved['total'], saved['square']
        return found

    def result(self):
        mean = self.total / self.count
        variance = np.maximum(self.square / self.count - mean**2, 0) * self.count / (self.count - 1)
        return mean, np.sqrt(variance / self.count)


def render(scene, how, spp, batches, seed, accumulator=None):
    """Adds `batches` images of spp samples in all, with seeds from `seed` on; returns mean and standard error."""
    accumulator = accumulator or Accumulator()
    for batch in range(batches):
        accumulator.add(np.array(mi.render(scene, integrator=how, spp=spp // batches, seed=seed + batch), np.float64))
    return accumulator.result()


def block_errors(mean, error):
    """Relative standard errors of the luminance of the lit blocks."""
    value, spread, lit = blocks.statistics(*blocks.luminance(mean, error))
    return spread[lit] / value[lit] if lit.any() else np.zeros(1)


def write(path, mean, error, facts):
    """The file appears whole or not at all."""
    channels = {}
    for index, channel in enumerate('RGB'):
        channels[channel] = np.ascontiguousarray(mean[..., index].astype(np.float32))
        channels[f'SE.{channel}'] = np.ascontiguousarray(error[..., index].astype(np.float32))
    header = {'compression': OpenEXR.ZIP_COMPRESSION, 'type': OpenEXR.scanlineimage}
    header |= text(facts)
    partial = path.with_name(path.name + '.partial')
    OpenEXR.File(header, channels).write(str(partial))
    partial.replace(path)


def size(text):
    width, height = text.lower().split('x')
    return int(width), int(height)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('scene', type=pathlib.Path, help='.glb or .gltf')
    parser.add_argument('--transport', default='full:4', help='emission, direct, indirect:N or full:N')
    parser.add_argument('--size', type=size, default=(64, 36), metavar='WxH')
    parser.add_argument('--spp', type=int, default=1024, help='samples per pixel at most, in batches of spp / batches')
    parser.add_argument('--batches', type=int, default=ROUND, help=f'independent images, a multiple of {ROUND}')
    parser.add_argument('--target', type=float, default=0.0,
                        help='stop early when 95 %% of the lit 8×8 blocks have this relative standard error')
    parser.add_argument('--seed', type=int, default=0, help='of the first batch; the next one has seed + 1')
    parser.add_argument('--camera', help='name of a camera; the first one by default')
    parser.add_argument('--environment', type=pathlib.Path, help='equirectangular .exr')
    parser.add_argument('-o', '--output', type=pathlib.Path, required=True)
    parser.add_argument('--keep', action='store_true',
                        help='leave the output alone where it shows this scene and transport; go on with one that was begun')
    given = parser.parse_args()
    if given.batches < ROUND or given.batches % ROUND or given.spp < given.batches:
        parser.error(f'--batches must be a multiple of {ROUND} and at most --spp')
    try:
        window_path.window(given.transport)
    except ValueError as error:
        parser.error(str(error))
    return given


def wanted(given):
    """The facts that are known before rendering."""
    facts = {'renderer': f'Mitsuba {mi.__version__}, {mi.variant()}', 'scene': given.scene.name,
             'scene sha256': hashlib.sha256(given.scene.read_bytes()).hexdigest(),
             'camera': given.camera or 'the first', 'transport': given.transport, 'size': list(given.size),
             'first seed': given.seed}
    if given.environment:
        facts['environment'] = given.environment.name
        facts['environment sha256'] = hashlib.sha256(given.environment.read_bytes()).hexdigest()
    return facts


def text(facts):
    """As attributes of an EXR."""
    return {f'reference:{name}': value if isinstance(value, str) else json.dumps(value)
            for name, value in facts.items()}


def is_there(path, facts):
    if not path.exists():
        return False
    with OpenEXR.File(str(path)) as file:
        # The header is gone once the file is closed.
        header = file.header()
        return all(header.get(name) == value for name, value in text(facts).items())


def main():
    given = arguments()
    facts = wanted(given)
    if given.keep and is_there(given.output, facts):
        print(f'{given.output} is there')
        return
    register()
    started = time.time()
    try:
        scene, needs = gltf_scene.load(given.scene, given.size, given.camera, given.environment)
    except Unsupported as error:
        sys.exit(f'{given.scene}: not converted: {error}')
    how = integrator(given.transport, needs)
    a_round = given.spp * ROUND // given.batches
    state, begun = given.output.with_name(given.output.name + '.state.npz'), facts | {'samples of a round': a_round}
    accumulator = Accumulator.resume(state, begun) if given.keep else Accumulator()
    while accumulator.count < given.batches:
        mean, error = render(scene, how, a_round, ROUND, given.seed + accumulator.count, accumulator)
        errors = block_errors(mean, error)
        print(f'{accumulator.count} of {given.batches} batches, {time.time() - started:.0f} s, '
              f'block error {np.quantile(errors, 0.95):.4f}', file=sys.stderr, flush=True)
        if given.keep:
            accumulator.save(state, begun)
        if np.quantile(errors, 0.95) <= given.target:
            break
    mean, error = accumulator.result()
    facts |= {'spp': a_round // ROUND * accumulator.count, 'batches': accumulator.count,
              'seconds': round(time.time() - started, 1), 'mean': np.round(mean.mean(axis=(0, 1)), 6).tolist(),
              'block standard error': {name: round(float(np.quantile(errors, q)), 5)
                                       for name, q in (('median', 0.5), ('95 %', 0.95), ('largest', 1.0))}}
    write(given.output, mean, error, facts)
    state.unlink(missing_ok=True)
    print(json.dumps(facts, indent=1, ensure_ascii=False))


if __name__ == '__main__':
    main()
