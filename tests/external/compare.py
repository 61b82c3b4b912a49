"""Does an image agree with a reference? Both are EXR files with their own errors.

    python compare.py reference.exr ours.exr        exit code 0 when they agree, 1 when not, or when too noisy to say

Errors are read from SE.R … (standard error) or Variance.R … (variance of the mean). They agree when
- the means of R, G, B and luminance agree within 0.5 %,
- every resolved block (8×8 pixels) agrees within 2 %, in each of the four; resolved: combined standard error at most
  0.7 % of the reference,
- at least 90 % of the lit blocks (brighter than 2 % of the mean) are resolved in luminance.
"""

import sys

import numpy as np
import OpenEXR

import blocks

MEAN, BLOCK, RESOLVED, SHARE = 0.005, 0.02, 0.007, 0.9


def read(path):
    """(mean, standard error) of R, G, B."""
    with OpenEXR.File(path, separate_channels=True) as file:
        layers = {name: channel.pixels.astype(np.float64) for name, channel in file.channels().items()}
    rgb = np.stack([layers[c] for c in 'RGB'], -1)
    if 'SE.R' in layers:
        return rgb, np.stack([layers[f'SE.{c}'] for c in 'RGB'], -1)
    if 'Variance.R' in layers:
        return rgb, np.sqrt(np.stack([layers[f'Variance.{c}'] for c in 'RGB'], -1))
    sys.exit(f'{path}: neither SE.R nor Variance.R; it has {", ".join(layers)}')


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    (theirs, their_error), (ours, our_error) = read(sys.argv[1]), read(sys.argv[2])
    if theirs.shape != ours.shape:
        sys.exit(f'sizes differ: {theirs.shape} and {ours.shape}')
    channels = [(c, theirs[..., i], their_error[..., i], ours[..., i], our_error[..., i]) for i, c in enumerate('RGB')]
    channels.append(('luminance', *blocks.luminance(theirs, their_error), *blocks.luminance(ours, our_error)))
    agree = True
    for name, value, error, our_value, our_spread in channels:
        mean = our_value.mean() / value.mean() - 1
        noise = np.sqrt((error**2 + our_spread**2).sum()) / value.sum()
        block, spread, lit = blocks.statistics(value, error)
        our_block, our_block_spread, _ = blocks.statistics(our_value, our_spread)
        resolved = lit & (np.hypot(spread, our_block_spread) <= RESOLVED * block)
        apart = np.abs(our_block[resolved] / block[resolved] - 1)
        worst = apart.max() if resolved.any() else np.nan
        share = resolved.sum() / lit.sum()
        noisy = name == 'luminance' and share < SHARE
        apart_somewhere = not abs(mean) <= MEAN or worst > BLOCK  # so written that NaN fails
        agree &= not (noisy or apart_somewhere)
        verdict = 'FAIL ' if apart_somewhere else 'noisy' if noisy else 'ok   '
        print(f'{verdict} {name:9} mean {100 * mean:+.3f} % ± {100 * noise:.3f} %, resolved '
              f'{resolved.sum()} of {lit.sum()} lit blocks, largest difference {100 * worst:.2f} %, '
              f'{np.sum(apart > BLOCK)} beyond {100 * BLOCK:.0f} %')
    return 0 if agree else 1


if __name__ == '__main__':
    sys.exit(main())
