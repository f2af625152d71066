"""Reads images, and converts them to lightness."""

import sys

import numpy as np
import OpenImageIO as oiio

WEIGHTS = np.array([0.212671, 0.715160, 0.072169])  # of linear R, G and B in the luminance


def read(path):
    """Returns the RGB of an EXR, and the samples per pixel in [0, 1] of all or as they are."""
    image = oiio.ImageBuf(path)
    if image.has_error:
        sys.exit(image.geterror())
    names = [name.split('.', 1)[-1] for name in image.spec().channelnames]
    pixels = np.asarray(image.get_pixels(oiio.FLOAT), np.float64)
    named = {name: pixels[:, :, i] for i, name in enumerate(names)}
    # `R` itself comes before the R of a layer, as of the samples of a denoised picture.
    named.update({name: pixels[:, :, i] for i, name in enumerate(image.spec().channelnames)})
    rgb = np.stack([named[n] if n in named else named['Combined.' + n] for n in 'RGB'], 2)
    return rgb, named.get('spp', named.get('Debug Sample Count.X'))


def lightness(rgb):
    """Returns CIE 1976 lightness, 0 to 100, of linear RGB on a display."""
    y = np.clip(rgb, 0, 1) @ WEIGHTS
    return 116 * np.where(y > 0.008856, np.cbrt(y), 7.787 * y + 16 / 116) - 16
