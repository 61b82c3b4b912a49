"""Means of 8×8 blocks and their standard errors; blocks at the right and lower edge may be smaller."""

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
SIDE = 8
# A block counts as lit above this share of the image's mean.
LIT = 0.02


def sums(image):
    """Sum over each block of a (height, width) array."""
    rows = np.add.reduceat(image, np.arange(0, image.shape[0], SIDE), axis=0)
    return np.add.reduceat(rows, np.arange(0, image.shape[1], SIDE), axis=1)


def statistics(value, error):
    """(mean, standard error, lit) of the blocks of one channel and its pixelwise standard error."""
    count = sums(np.ones_like(value))
    mean = sums(value) / count
    return mean, np.sqrt(sums(error**2)) / count, mean > LIT * value.mean()


def luminance(mean, error):
    """Of RGB and its standard error; the channels share their paths, so their errors add up."""
    return mean @ LUMINANCE, error @ LUMINANCE
