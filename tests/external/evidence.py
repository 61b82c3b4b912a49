"""The full comparison with Mitsuba, as evidence: docs/evidence/external.json.

    python evidence.py AQUIFER FOLDER [--size 256x144] [--samples 8192] [SCENE:TRANSPORT …]

AQUIFER is the program, FOLDER keeps what was rendered: a run that was stopped goes on where it was. Rows of other scenes, transports and sizes that
the file already holds stay. What is not resolved is written down as that.
"""

import argparse
import datetime
import json
import pathlib
import subprocess
import sys

import numpy as np

import blocks
import compare

HERE = pathlib.Path(__file__).resolve().parent
OUTPUT = HERE.parents[1] / 'docs' / 'evidence' / 'external.json'
MATRIX = [f'{scene}:{transport}' for scene in ('cornell', 'glossy') for transport in ('direct', 'indirect:2', 'full:4')]
# Paths that share a film position: more of them save dispatches, but leave the noise of edges.
PER_FRAME = 4


def run(*command):
    print('+', *command, flush=True)
    subprocess.run([str(word) for word in command], check=True)


def reference(arguments, scene, transport, glb):
    name = f'{scene}-{transport.replace(":", "")}'
    if arguments.size == '64x36':
        return HERE / 'references' / f'{name}.exr'
    path = arguments.folder / f'reference-{name}-{arguments.size}.exr'
    environment = arguments.folder / f'{scene}.exr'
    extra = ['--environment', environment] if environment.exists() else []
    run(sys.executable, HERE / 'render.py', glb, *extra, '--transport', transport, '--size', arguments.size, '--spp', 262144,
        '--batches', 8192, '--target', 0.003, '--keep', '-o', path)
    return path


def render(arguments, scene, transport, glb):
    """Our image and what rendered it; a file that is there already was rendered by the same program."""
    path = arguments.folder / f'ours-{scene}-{transport.replace(":", "")}-{arguments.size}-{arguments.commit[:12]}.exr'
    if not path.exists():
        run(arguments.aquifer, 'render', 'path_tracer', '--scene', glb, '--transport', transport, '--size', arguments.size,
            '--set', f'path_tracer.samples={PER_FRAME}', '--frames', arguments.samples // PER_FRAME, '-o', path)
    return path


def row(arguments, scene, transport):
    glb = arguments.folder / f'{scene}.glb'
    run(arguments.aquifer, 'scenes', 'export', scene, glb)
    (theirs, their_error), (ours, our_error) = (compare.read(str(path)) for path in (
        reference(arguments, scene, transport, glb), render(arguments, scene, transport, glb)))
    value, error = blocks.luminance(theirs, their_error)
    our_value, our_spread = blocks.luminance(ours, our_error)
    mean = our_value.mean() / value.mean() - 1
    # The bound on the error of luminance adds channels; of the mean, the channels one by one are exact.
    noise = max(np.sqrt((their_error[..., c]**2 + our_error[..., c]**2).sum()) / theirs[..., c].sum() for c in range(3))
    block, spread, lit = blocks.statistics(value, error)
    our_block, our_block_spread, _ = blocks.statistics(our_value, our_spread)
    resolved = lit & (np.hypot(spread, our_block_spread) <= compare.RESOLVED * block)
    worst = float(np.abs(our_block[resolved] / block[resolved] - 1).max()) if resolved.any() else float('nan')
    apart = not abs(mean) <= compare.MEAN or worst > compare.BLOCK
    verdict = 'failed' if apart else 'passed' if resolved.sum() >= compare.SHARE * lit.sum() else 'not resolved'
    return {'scene': scene, 'transport': transport, 'size': arguments.size, 'samples': arguments.samples,
            'mean difference %': round(100 * mean, 3), 'standard error %': round(100 * noise, 3), 'lit blocks': int(lit.sum()),
            'resolved blocks': int(resolved.sum()), 'largest block difference %': round(100 * worst, 2), 'verdict': verdict}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('aquifer', type=pathlib.Path)
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('--size', default='256x144')
    parser.add_argument('--samples', type=int, default=8192)
    parser.add_argument('pairs', nargs='*', default=MATRIX)
    arguments = parser.parse_intermixed_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    git = subprocess.run(['git', 'rev-parse', 'HEAD'], cwd=HERE, check=True, capture_output=True, text=True)
    arguments.commit = git.stdout.strip()
    adapter = json.loads(subprocess.run([arguments.aquifer, 'adapters', '--json'], check=True, capture_output=True, text=True).stdout)[0]['name']
    old = json.loads(OUTPUT.read_text())['rows'] if OUTPUT.exists() else []
    rows = {(r['scene'], r['transport'], r['size']): r for r in old}
    for pair in arguments.pairs:
        scene, transport = pair.split(':', 1)
        found = row(arguments, scene, transport)
        rows[scene, transport, arguments.size] = found | {'commit': arguments.commit, 'adapter': adapter, 'date': str(datetime.date.today())}
        OUTPUT.parent.mkdir(parents=True, exist_ok=True)
        # Written after each row: whatever stops the run, the rows before it stay.
        OUTPUT.write_text(json.dumps({'rows': list(rows.values())}, indent=1) + '\n')
        print(rows[scene, transport, arguments.size], flush=True)


if __name__ == '__main__':
    main()
