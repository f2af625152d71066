"""Runs the networks of Open Image Denoise 2 by numpy, from their weight files (.tza).

What its filter RT does at quality high with prefiltered features: albedo and normals are denoised first, each by a
network of its own, and with them the colours, exposed to a mean of 0.18 and encoded by the PU curve (Aydin et al.,
Extending Quality Metrics to Full Luminance Range Images, 2008). Images are height x width x 3; arrays inside channels x
height x width. How long it takes says nothing about Open Image Denoise.
"""

import struct

import numpy as np

from measure import WEIGHTS

BRIGHTEST = 65504.0  # that the encoding maps to 1


def read_weights(path):
    """Returns the arrays of a .tza file by their names."""
    data = open(path, 'rb').read()
    magic, version, _, at = struct.unpack_from('<HBBQ', data)
    if magic != 0x41D7 or version != 2:
        raise ValueError(f'{path}: is not a file of weights, version 2')
    count, = struct.unpack_from('<I', data, at)
    at, weights = at + 4, {}
    for _ in range(count):
        length, = struct.unpack_from('<H', data, at)
        name = data[at + 2:at + 2 + length].decode()
        at += 2 + length
        dimensions = data[at]
        shape = struct.unpack_from(f'<{dimensions}I', data, at + 1)
        at += 1 + 5 * dimensions  # behind the shape a letter for the meaning of each dimension
        kind, offset = {'f': np.float32, 'h': np.float16}[chr(data[at])], struct.unpack_from('<Q', data, at + 1)[0]
        at += 9
        weights[name] = np.frombuffer(data, kind, int(np.prod(shape)), offset).reshape(shape).astype(np.float32)
    return weights


def convolve(x, weights, name, relu=True):
    """A convolution of 3x3, with zeros around the image."""
    kernel, (channels, height, width) = weights[name + '.weight'], x.shape
    around = np.pad(x, ((0, 0), (1, 1), (1, 1)))
    out = np.repeat(weights[name + '.bias'][:, None], height * width, 1)
    for i in range(3):
        for j in range(3):
            out += kernel[:, :, i, j] @ around[:, i:i + height, j:j + width].reshape(channels, -1)
    out = out.reshape(-1, height, width)
    return np.maximum(out, 0) if relu else out


def halve(x):
    return x.reshape(x.shape[0], x.shape[1] // 2, 2, x.shape[2] // 2, 2).max((2, 4))


def double(x):
    return x.repeat(2, 1).repeat(2, 2)


def infer(x, weights):
    """The U-Net, small or large, as its layers are named. Height and width are multiples of 16."""
    if 'enc_conv1a.weight' in weights:  # large
        down = ['1a 1b', '2a 2b', '3a 3b', '4a 4b']
        last = ['dec_conv1a', 'dec_conv1b', 'dec_conv1c']
    else:
        down = ['0 1', '2', '3', '4']
        last = ['dec_conv1a', 'dec_conv1b', 'dec_conv0']
    levels = [x]
    for layers in down:
        for layer in layers.split():
            x = convolve(x, weights, 'enc_conv' + layer)
        x = halve(x)
        levels.append(x)
    for layer in 'enc_conv5a', 'enc_conv5b':
        x = convolve(x, weights, layer)
    for level in 4, 3, 2:
        x = np.concatenate((double(x), levels[level - 1]))
        for part in 'ab':
            x = convolve(x, weights, f'dec_conv{level}{part}')
    x = np.concatenate((double(x), levels[0]))
    for layer in last:
        x = convolve(x, weights, layer, relu=layer != last[-1])
    return np.maximum(x, 0)


def curve(y):
    """The PU curve, a fit of Open Image Denoise."""
    return np.where(y <= 1.57945760e-06, 1.41283765e+03 * y,
                    np.where(y <= 3.22087631e-02, 1.64593172 * np.power(y, 4.31384981e-01) - 2.94139609e-03,
                             1.92653254e-01 * np.log(y + 6.26026094e-03) + 9.98620152e-01))


SCALE = float(curve(np.array(BRIGHTEST)))


def encode(y):
    return curve(y) / SCALE


def decode(x):
    x = x * SCALE
    power = np.power(np.maximum(x + 2.94139609e-03, 0) / 1.64593172, 1 / 4.31384981e-01)
    return np.where(x <= 2.23151711e-03, x / 1.41283765e+03,
                    np.where(x <= 3.70974749e-01, power,
                             np.exp((x - 9.98620152e-01) / 1.92653254e-01) - 6.26026094e-03))


def exposure(rgb):
    """What brings the geometric mean of the luminance, over squares of some 16x16 pixels, to 0.18."""
    luminance = rgb @ WEIGHTS
    rows = np.array_split(luminance, -(-luminance.shape[0] // 16))
    means = np.array([part.mean() for row in rows for part in np.array_split(row, -(-luminance.shape[1] // 16), 1)])
    means = means[means > 1e-8]
    return 0.18 / np.exp(np.log(means).mean()) if len(means) else 1.0


def denoise(rgb, albedo, normal, folder, size):
    """Denoises colours with their features; `size` is '' or '_large', part of the weight files' names."""
    height, width, _ = rgb.shape

    def planes(image):
        return np.pad(image.transpose(2, 0, 1).astype(np.float32), ((0, 0), (0, -height % 16), (0, -width % 16)))

    features = [np.clip(infer(planes(image), read_weights(f'{folder}/rt_{name}{size}.tza')), 0, 1)
                for name, image in (('alb', np.clip(albedo, 0, 1)), ('nrm', np.clip(normal, -1, 1) / 2 + 0.5))]
    rgb = np.maximum(rgb, 0)
    scale = exposure(rgb)
    out = infer(np.concatenate((planes(encode(rgb * scale)), *features)),
                read_weights(f'{folder}/rt_hdr_calb_cnrm{size}.tza'))
    return decode(out[:, :height, :width].transpose(1, 2, 0).astype(np.float64)) / scale
