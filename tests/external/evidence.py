"""The full comparison with Mitsuba, as evidence: docs/evidence/external.json.

    python evidence.py AQUIFER FOLDER [--size 256x144] [--minutes 60] [SCENE:TRANSPORT …]

Renders each case in parts until it is resolved, or for so many minutes. FOLDER keeps what was rendered: a run that was stopped goes on where
it was. A row is written after each part, so whatever stops the run, what it found stays; so do the rows of other scenes, transports and
sizes. What is not resolved is written down as that. A row's commit is the program's own, as its --version says it.
"""

import argparse
import datetime
import json
import math
import pathlib
import re
import subprocess
import sys
import time

import numpy as np
import OpenEXR

import blocks
import compare

HERE = pathlib.Path(__file__).resolve().parent
OUTPUT = HERE.parents[1] / 'docs' / 'evidence' / 'external.json'
REFERENCES = HERE / 'references'
# Where a sun is among few lights, drawing them by power gives it nearly all samples, and the lamps are noise.
SETTINGS = {scene: ['slots.proposal=uniform'] for scene in ('sun_room', 'lamps')}
# Paths that share a film position: more of them save dispatches, but leave the noise of edges. Where light is found so seldom that edges do
# not matter, 16.
PER_FRAME, PER_FRAME_SELDOM = 4, 16
# The error of a reference that is rendered here, of 95 % of its blocks: both together must stay below compare.RESOLVED. Where light is seldom
# found, ours costs twice as much a sample, and this splits the work for the shortest time.
TARGET, TARGET_SELDOM = 0.003, 0.004
SELDOM = {'glossy:indirect:2', 'sun_room:direct', 'sun_room:full:2', 'door_ajar:direct', 'door_ajar:full:2'}
# Frames of the first part, and seconds that a later one may take.
FIRST, PART = 32, 120
# Standard errors beyond the band at which a difference is no noise.
SURE = 3


def run(*command):
    print('+', *command, flush=True)
    subprocess.run([str(word) for word in command], check=True)


def program_facts(program):
    """What a row says of the program and of today: the commit it was built from, its adapter, the date."""
    version = ask(program, '--version').strip()
    found = re.search(r'\(([0-9a-f]{7,40})\)', version)
    if not found:
        sys.exit(f'{program} is "{version}": evidence is made by a program that was built from a commit, without changes')
    return {'commit': found[1], 'adapter': json.loads(ask(program, 'adapters', '--json'))[0]['name'], 'date': str(datetime.date.today())}


def ask(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def all_pairs():
    """SCENE:TRANSPORT of every reference."""
    pairs = []
    for path in sorted(REFERENCES.glob('*.exr')):
        with OpenEXR.File(str(path)) as file:
            header = file.header()
            pairs.append(f"{header['reference:scene'].removesuffix('.glb')}:{header['reference:transport']}")
    return pairs


class Case:
    """One scene, transport and size; `path` is where all its frames are, merged."""

    def __init__(self, arguments, scene, transport, commit):
        self.scene, self.transport, self.size, self.aquifer = scene, transport, arguments.size, arguments.aquifer
        seldom = f'{scene}:{transport}' in SELDOM
        self.per_frame, self.target = (PER_FRAME_SELDOM, TARGET_SELDOM) if seldom else (PER_FRAME, TARGET)
        self.name = f'{scene}-{transport.replace(":", "")}'
        self.glb = REFERENCES / f'{scene}.glb'
        self.path = arguments.folder / f'ours-{self.name}-{self.size}-{commit[:12]}.exr'
        if not self.glb.exists():
            self.glb = arguments.folder / f'{scene}.glb'
            run(self.aquifer, 'scenes', 'export', scene, self.glb)
        environment = self.glb.with_suffix('.exr')
        self.environment = ['--environment', environment] if environment.exists() else []
        self.reference = compare.read(str(self.find_reference(arguments.folder)))

    def find_reference(self, folder):
        if self.size == '64x36':
            return REFERENCES / f'{self.name}.exr'
        path = folder / f'reference-{self.name}-{self.size}.exr'
        run(sys.executable, HERE / 'render.py', self.glb, *self.environment, '--transport', self.transport, '--size', self.size, '--spp', 262144,
            '--batches', 8192, '--target', self.target, '--keep', '-o', path)
        return path

    def samples(self):
        if not self.path.exists():
            return 0
        with OpenEXR.File(str(self.path)) as file:
            return int(file.header()['samplesPerPixel'])

    def add(self, frames):
        """Renders the next frames."""
        part = self.path.with_name('part-' + self.path.name)
        settings = [f'path_tracer.samples={self.per_frame}', *SETTINGS.get(self.scene, [])]
        run(self.aquifer, 'render', 'path_tracer', '--scene', self.glb, *self.environment, '--transport', self.transport, '--size', self.size,
            *(word for setting in settings for word in ('--set', setting)), '--first-frame', self.samples() // self.per_frame,
            '--frames', frames, '-o', part)
        if self.path.exists():
            run(self.aquifer, 'merge', self.path, part, '-o', self.path)
            part.unlink()
        else:
            part.rename(self.path)

    def verdict(self):
        """What the row says of the images, and how many times the samples would resolve it."""
        (theirs, their_error), (ours, our_error) = self.reference, compare.read(str(self.path))
        value, error = blocks.luminance(theirs, their_error)
        our_value, our_spread = blocks.luminance(ours, our_error)
        mean = our_value.mean() / value.mean() - 1
        # The bound on the error of luminance adds channels; of the mean, the channels one by one are exact.
        noise = max(np.sqrt((their_error[..., c]**2 + our_error[..., c]**2).sum()) / theirs[..., c].sum() for c in range(3))
        block, spread, lit = blocks.statistics(value, error)
        our_block, our_block_spread, _ = blocks.statistics(our_value, our_spread)
        resolved = lit & (np.hypot(spread, our_block_spread) <= compare.RESOLVED * block)
        apart = np.abs(our_block / block - 1)
        worst = float(apart[resolved].max()) if resolved.any() else float('nan')
        enough = resolved.sum() >= compare.SHARE * lit.sum()
        within = abs(mean) <= compare.MEAN and worst <= compare.BLOCK
        # Apart is what lies beyond the band by three of its standard errors; anything nearer more samples will decide.
        beyond = apart - np.hypot(spread, our_block_spread) / block * SURE
        failed = abs(mean) - SURE * noise > compare.MEAN or (beyond[resolved] > compare.BLOCK).any()
        found = {'samples': self.samples(), 'mean difference %': round(float(100 * mean), 3), 'standard error %': round(float(100 * noise), 3),
                 'lit blocks': int(lit.sum()), 'resolved blocks': int(resolved.sum()),
                 'largest block difference %': round(100 * worst, 2) if resolved.any() else None,
                 'verdict': 'failed' if failed else 'passed' if enough and within else 'not resolved'}
        allowed = np.sqrt(np.maximum((compare.RESOLVED * block[lit])**2 - spread[lit]**2, 1e-30))
        return found, float(np.quantile(our_block_spread[lit] / allowed, compare.SHARE))**2

    def rows(self, minutes):
        """The row after each part, until it is resolved or the time is over."""
        stop, frames, seconds = time.time() + 60 * minutes, FIRST, 0.0
        if self.path.exists():
            found, factor = self.verdict()
            yield found
            if found['verdict'] != 'not resolved':
                return
        while time.time() < stop:
            started = time.time()
            self.add(frames)
            seconds = time.time() - started
            found, factor = self.verdict()
            yield found
            if found['verdict'] != 'not resolved':
                return
            lacking = math.ceil(found['samples'] / self.per_frame * max(factor - 1, 0.1))
            frames = max(1, min(lacking, 4 * frames, int(frames * PART / seconds)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('aquifer', type=pathlib.Path)
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('--size', default='256x144')
    parser.add_argument('--minutes', type=float, default=60, help='for each case at most')
    parser.add_argument('--output', type=pathlib.Path, default=OUTPUT, help='the file of rows')
    parser.add_argument('pairs', nargs='*', default=all_pairs(), help='those of `references` by default')
    arguments = parser.parse_intermixed_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    facts = program_facts(arguments.aquifer)
    for pair in arguments.pairs:
        scene, transport = pair.split(':', 1)
        for found in Case(arguments, scene, transport, facts['commit']).rows(arguments.minutes):
            key = {'scene': scene, 'transport': transport, 'size': arguments.size}
            write(arguments.output, key, found | facts)
            print(pair, found, flush=True)


def write(path, key, found):
    """The file with this row in place of an older one of the same key."""
    rows = json.loads(path.read_text())['rows'] if path.exists() else []
    path.parent.mkdir(parents=True, exist_ok=True)
    here = [index for index, row in enumerate(rows) if key.items() <= row.items()] or [len(rows)]
    rows[here[0]:here[0] + 1] = [key | found]
    path.write_text(json.dumps({'rows': rows}, indent=1) + '\n')


if __name__ == '__main__':
    main()
