"""Images as Cycles shows them. It interpolates encoded values, lull light: where neighbouring pixels differ much, the materials get
finer images. Colours count by their alpha, and fully where no node asks for it."""
import os
from concurrent.futures import Future, ThreadPoolExecutor
from typing import NamedTuple

import bpy
import numpy as np

from .glb import png

_APART = 0.01  # of its mean, by which an image is lighter in lull
_FINER = 4  # times as fine
_COARSE, _FINE, _LARGEST, _READ = 256, 2048, 4096, 8192  # pixels across: at least, at most, of any that are changed, of any that are read
_ROWS = 64  # that are compared
_BAND = 32  # rows that are made at once, which stay in the cache
_GREY = 0.01  # of the numbers, by which channels of a grey image may differ
_SUFFIXES = {b"\x89PNG": ".png", b"\xff\xd8\xff": ".jpg"}  # by the first bytes


class Picture(NamedTuple):
    """An image of a file; its bytes, a future, are in the making."""
    name: str
    suffix: str
    data: Future


def missing(image):
    """Returns where the file of an image should be, if nothing is known of it; "" without an image, else None."""
    if image is None or image.source != 'FILE' or image.packed_file or image.is_dirty:
        return "" if image is None else None
    path = os.path.normpath(bpy.path.abspath(image.filepath, library=image.library))
    return None if os.path.isfile(path) else path


def _stored(image):
    """Returns the PNG or JPEG that an image was read from; None without one, or if it has been changed."""
    if image.is_dirty or image.source != 'FILE':
        return None
    data = None
    if image.packed_file:
        data = image.packed_file.data
    elif os.path.isfile(path := bpy.path.abspath(image.filepath, library=image.library)):
        with open(path, "rb") as f:
            data = f.read()
    return data if data and data.startswith(tuple(_SUFFIXES)) else None


def _bytes_of(pixels):
    """Returns encoded values as bytes, the upper row first, without an alpha of 1."""
    if pixels.dtype == np.uint8:
        values = pixels[::-1]
    else:
        values = np.empty(pixels.shape, np.uint8)
        for y in range(0, len(pixels), _BAND):
            values[y:y + _BAND] = np.clip(pixels[y:y + _BAND], 0, 1) * 255 + 0.5
        values = values[::-1]
    return values[:, :, :3] if values.shape[2] == 4 and values[:, :, 3].min() == 255 else values


def numbers_of(image):
    """Returns the stored numbers of an image."""
    width, height = image.size
    values = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)


class Images:
    """The images of an export, each read once. PNGs are compressed by a level of zlib, beside all else."""

    def __init__(self, level, notes):
        self._level, self._notes, self._made, self._pool = level, notes, {}, ThreadPoolExecutor()

    def of_pixels(self, name, pixels):
        """Returns the picture of encoded values, the lowest row first."""
        return self._picture(name, lambda: pixels)

    def _picture(self, name, make, suffix=".png"):
        """Returns a picture; `make()` returns its bytes or its pixels."""
        def data():
            made = make()
            return made if isinstance(made, bytes) else png(_bytes_of(made), self._level)

        return Picture(name, suffix, self._pool.submit(data))

    def numbers_of(self, image):
        return self._once(("numbers", image), lambda: numbers_of(image))

    def is_grey(self, image):
        """Returns whether the channels of an image are the same, as far as it can be read."""
        if image.channels == 1 or max(image.size) > _READ:
            return image.channels == 1
        return self._once(("grey", image), lambda: bool(
            np.ptp(self.numbers_of(image)[::max(1, image.size[1] // _ROWS), :, :3], axis=-1).max() < _GREY))

    def data(self, image):
        """Returns the picture of an image that is no colour."""
        return self._once(("data", image), lambda: self._of_file(image))

    def colour(self, node, asks_alpha, material):
        """Returns the picture that interpolated light shows as Cycles shows the image of a node."""
        how = node.extension == 'REPEAT', node.interpolation == 'Closest', asks_alpha
        made = self._once((node.image, *how), lambda: self._colour(node.image, *how))
        if made is None:
            self._notes.add("lighter along the edges in their images", material, "materials")
            return self.data(node.image)
        return made

    def _of_file(self, image):
        stored = _stored(image)
        if stored is None:
            return self.of_pixels(image.name, numbers_of(image))
        return self._picture(image.name, lambda: stored, next(s for start, s in _SUFFIXES.items() if stored.startswith(start)))

    def _once(self, key, make):
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]

    def _colour(self, image, wraps, is_sharp, asks_alpha):
        across = max(image.size)
        if image.is_float or image.colorspace_settings.name != 'sRGB' or across > _READ:
            return self.data(image)
        pixels = numbers_of(image)
        has_alpha = image.alpha_mode in ('STRAIGHT', 'PREMUL') and image.depth == 32 and pixels[:, :, 3].min() < 1
        if has_alpha:
            pixels[:, :, :3] *= pixels[:, :, 3:]
        else:
            pixels[:, :, 3] = 1
        divides = has_alpha and asks_alpha
        if not is_sharp and _lighter(pixels, divides) > _APART:
            if across > _LARGEST:
                return None
            times = max(1, min(max(_FINER, _COARSE // across), _FINE // across))
            kept = pixels if divides else _bytes_of(pixels[::-1, :, :3])
            return self._picture(image.name, lambda: _finer(kept, times, wraps))
        if not has_alpha or asks_alpha:
            return self.data(image)
        return self.of_pixels(image.name, pixels[:, :, :3])


def _finer(pixels, times, wraps):
    """Returns the bytes of interpolated pixels, each the mean of the light of its square; where they have an alpha, colours are divided
    by it."""
    if times == 1 and pixels.dtype == np.uint8:
        return _of_light(np.pad(pixels, ((1, 1), (1, 1), (0, 0)), 'wrap' if wraps else 'edge'))
    if pixels.dtype == np.uint8:
        pixels = pixels.astype(np.float32) / 255
    count = times * len(pixels)
    return np.concatenate([_finer_band(pixels, times, wraps, slice(at, at + _BAND)) for at in range(0, count, _BAND)])


def _of_light(padded):
    """Does so for bytes of the same size, with one more on each side."""
    made = np.empty_like(padded[1:-1, 1:-1])
    for y in range(0, len(made), _BAND):
        rows = padded[y:y + _BAND + 2].astype(np.uint16)
        middle = 3 * rows[1:-1]
        total = 0
        for row in middle + rows[:-2], middle + rows[2:]:
            inner = 3 * row[:, 1:-1]
            total = total + _LIGHT_OF_16[inner + row[:, :-2]] + _LIGHT_OF_16[inner + row[:, 2:]]
        made[y:y + _BAND] = _ENCODED[(total * (65535 / 4) + 0.5).astype(np.uint16)]
    return made


def _finer_band(pixels, times, wraps, band):
    total = 0
    for y in 0.25, 0.75:
        rows = _interpolated(pixels, times, y, wraps, 0, band)
        for x in 0.25, 0.75:
            at = _interpolated(rows, times, x, wraps, 1)
            if pixels.shape[2] == 4:
                at[:, :, :3] /= np.maximum(at[:, :, 3:], 1e-6)
            found = _LIGHT[(at * _STEPS + 0.5).astype(np.uint16)]
            if pixels.shape[2] == 4:
                found[:, :, 3] = at[:, :, 3]
            total += found
    total *= 0.25
    made = _ENCODED[(total * 65535 + 0.5).astype(np.uint16)]
    if pixels.shape[2] == 4:
        made[:, :, 3] = total[:, :, 3] * 255 + 0.5
    return made


def _interpolated(values, times, offset, wraps, axis, band=slice(None)):
    """Returns the values at `offset` in each of `times` parts of a pixel, along an axis."""
    count = values.shape[axis]
    at = (np.arange(times * count)[band] + offset) / times - 0.5
    low = np.floor(at).astype(int)
    share = (at - low).astype(np.float32).reshape([-1 if i == axis else 1 for i in range(3)])
    first, second = ((i % count if wraps else np.clip(i, 0, count - 1)) for i in (low, low + 1))
    made, other = values.take(first, axis), values.take(second, axis)
    other -= made
    other *= share
    made += other
    return made


def _lighter(pixels, divides):
    """Returns by how much the interpolated light is lighter than the light of interpolated values, by the mean."""
    step = max(1, len(pixels) // _ROWS)
    rows = pixels[:-1:step], pixels[1::step]
    rows = [r[:min(len(rows[0]), len(rows[1]))] for r in rows]
    if len(rows[0]) == 0 or pixels.shape[1] < 2:
        return 0
    corners = [r[:, side] for r in rows for side in (slice(None, -1), slice(1, None))]
    lights = [_light(c, divides) for c in corners]
    encoded = light = 0
    for a in (0.25, 0.75):
        for b in (0.25, 0.75):
            shares = (1 - a) * (1 - b), (1 - a) * b, a * (1 - b), a * b
            encoded += _weighed(_light(sum(s * c for s, c in zip(shares, corners)), divides))
            light += _weighed(sum(s * c for s, c in zip(shares, lights)))
    return light / max(encoded, 1e-9) - 1


def _weighed(light):
    return float((light[:, :, :3] * light[:, :, 3:]).mean())


def _light(pixels, divides):
    """Returns the light of encoded colours, which are divided by their alpha where that is asked for."""
    colours, alpha = pixels[:, :, :3], pixels[:, :, 3:]
    if divides:
        colours = colours / np.where(alpha > 0, alpha, 1)
    return np.concatenate([_LIGHT[(np.clip(colours, 0, 1) * _STEPS + 0.5).astype(np.uint16)], alpha], 2)


def decoded(values):
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0.04045) + 0.055) / 1.055) ** 2.4)


def encoded(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


_STEPS = 4096  # of encoded values
_LIGHT = decoded(np.arange(_STEPS + 1) / _STEPS).astype(np.float32)
_LIGHT_OF_16 = decoded(np.arange(16 * 255 + 1) / (16 * 255)).astype(np.float32)  # of the sum of 16 bytes
_ENCODED = (encoded(np.arange(65536) / 65535) * 255 + 0.5).astype(np.uint8)
