"""Images as Cycles shows them. It interpolates encoded values, lull light: where neighbouring pixels differ much, the materials get
finer images. Colours count by their alpha, and fully where no node asks for it."""
import bpy
import numpy as np

_APART = 0.01  # of its mean, by which an image is lighter in lull
_FINER = 4  # times as fine
_COARSE, _FINE, _LARGEST, _READ = 256, 2048, 4096, 8192  # pixels across: at least, at most, of any that are changed, of any that are read
_ROWS = 256  # that are compared
_GREY = 0.01  # of the numbers, by which channels of a grey image may differ
_replaced = {}  # None: by the same; whether images are grey


def numbers_of(image):
    """Returns the stored numbers of an image."""
    width, height = image.size
    values = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)


def made_of(pixels, name, colours, has_alpha=False):
    """Returns a new image of encoded values."""
    made = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=has_alpha)
    made.colorspace_settings.name = colours
    made.pixels.foreach_set(pixels.astype(np.float32).ravel())
    made.update()
    made.pack()
    return made


def is_grey(image):
    """Returns whether the channels of an image are the same, as far as it can be read."""
    if image.channels == 1 or max(image.size) > _READ:
        return image.channels == 1
    if ("grey", image) not in _replaced:
        colours = numbers_of(image)[::max(1, image.size[1] // _ROWS), :, :3]
        _replaced["grey", image] = bool(np.ptp(colours, axis=-1).max() < _GREY)
    return _replaced["grey", image]


def prepare(tree, name, notes):
    """Replaces images in the nodes of a material's copy. `name` is that of the material."""
    for node in tree.nodes:
        if node.type != 'TEX_IMAGE' or node.image is None or node.image.size[0] == 0 or node.image.is_float or \
                node.image.source not in ('FILE', 'GENERATED') or node.image.colorspace_settings.name != 'sRGB':
            continue
        wraps, is_sharp = node.extension == 'REPEAT', node.interpolation == 'Closest'
        replaced = _shown(node.image, wraps, is_sharp, bool(node.outputs['Alpha'].links))
        if replaced == 'TOO LARGE':
            notes.add("lighter along the edges in their images", name, "materials")
        elif replaced is not None:
            node.image = replaced


def _shown(image, *how):
    """Returns the image that interpolated light shows as Cycles shows `image`; None for the same, 'TOO LARGE' for none."""
    if (image, *how) not in _replaced:
        _replaced[image, *how] = _made(image, *how)
    return _replaced[image, *how]


def _made(image, wraps, is_sharp, asks_alpha):
    across = max(image.size)
    if across > _READ:
        return None
    pixels = numbers_of(image)
    has_alpha = image.alpha_mode in ('STRAIGHT', 'PREMUL') and image.depth == 32 and pixels[:, :, 3].min() < 1
    if has_alpha:
        pixels[:, :, :3] *= pixels[:, :, 3:]
    else:
        pixels[:, :, 3] = 1
    if not is_sharp and _lighter(pixels, has_alpha and asks_alpha) > _APART:
        if across > _LARGEST:
            return 'TOO LARGE'
        times = max(1, min(max(_FINER, _COARSE // across), _FINE // across))
        pixels = _finer(pixels, times, wraps, has_alpha and asks_alpha)
    elif not has_alpha or asks_alpha:
        return None
    if not asks_alpha:
        pixels[:, :, 3] = 1
    return made_of(pixels, image.name, 'sRGB', has_alpha and asks_alpha)


def _finer(pixels, times, wraps, divides):
    """Returns the interpolated pixels, each the mean of the light of its square."""
    total = 0
    for y in 0.25, 0.75:
        for x in 0.25, 0.75:
            total = total + _light(_interpolated(_interpolated(pixels, times, y, wraps, 0), times, x, wraps, 1), divides) / 4
    return np.concatenate([encoded(total[:, :, :3]), total[:, :, 3:]], 2)


def _interpolated(values, times, offset, wraps, axis):
    """Returns the values at `offset` in each of `times` parts of a pixel, along an axis."""
    count = values.shape[axis]
    at = (np.arange(times * count) + offset) / times - 0.5
    low = np.floor(at).astype(int)
    share = (at - low).astype(np.float32).reshape([-1 if i == axis else 1 for i in range(3)])
    first, second = ((i % count if wraps else np.clip(i, 0, count - 1)) for i in (low, low + 1))
    return values.take(first, axis) * (1 - share) + values.take(second, axis) * share


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
    colours = np.where(colours <= 0.04045, colours / 12.92, ((np.maximum(colours, 0.04045) + 0.055) / 1.055) ** 2.4)
    return np.concatenate([colours, alpha], 2)


def encoded(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
