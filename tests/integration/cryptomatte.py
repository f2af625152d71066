"""Reads the Cryptomattes and the alpha of a render as compositors do.

Knows nothing of lull but its command line and its reader of EXR files: hashes are made by Appleby's MurmurHash3, masks by the
Cryptomatte specification 1.2.0.

    cryptomatte.py LULL
"""
import base64
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / 'renderer/python/lull'))
import exr  # noqa: E402

WIDTH, HEIGHT = 40, 20


def murmur(text):
    data, h, mask = text.encode(), 0, 0xffffffff

    def mixed(k):
        k = k * 0xcc9e2d51 & mask
        return ((k << 15 | k >> 17) & mask) * 0x1b873593 & mask

    whole = len(data) // 4 * 4
    for k, in struct.iter_unpack('<I', data[:whole]):
        h ^= mixed(k)
        h = ((h << 13 | h >> 19) * 5 + 0xe6546b64) & mask
    if data[whole:]:
        h ^= mixed(int.from_bytes(data[whole:], 'little'))
    h ^= len(data)
    for shift, factor in (16, 0x85ebca6b), (13, 0xc2b2ae35), (16, 1):
        h = (h ^ h >> shift) * factor & mask
    return h


def id_of(text):
    h = murmur(text)
    return h ^ 1 << 23 if h >> 23 & 255 in (0, 255) else h


def mattes(texts, channels, layer):
    """Returns the masks of a layer: for each name of its manifest the coverage."""
    key = f'cryptomatte/{id_of(layer):08x}'[:len('cryptomatte/') + 7]
    assert texts[key + '/name'] == layer.encode()
    assert texts[key + '/hash'] == b'MurmurHash3_32'
    assert texts[key + '/conversion'] == b'uint32_to_float32'
    manifest = {n: int(h, 16) for n, h in json.loads(texts[key + '/manifest']).items()}
    for name, number in manifest.items():
        assert number == id_of(name), name
    masks = {n: np.zeros((HEIGHT, WIDTH)) for n in manifest}
    before = np.ones((HEIGHT, WIDTH))
    for rank in range(6):
        numbers = channels[f'{layer}{rank // 2:02}.{"RB"[rank % 2]}'].view(np.uint32)  # ids are compared as bits
        shares = channels[f'{layer}{rank // 2:02}.{"GA"[rank % 2]}']
        assert (0 <= shares).all() and (shares <= before + 1e-6).all(), 'ranks are not in order'
        assert set(numbers[shares > 0]) <= set(manifest.values())
        for name, number in manifest.items():
            masks[name] += np.where(numbers == number, shares, 0)
        before = shares
    return masks


def read_png(path):
    """Returns rows of bytes R, G, B, A of a PNG."""
    data, at, packed = path.read_bytes(), 8, b''
    while at < len(data):
        size, = struct.unpack_from('>I', data, at)
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        if kind == b'IHDR':
            assert struct.unpack('>IIBBBBB', body) == (WIDTH, HEIGHT, 8, 6, 0, 0, 0)
        if kind == b'IDAT':
            packed += body
        at += 12 + size
    raw, stride, rows = zlib.decompress(packed), 4 * WIDTH, []
    above = bytearray(stride)
    for y in range(HEIGHT):
        start = y * (stride + 1)
        row = bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride):
            left, up, corner = (row[i - 4], above[i], above[i - 4]) if i > 3 else (0, above[i], 0)
            paeth = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, paeth)[raw[start]]) & 255
        rows.append(row)
        above = row
    return rows


def write_scene(path):
    """Squares in front of a camera that sees from -2 to 2 and from -1 to 1: one unit is 10 pixels.

    The left ones share a mesh; "fröhlich" covers half of the pixels at its right edge, where "right"
    begins, and "left" a quarter of those at its upper edge. What lies above is empty.
    """
    square = struct.pack('<12f', 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0) + struct.pack(
        '<6H', 0, 1, 2, 0, 2, 3)

    def matte(name):
        return {'name': name, 'pbrMetallicRoughness': {'baseColorFactor': [0.5, 0.5, 0.5, 1],
                                                       'metallicFactor': 0}}

    def primitive(material):
        return {'attributes': {'POSITION': 0}, 'indices': 1, 'material': material}

    scene = {
        'asset': {'version': '2.0'},
        'scene': 0,
        'scenes': [{'nodes': [0, 1, 2, 3]}],
        'nodes': [
            {'name': 'left', 'mesh': 0, 'translation': [-2, -1, 0], 'scale': [1, 1.025, 1]},
            {'name': 'fröhlich', 'mesh': 0, 'translation': [-1, -1, 0], 'scale': [1.05, 1, 1]},
            {'name': 'right', 'mesh': 1, 'translation': [0.05, -1, 0], 'scale': [1.95, 1, 1]},
            {'camera': 0, 'translation': [0, 0, 3]},
        ],
        'meshes': [{'name': 'twice', 'primitives': [primitive(0)]},
                   {'name': 'once', 'primitives': [primitive(1)]}],
        'materials': [matte('clay'), matte('paper')],
        'cameras': [{'type': 'orthographic',
                     'orthographic': {'xmag': 2, 'ymag': 1, 'znear': 0, 'zfar': 9}}],
        'accessors': [
            {'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3'},
            {'bufferView': 1, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'}],
        'bufferViews': [{'buffer': 0, 'byteLength': 48},
                        {'buffer': 0, 'byteOffset': 48, 'byteLength': 12}],
        'buffers': [{'byteLength': 60, 'uri': 'data:application/octet-stream;base64,' +
                     base64.b64encode(square).decode()}],
    }
    path.write_text(json.dumps(scene))


def near(value, wanted, tolerance=0.02):
    assert abs(value - wanted) <= tolerance, f'{value} instead of {wanted}'


def main(lull):
    for text, wanted in (('', 0), ('hello', 0x248bfa47), ('hello, world', 0x149bbb7f),
                         ('The quick brown fox jumps over the lazy dog', 0x2e4ff723)):
        assert murmur(text) == wanted, text
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_scene(folder / 'scene.gltf')
        subprocess.run([lull, 'render', 'scene.gltf', '--resolution', f'{WIDTH}x{HEIGHT}', '--spp',
                        '256', '--sampler', 'sobol', '--aov', 'cryptomatte', '--transparent',
                        '--quiet', '-o', 'out.exr'],
                       cwd=folder, check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        channels, texts = exr.read(folder / 'out.exr')
        assert b'/manifest\0string\0' in (folder / 'out.exr').read_bytes()
        objects = mattes(texts, channels, 'CryptoObject')
        materials = mattes(texts, channels, 'CryptoMaterial')
        alpha, red = channels['A'], channels['R']
        png = read_png(folder / 'out.png')

    assert set(objects) == {'left', 'fröhlich', 'right'}, set(objects)
    assert set(materials) == {'clay', 'paper'}, set(materials)
    # Inside, at the edge that two share, at the upper edge of the first, above it.
    for (x, y), shares in {(5, 15): (1, 0, 0), (15, 15): (0, 1, 0), (30, 15): (0, 0, 1),
                           (20, 15): (0, 0.5, 0.5), (5, 9): (0.25, 0, 0),
                           (5, 3): (0, 0, 0)}.items():
        for name, share in zip(('left', 'fröhlich', 'right'), shares):
            near(objects[name][y][x], share)
        near(materials['clay'][y][x], shares[0] + shares[1])
        near(materials['paper'][y][x], shares[2])
        near(alpha[y][x], sum(shares))
        assert png[y][4 * x + 3] == int(255 * alpha[y][x] + 0.5)
    near(np.abs(sum(objects.values()) - alpha).max(), 0, 1e-5)
    # Colours are multiplied by alpha in the EXR, and are not in the PNG.
    assert red[3][5] == 0 and red[15][5] > 0.05
    near(red[9][5] / alpha[9][5], red[15][5], 0.15 * red[15][5])
    assert abs(png[9][4 * 5] - png[15][4 * 5]) < 25
    assert png[3][4 * 5:4 * 6] == bytes(4)


main(sys.argv[1])
