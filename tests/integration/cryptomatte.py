"""Reads the Cryptomattes and the alpha of a render as compositors do.

Knows nothing of lull but its command line: EXR files are read here by the OpenEXR file layout, hashes
made by Appleby's MurmurHash3, masks by the Cryptomatte specification 1.2.0.

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

WIDTH, HEIGHT = 40, 20


def read_exr(path):
    """Returns attributes and channels (rows of values) of a scan-line file of floats with ZIP."""
    data = path.read_bytes()
    magic, version = struct.unpack_from('<II', data)
    assert magic == 20000630 and version & 0xff == 2 and not version & 0x1a00, 'no plain EXR'
    at = 8

    def text():
        nonlocal at
        end = data.index(b'\0', at)
        value = data[at:end].decode()
        at = end + 1
        return value

    attributes = {}
    while name := text():
        kind = text()
        size, = struct.unpack_from('<I', data, at)
        attributes[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    left, top, right, bottom = struct.unpack('<4i', attributes['dataWindow'][1])
    width, height = right - left + 1, bottom - top + 1
    compression = attributes['compression'][1][0]
    lines = {0: 1, 2: 1, 3: 16}[compression]
    names, raw, place = [], attributes['channels'][1], 0
    while raw[place]:
        end = raw.index(b'\0', place)
        kind, = struct.unpack_from('<I', raw, end + 1)
        assert kind == 2, 'a channel is not of 32-bit floats'
        names.append(raw[place:end].decode())
        place = end + 17
    channels = {name: [None] * height for name in names}
    blocks = (height + lines - 1) // lines
    for offset in struct.unpack_from(f'<{blocks}Q', data, at):
        y, size = struct.unpack_from('<iI', data, offset)
        block = data[offset + 8:offset + 8 + size]
        count = min(lines, bottom + 1 - y)
        if compression and size < count * width * 4 * len(names):
            packed = bytearray(zlib.decompress(block))
            for i in range(1, len(packed)):
                packed[i] = (packed[i - 1] + packed[i] - 128) & 255
            half = (len(packed) + 1) // 2
            block = bytearray(len(packed))
            block[0::2], block[1::2] = packed[:half], packed[half:]
        for row in range(count):
            for i, name in enumerate(names):
                start = (row * len(names) + i) * width * 4
                channels[name][y - top + row] = bytes(block[start:start + width * 4])
    texts = {n: v.decode() for n, (kind, v) in attributes.items() if kind == 'string'}
    return texts, channels


def floats(rows):
    return [struct.unpack(f'<{len(row) // 4}f', row) for row in rows]


def ids(rows):
    """Ids are compared as bits."""
    return [struct.unpack(f'<{len(row) // 4}I', row) for row in rows]


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
    """Returns the masks of a layer: for each name of its manifest rows of coverage."""
    key = f'cryptomatte/{id_of(layer):08x}'[:len('cryptomatte/') + 7]
    assert texts[key + '/name'] == layer
    assert texts[key + '/hash'] == 'MurmurHash3_32'
    assert texts[key + '/conversion'] == 'uint32_to_float32'
    manifest = {n: int(h, 16) for n, h in json.loads(texts[key + '/manifest']).items()}
    for name, number in manifest.items():
        assert number == id_of(name), name
    masks = {n: [[0.0] * WIDTH for _ in range(HEIGHT)] for n in manifest}
    names = {number: name for name, number in manifest.items()}
    before = [[1.0] * WIDTH for _ in range(HEIGHT)]
    for rank in range(6):
        numbers = ids(channels[f'{layer}{rank // 2:02}.{"RB"[rank % 2]}'])
        shares = floats(channels[f'{layer}{rank // 2:02}.{"GA"[rank % 2]}'])
        for y in range(HEIGHT):
            for x in range(WIDTH):
                assert 0 <= shares[y][x] <= before[y][x] + 1e-6, 'ranks are not in order'
                before[y][x] = shares[y][x]
                if shares[y][x] > 0:
                    masks[names[numbers[y][x]]][y][x] += shares[y][x]
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
        texts, channels = read_exr(folder / 'out.exr')
        objects = mattes(texts, channels, 'CryptoObject')
        materials = mattes(texts, channels, 'CryptoMaterial')
        alpha, red = floats(channels['A']), floats(channels['R'])
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
    for y in range(HEIGHT):
        for x in range(WIDTH):
            near(sum(m[y][x] for m in objects.values()), alpha[y][x], 1e-5)
    # Colours are multiplied by alpha in the EXR, and are not in the PNG.
    assert red[3][5] == 0 and red[15][5] > 0.05
    near(red[9][5] / alpha[9][5], red[15][5], 0.15 * red[15][5])
    assert abs(png[9][4 * 5] - png[15][4 * 5]) < 25
    assert png[3][4 * 5:4 * 6] == bytes(4)


main(sys.argv[1])
