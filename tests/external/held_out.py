"""Scenes that no one tuned the renderers on, through both: docs/evidence/held_out.json.

    python held_out.py AQUIFER FOLDER [--samples 512] [SCENE …]

The scenes of held_out_scenes.py at full:2 and 64×36, a short run each. They agree when every channel's mean does, to four standard errors that
are at most 0.5 % of it, and when no block is apart by more than 2 % and four standard errors. FOLDER gets the .glb files and the images;
side-SCENE.png shows Mitsuba's, ours and how many standard errors they are apart (red: ours is brighter, blue: darker; full at 6).
"""

import argparse
import datetime
import json
import pathlib
import subprocess
import sys

import numpy as np
import PIL.Image

import blocks
import compare
import evidence
import gltf_scene
import held_out_scenes
import render as tool
from gltf_materials import linear_to_srgb
from variant import mi

OUTPUT = evidence.OUTPUT.with_name('held_out.json')
SIZE, TRANSPORT = (64, 36), 'full:2'
SURE, RESOLVED = 4, 0.005
# Mitsuba is the quicker one, so it may be the less noisy one.
THEIR_SHARE = 4


def both(arguments, scene):
    """(mean, standard error) of Mitsuba and of ours."""
    glb, texels = held_out_scenes.build(scene)
    path = glb.write(arguments.folder / f'{scene.__name__}.glb')
    environment = None
    if texels is not None:
        environment = path.with_suffix('.exr')
        mi.Bitmap(texels).write(str(environment))
    loaded, facts = gltf_scene.load(path, SIZE, environment=environment)
    theirs = tool.render(loaded, tool.integrator(TRANSPORT, facts), THEIR_SHARE * arguments.samples, tool.ROUND, seed=0)
    image = arguments.folder / f'ours-{scene.__name__}.exr'
    settings = [f'path_tracer.samples={evidence.PER_FRAME}', *evidence.SETTINGS.get(scene.__name__, [])]
    evidence.run(arguments.aquifer, 'render', 'path_tracer', '--scene', path, *(['--environment', environment] if environment else []), '--transport',
                 TRANSPORT, '--size', '64x36', *(word for setting in settings for word in ('--set', setting)), '--frames',
                 arguments.samples // evidence.PER_FRAME, '-o', image)
    return theirs, compare.read(str(image))


def verdict(theirs, ours):
    means, noises = [], []
    for c in range(3):
        total = theirs[0][..., c].sum()
        means.append(ours[0][..., c].sum() / total - 1)
        noises.append(np.sqrt((theirs[1][..., c]**2 + ours[1][..., c]**2).sum()) / total)
    block, spread, lit = blocks.statistics(*blocks.luminance(*theirs))
    our_block, our_spread, _ = blocks.statistics(*blocks.luminance(*ours))
    apart, noise = our_block[lit] / block[lit] - 1, np.hypot(spread, our_spread)[lit] / block[lit]
    beyond = np.abs(apart) - np.maximum(SURE * noise, compare.BLOCK)
    worst = np.argmax(beyond)
    agree = max(abs(m) / n for m, n in zip(means, noises)) <= SURE and beyond[worst] <= 0
    channel = int(np.argmax(np.abs(means)))
    return {'mean difference %': round(float(100 * means[channel]), 3), 'standard error %': round(float(100 * noises[channel]), 3),
            'lit blocks': int(lit.sum()), 'block difference %': round(float(100 * apart[worst]), 2),
            'block standard error %': round(float(100 * noise[worst]), 2),
            'verdict': 'apart' if not agree else 'agree' if max(noises) <= RESOLVED else 'not resolved'}


def picture(path, theirs, ours):
    """Both images and their difference, side by side, four times as large."""
    z = (ours[0] - theirs[0]).sum(axis=2) / np.maximum(np.hypot(theirs[1], ours[1]).sum(axis=2), 1e-12) / 6
    apart = 1 - np.stack([np.maximum(-z, 0), np.abs(z), np.maximum(z, 0)], -1)
    shown = [linear_to_srgb(np.clip(image[0] / np.quantile(theirs[0], 0.98), 0, 1)) for image in (theirs, ours)]
    pixels = np.concatenate([*shown, np.clip(apart, 0, 1)], axis=1).repeat(4, axis=0).repeat(4, axis=1)
    PIL.Image.fromarray(np.round(255 * pixels).astype(np.uint8)).save(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('aquifer', type=pathlib.Path)
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('--samples', type=int, default=512, help='ours in a pixel')
    parser.add_argument('--output', type=pathlib.Path, default=OUTPUT, help='the file of rows')
    scenes = {scene.__name__: scene for scene in held_out_scenes.ALL}
    parser.add_argument('scenes', nargs='*', choices=[[], *scenes], metavar='SCENE', help='one or more of ' + ', '.join(scenes))
    arguments = parser.parse_intermixed_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    facts = evidence.program_facts(arguments.aquifer)
    tool.register()
    found = []
    for name in arguments.scenes or scenes:
        theirs, ours = both(arguments, scenes[name])
        picture(arguments.folder / f'side-{name}.png', theirs, ours)
        found.append(verdict(theirs, ours))
        evidence.write(arguments.output, {'scene': name}, {'tries': scenes[name].__doc__, 'samples': arguments.samples} | found[-1] | facts)
        print(name, found[-1], flush=True)
    return 0 if all(row['verdict'] == 'agree' for row in found) else 1


if __name__ == '__main__':
    sys.exit(main())
