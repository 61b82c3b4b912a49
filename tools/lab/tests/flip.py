"""Expected values of tests/flip.rs: means of the authors' own FLIP on images that this script and the test draw alike.

    python3 -m venv v && v/bin/pip install flip-evaluator==1.7 && v/bin/python flip.py > flip.json
"""

import json
from importlib.metadata import version

import flip_evaluator
import numpy as np

MASK = (1 << 64) - 1


class SplitMix:
    """SplitMix64, as stats/rng.rs has it."""

    def __init__(self, seed):
        self.state = seed

    def bits(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return z ^ (z >> 31)

    def uniform(self):
        """24 bits, so that every value is exact in 32-bit floats."""
        return (self.bits() >> 40) / (1 << 24)


def picture(seed, size, noise, stops):
    """Blocks of flat colour, with noise on every pixel, and every block a whole number of stops brighter or darker."""
    rng = SplitMix(seed)
    width, height = size
    across = (width + 7) // 8
    blocks = across * ((height + 7) // 8)
    color = [[rng.uniform() for _ in range(3)] for _ in range(blocks)]
    scale = [2.0 ** int(rng.bits() % (2 * stops + 1) - stops) for _ in range(blocks)]
    image = np.empty((height, width, 3), np.float32)
    for y in range(height):
        for x in range(width):
            block = (y // 8) * across + x // 8
            for c in range(3):
                grain = noise * rng.uniform()
                image[y, x, c] = np.float32(scale[block]) * (np.float32(color[block][c]) + np.float32(grain))
    return image


CASES = [
    # range, size, then seed, noise and stops of the image and of the reference
    ('LDR', (40, 24), (1, 0.25, 0), (1, 0.0, 0)),
    ('LDR', (64, 48), (2, 0.0, 0), (3, 0.0, 0)),
    ('LDR', (7, 5), (4, 0.5, 0), (5, 0.5, 0)),
    ('LDR', (33, 17), (6, 0.03125, 0), (6, 0.0, 0)),
    ('HDR', (40, 24), (7, 0.25, 3), (7, 0.0, 3)),
    ('HDR', (64, 48), (8, 0.0, 6), (9, 0.0, 6)),
    ('HDR', (33, 17), (10, 2.0, 8), (10, 0.0, 8)),
]

results = []
for dynamic_range, size, image, reference in CASES:
    parts = [picture(seed, size, noise, stops) for seed, noise, stops in (image, reference)]
    _, mean, _ = flip_evaluator.evaluate(parts[1], parts[0], dynamic_range, inputsRGB=False, applyMagma=False)
    describe = lambda part: dict(zip(('seed', 'noise', 'stops'), part))
    results.append({'range': dynamic_range, 'size': size, 'image': describe(image), 'reference': describe(reference), 'mean': mean})
print(json.dumps({'made_with': f'flip-evaluator {version("flip-evaluator")}', 'cases': results}, indent=1))
