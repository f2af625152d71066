"""The images of the room: grain of wood, a kilim, spines of books, a print, weave, and two skies."""
import math
import random
import struct
import zlib


def write_png(path, width, height, pixel):
    """Writes an 8-bit PNG; pixel(x, y) returns 1 or 3 values in [0, 1]."""
    channels = len(pixel(0, 0))
    rows = b''
    for y in range(height):
        row = (max(0, min(255, round(255 * v))) for x in range(width) for v in pixel(x, y))
        rows += b'\0' + bytes(row)

    def chunk(kind, data):
        crc = struct.pack('>I', zlib.crc32(kind + data))
        return struct.pack('>I', len(data)) + kind + data + crc

    header = struct.pack('>IIBBBBB', width, height, 8, 2 if channels == 3 else 0, 0, 0, 0)
    path.write_bytes(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(rows, 9)) + chunk(b'IEND', b''))


def smooth(t):
    return t * t * (3 - 2 * t)


class Noise:
    """Value noise on a grid that repeats after width x height cells."""

    def __init__(self, seed, width, height):
        rng = random.Random(seed)
        self.cells = [[rng.random() for _ in range(width)] for _ in range(height)]

    def __call__(self, x, y):
        height, width = len(self.cells), len(self.cells[0])
        i, j = math.floor(x), math.floor(y)
        s, t = smooth(x - i), smooth(y - j)
        row = lambda r: (1 - s) * self.cells[r % height][i % width] + s * self.cells[r % height][(i + 1) % width]
        return (1 - t) * row(j) + t * row(j + 1)


def write_images(folder):
    size = 256
    fine, broad = Noise(1, 12, 128), Noise(2, 4, 12)

    def grain(x, y):
        u, v = x / size, y / size * 2
        v += .05 * (broad(4 * u, 6 * v) - .5)
        rings = .5 + .5 * math.sin(2 * math.pi * (9 * v + 2.2 * broad(4 * u, 12 * v)))
        return [round((.45 * rings ** 2 + .55 * fine(12 * u, 128 * v)) * 15) / 15]

    write_png(folder / 'grain.png', size, size // 2, grain)

    cream, rust, night, ochre, sage = ((.80, .74, .63), (.52, .20, .13), (.13, .17, .24), (.74, .52, .24),
                                       (.42, .47, .40))

    def kilim(x, y):
        u, v = abs(x - 79.5), abs(y - 53.5)
        edge = min(80 - u, 54 - v)
        if edge < 4:
            return rust
        if edge < 12:
            return (night if (x // 4 + y // 4) % 2 else ochre) if 6 <= edge < 10 else cream
        u, v = u // 2 * 2, v // 2 * 2
        ring = ((u % 44) - 22, v)
        d = (abs(ring[0]) * 1.5 + ring[1])
        if d < 7:
            return ochre
        if d < 14:
            return cream
        if d < 24:
            return rust
        if d < 30:
            return night
        return cream if d < 33 or (d > 44 and (x // 2 * 2 + y // 2 * 2) % 12 < 3) else sage

    wool = random.Random(8)
    write_png(folder / 'kilim.png', 160, 108, lambda x, y: [
        c * (1 - .12 * round(3 * t) / 3) for t in [wool.random()] for c in kilim(x, y)])

    bands = [[(.08, .11), (.84, .87)], [(.68, .82)], [(.06, .09), (.12, .13), (.70, .71), (.74, .82), (.85, .86)],
             [(.30, .74)]]

    def spine(x, y):
        n, v = x // 8, 1 - (y + .5) / 64
        inside = any(a < v < b for a, b in bands[n])
        if n == 3:  # a title, in letters
            inside = inside and 2 <= x % 8 <= 5 and (y * 7 + x * 3) % 5 < 3
        return [1. * inside]

    write_png(folder / 'spines.png', 32, 64, spine)

    hills = Noise(6, 7, 1)
    tones = (.60, .64, .60), (.38, .47, .47), (.22, .31, .34), (.72, .50, .28), (.16, .19, .22)

    def print_of_hills(x, y):
        u, v = x / 96, 1 - y / 128
        colour = (.86, .78, .66)
        if math.hypot(u - .62, (v - .66) * 1.33) < .15:
            colour = (.76, .36, .2)
        for k, tone in enumerate(tones):
            if v < .56 - .11 * k + .16 * (hills(u * (1.6 + .5 * k) + 1.7 * k, 0) - .5):
                colour = tone
        return colour

    write_png(folder / 'print.png', 96, 128, print_of_hills)
    write_png(folder / 'weave.png', 16, 16, lambda x, y: [
        math.sin(math.pi * ((x if (x // 4 + y // 4) % 2 else y) % 4 + .5) / 4)])

    clouds, trees = Noise(3, 24, 12), Noise(4, 48, 8)

    def sky(day):
        def pixel(x, y):
            up, turn = 90 - 180 * (y + .5) / 48, x / 96
            haze = max(0, 1 - up / 90) ** 4
            crown = 10 * trees(48 * turn, 0) + 6 * trees(96 * turn, 3)
            if up < crown:
                leaf = .5 + trees(96 * turn, up / 4)
                return [c * leaf * (.8 if day else .2) for c in (.034, .042, .032)] if up > -6 else \
                    [c * (.8 if day else .18) for c in (.16, .17, .09)]
            if not day:
                return [a + b * haze for a, b in zip((.08, .18, .50), (.55, .40, .40))]
            cloud = max(0, clouds(24 * turn, up / 9) - .45) * 1.6
            bright = .5 + .5 * max(0, up - 25) / 65
            return [.8 * bright * ((a + (b - a) * haze) * (1 - cloud) + 1.25 * cloud)
                    for a, b in zip((.36, .58, 1.0), (1.05, 1.1, 1.15))]
        return pixel

    write_png(folder / 'sky.png', 96, 48, sky(True))
    write_png(folder / 'dusk.png', 96, 48, sky(False))
