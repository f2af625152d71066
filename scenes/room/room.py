#!/usr/bin/env python3
"""Makes the room: room.pbrt by day, room-night.pbrt by night, what both include, and their pictures.

room.py [FOLDER]: writes all files to FOLDER (this one by default). Everything is a function of the numbers
below, so that the files are the same, byte for byte, each time. Metres; x to the right, y up, z away from the
camera. Soft things are control cages that lull subdivides (loopsubdiv); things that repeat are instances.
"""
import math
import pathlib
import random
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from make import numbers, write_png  # noqa: E402

LEFT, RIGHT, FRONT, BACK, HEIGHT = -2.2, 2.5, -1.9, 5.0, 2.75  # of the room, inside
WINDOWS = [(-1.2, -.1), (1.85, 2.95), (3.4, 4.5)]               # along z, in the left wall
PLANKS = 9                                                      # kinds of them
TEXTURED = ['oak', 'walnut'] + [f'plank{k}' for k in range(6)]  # materials that need texture coordinates
SILL, HEAD, WALL = .42, 2.38, .26                               # height of the windows, thickness of the wall


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


# Meshes: (points, triangles); those of boxes have texture coordinates too, or None.

def sheet(f, nu, nv, closed=False, caps=False):
    """A grid of (nu + 1) x (nv + 1) points f(u, v), u and v in [0, 1]; closed along u, ends capped."""
    across = nu if closed else nu + 1
    points = [f(i / nu, j / nv) for j in range(nv + 1) for i in range(across)]
    at = lambda i, j: j * across + i % across
    triangles = []
    for j in range(nv):
        for i in range(nu):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            triangles += [(a, b, d), (b, c, d)]
    for j in (0, nv) if caps else ():
        ring = [at(i, j) for i in range(nu)]
        points.append(tuple(sum(points[k][axis] for k in ring) / nu for axis in range(3)))
        for a, b in zip(ring, ring[1:] + ring[:1]):
            triangles.append((len(points) - 1, b, a) if j == 0 else (len(points) - 1, a, b))
    return points, triangles


def lathe(outline, sides=10, caps=True, ribs=0):
    """Revolves an outline [(radius, height)]; wider by what subdivision takes off."""
    a = math.pi / sides
    wider = 1 / (.5 + (math.cos(2 * a) + 2 * math.cos(a)) / 6)

    def f(u, v):
        i = round(v * (len(outline) - 1))
        r, y = outline[i]
        t = 2 * math.pi * u + i * a * (not ribs)
        r *= 1 + .035 * math.cos(ribs * t) * (ribs > 0)
        return r * wider * math.cos(t), y, r * wider * math.sin(t)
    return sheet(f, sides, len(outline) - 1, True, caps)


def tube(path, radii, sides=6):
    """A tube along a path, which must not run along x."""
    def f(u, v):
        i = round(v * (len(path) - 1))
        a, b = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        d = [q - p for p, q in zip(a, b)]
        n = math.hypot(d[1], d[2])
        side = (0, d[2] / n, -d[1] / n)
        t = 2 * math.pi * u
        return tuple(p + radii[i] * (math.cos(t) * x + math.sin(t) * s)
                     for p, x, s in zip(path[i], (1, 0, 0), side))
    return sheet(f, sides, len(path) - 1, True, True)


def cushion(size, puff=(0, 0, 0), edge=.86, bend=None):
    """A soft box about the origin: `puff` is how far the middles of its faces stand out."""
    steps = [-1, -edge, 0, edge, 1]
    index, points, triangles = {}, [], []

    def vertex(*key):
        if key not in index:
            p = [steps[k] for k in key]
            x, y, z = (s / 2 * c + b * c * (1 - p[i - 2] ** 2) * (1 - p[i - 1] ** 2)
                       for i, (s, c, b) in enumerate(zip(size, p, puff)))
            index[key] = len(points)
            points.append(bend(x, y, z) if bend else (x, y, z))
        return index[key]

    for axis in range(3):
        for end in (0, 4):
            for i in range(4):
                for j in range(4):
                    corner = lambda s, t: vertex(*[end if k == axis else s if k == (axis + 1) % 3 else t
                                                   for k in range(3)])
                    a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
                    triangles += [(a, b, c), (a, c, d)] if end else [(a, c, b), (a, d, c)]
    return points, triangles


def box(low, high, bevel=.003, grain=None, rng=random.Random(5)):
    """A box with bevels; texture coordinates are metres, u along its longest side or the axis `grain`."""
    size = [h - l for l, h in zip(low, high)]
    if bevel == 0:
        points = [[(l, h)[corner >> k & 1] for k, (l, h) in enumerate(zip(low, high))] for corner in range(8)]
        faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
        return points, [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))], [(0, 0)] * 8
    longest = size.index(max(size)) if grain is None else grain
    shift = rng.random(), rng.random()
    points, uvs, index = [], [], {}
    for axis in range(3):
        for corner in range(8):
            inward = [min(bevel, s / 3) * (k != axis) for k, s in enumerate(size)]
            p = [h - i if corner >> k & 1 else l + i for k, (l, h, i) in enumerate(zip(low, high, inward))]
            index[axis, corner] = len(points)
            points.append(p)
            along = longest if longest != axis else (axis + 1) % 3
            uvs.append((p[along] + shift[0], p[3 - axis - along] + shift[1]))
    faces = []
    for axis in range(3):
        s, t = 1 << (axis + 1) % 3, 1 << (axis + 2) % 3
        for end in (0, 1 << axis):
            faces.append([(axis, end + c) for c in (0, s, s + t, t)])
        for c in (0, s, t, s + t):  # the bevel between the other two axes' faces, along this axis
            b, d = (axis + 1) % 3, (axis + 2) % 3
            faces.append([(b, c), (b, c + (1 << axis)), (d, c + (1 << axis)), (d, c)])
    triangles = []
    for f in faces:
        a, b, c, d = (index[key] for key in f)
        triangles += [(a, b, c), (a, c, d)]
    triangles += [tuple(index[axis, c] for axis in range(3)) for c in range(8)]
    return points, triangles, uvs


def boxes(*parts):
    """Joins meshes of box() to one."""
    joined = ([], [], [])
    for points, triangles, uvs in parts:
        first = len(joined[0])
        for whole, part in zip(joined, (points, [tuple(first + k for k in t) for t in triangles], uvs)):
            whole += part
    return joined


def joined(*cages):
    """Joins cages to one, each moved and turned about y by some degrees: (cage, at, turn)."""
    points, triangles = [], []
    for (more, faces), at, turn in cages:
        c, w, first = math.cos(math.radians(turn)), math.sin(math.radians(turn)), len(points)
        points += [(x * c + z * w + at[0], y + at[1], z * c - x * w + at[2]) for x, y, z in more]
        triangles += [tuple(first + k for k in t) for t in faces]
    return points, triangles


def short(values, digits=3):
    """Numbers as text, without the 0 in front of the point."""
    return re.sub(r'-0\b(?!\.)', '0', re.sub(r'\b0\.', '.', numbers(values, digits)))


class Scene:
    """The text of a .pbrt file."""

    def __init__(self, title):
        self.text = [f'# {title} Made by room.py.\n']

    def add(self, *lines):
        self.text += [line + '\n' for line in lines]

    def begin(self, at=(0, 0, 0), turn=0, tilt=0, roll=0):
        """Turned about y, then tilted about x, then rolled about z, as seen from the thing."""
        self.add('AttributeBegin', f'Translate {numbers(at, 3)}')
        for angle, axis in ((turn, '0 1 0'), (tilt, '1 0 0'), (roll, '0 0 1')):
            if angle:
                self.add(f'Rotate {numbers([angle], 1)} {axis}')

    def end(self):
        self.add('AttributeEnd')

    def shape(self, material, mesh, levels=2, extra=''):
        """A mesh of box() as it is, any other one subdivided."""
        points, triangles = mesh[:2]
        self.add(f'NamedMaterial "{material}"', 'Shape "trianglemesh"' if len(mesh) > 2 else
                 f'Shape "loopsubdiv" "integer levels" [ {levels} ]', extra,
                 '"integer indices" [ ' + ' '.join('%d %d %d' % t for t in triangles) + ' ]',
                 '"point P" [ ' + '  '.join(short(p, 4 if len(mesh) > 2 else 3) for p in points) + ' ]')
        if len(mesh) > 2 and material in TEXTURED:
            self.add('"float uv" [ ' + '  '.join(short(t, 3) for t in mesh[2]) + ' ]')

    def instance(self, name, at, turn=0, tilt=0, roll=0, scale=(1, 1, 1)):
        turns = ''.join(f'Rotate {round(a) % 360} {axis} ' for a, axis in
                        ((turn, '0 1 0'), (tilt, '1 0 0'), (roll, '0 0 1')) if round(a))
        scaled = '' if scale == (1, 1, 1) else f'Scale {short(scale, 3)} '
        self.add(f'AttributeBegin Translate {short(at, 3)} {turns}{scaled}ObjectInstance "{name}" AttributeEnd')

    def write(self, name):
        (FOLDER / name).write_text(''.join(line for line in self.text if line != '\n'))


# Pictures

def write_pictures():
    """Grain of wood, a kilim, spines of books, a print, weave; the skies."""
    size = 256
    fine, broad = Noise(1, 12, 128), Noise(2, 4, 12)

    def grain(x, y):
        u, v = x / size, y / size * 2
        v += .05 * (broad(4 * u, 6 * v) - .5)
        rings = .5 + .5 * math.sin(2 * math.pi * (9 * v + 2.2 * broad(4 * u, 12 * v)))
        return [round((.45 * rings ** 2 + .55 * fine(12 * u, 128 * v)) * 15) / 15]

    write_png(FOLDER / 'grain.png', size, size // 2, grain)

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
    write_png(FOLDER / 'kilim.png', 160, 108, lambda x, y: [
        c * (1 - .12 * round(3 * t) / 3) for t in [wool.random()] for c in kilim(x, y)])

    bands = [[(.08, .11), (.84, .87)], [(.62, .86)], [(.06, .09), (.12, .13), (.66, .67), (.70, .84), (.88, .89)],
             [(.30, .74)]]

    def spine(x, y):
        n, v = x // 8, 1 - (y + .5) / 64
        inside = any(a < v < b for a, b in bands[n])
        if n == 3:  # a title, in letters
            inside = inside and 2 <= x % 8 <= 5 and (y * 7 + x * 3) % 5 < 3
        return [1. * inside]

    write_png(FOLDER / 'spines.png', 32, 64, spine)

    hills = Noise(6, 7, 1)

    def print_of_hills(x, y):
        u, v = x / 96, 1 - y / 128
        colour = (.86, .78, .66)
        if math.hypot(u - .62, (v - .66) * 1.33) < .15:
            colour = (.76, .36, .2)
        for k, tone in enumerate([(.60, .64, .60), (.38, .47, .47), (.22, .31, .34), (.72, .50, .28), (.16, .19, .22)]):
            if v < .56 - .11 * k + .16 * (hills(u * (1.6 + .5 * k) + 1.7 * k, 0) - .5):
                colour = tone
        return colour

    write_png(FOLDER / 'print.png', 96, 128, print_of_hills)
    write_png(FOLDER / 'weave.png', 16, 16, lambda x, y: [
        math.sin(math.pi * ((x if (x // 4 + y // 4) % 2 else y) % 4 + .5) / 4)])

    clouds, trees = Noise(3, 24, 12), Noise(4, 48, 8)

    def sky(day):
        def pixel(x, y):
            up, turn = 90 - 180 * (y + .5) / 48, x / 96
            haze = max(0, 1 - up / 90) ** 4
            crown = 10 * trees(48 * turn, 0) + 6 * trees(96 * turn, 3)
            if up < crown:
                leaf = .5 + trees(96 * turn, up / 4)
                return [c * leaf * (.4 if day else .2) for c in (.065, .078, .062)] if up > -6 else \
                    [c * (.4 if day else .18) for c in (.16, .17, .09)]
            if not day:
                return [a + b * haze for a, b in zip((.08, .18, .50), (.55, .40, .40))]
            cloud = max(0, clouds(24 * turn, up / 9) - .45) * 1.6
            bright = .45 + 1.1 * max(0, math.cos(2 * math.pi * (turn - .2))) + .5 * max(0, up - 25) / 65
            return [.4 * bright * ((a + (b - a) * haze) * (1 - cloud) + 1.25 * cloud) for a, b in zip((.36, .58, 1.0), (1.05, 1.1, 1.15))]
        return pixel

    write_png(FOLDER / 'sky.png', 96, 48, sky(True))
    write_png(FOLDER / 'dusk.png', 96, 48, sky(False))


def room(s):
    """Floor, walls, windows, mouldings."""
    rng, outer = random.Random(11), LEFT - WALL
    for k in range(PLANKS):
        s.add(f'ObjectBegin "plank{k}"')
        s.shape(f'plank{k % 6}', box((0, -.02, 0), (.1485, 0, 1), .0016, 2))
        s.add('ObjectEnd')
    x, last = LEFT, 0
    while x < RIGHT:
        z = FRONT - rng.uniform(0, 1.4)
        while z < BACK:
            length = rng.uniform(1.1, 1.9)
            kind = rng.choice([k for k in range(PLANKS) if k % 6 != last])
            last = kind % 6
            s.instance(f'plank{kind}', (x, 0, z), scale=(1, 1, length - .0012))
            z += length
        x += .15
    s.shape('soil', box((LEFT, -.1, FRONT - 1.5), (RIGHT + 1, -.019, BACK + 1), 0))
    s.shape('lawn', box((LEFT - 12, -.6, -14), (outer, -.5, 24), 0))
    s.shape('hedge', box((LEFT - 6.6, -.5, -14), (LEFT - 5.5, 1.75, 24), .08))

    s.shape('ceiling', box((LEFT - .3, HEIGHT, FRONT - .3), (RIGHT + .3, HEIGHT + .1, BACK + .3), 0))
    s.shape('limewash', box((LEFT - .3, -.05, BACK), (RIGHT + .3, HEIGHT, BACK + .2), 0))
    s.shape('plaster', boxes(box((RIGHT, -.05, FRONT - .3), (RIGHT + .2, HEIGHT, BACK + .3), 0),
                             box((LEFT - .3, -.05, FRONT - .2), (-.9, HEIGHT, FRONT), 0),
                             box((1.7, -.05, FRONT - .2), (RIGHT + .3, HEIGHT, FRONT), 0),
                             box((-.9, 2.35, FRONT - .2), (1.7, HEIGHT, FRONT), 0)))
    wall = []
    ends = [FRONT - .2] + [z for window in WINDOWS for z in window] + [BACK + .2]
    for a, b in zip(ends[::2], ends[1::2]):
        wall.append(box((outer, -.05, a), (LEFT, HEIGHT, b), .006))
    for a, b in WINDOWS:
        wall += [box((outer, -.05, a - .02), (LEFT, SILL - .03, b + .02), 0), box((outer, HEAD, a - .02), (LEFT, HEIGHT, b + .02), .006)]
    s.shape('plaster', boxes(*wall))

    x, half, trim = outer + .06 - LEFT, (WINDOWS[0][1] - WINDOWS[0][0]) / 2, []
    trim.append(box((-WALL, SILL - .03, -half - .06), (.05, SILL, half + .06), .006))
    for z0, z1 in ((-half, -half + .055), (half - .055, half), (-.03, .03)):
        trim.append(box((x, SILL, z0), (x + .06, HEAD, z1), .006))
    for y0, y1 in ((SILL, SILL + .075), (HEAD - .06, HEAD)):
        trim.append(box((x + .004, y0, -half), (x + .056, y1, half), .006))
    for n in (1, 2, 3):
        y = SILL + n * (HEAD - SILL) / 4
        trim.append(box((x + .015, y - .013, -half), (x + .045, y + .013, half), .006))
    s.add('ObjectBegin "window"')
    s.shape('paint', boxes(*trim))
    s.add('ObjectEnd')
    for a, b in WINDOWS:
        s.instance('window', (LEFT, 0, (a + b) / 2))
    trim = []
    for y0, y1, depth in ((0, .11, .018), (.11, .125, .012)):  # skirting
        trim += [box((LEFT, y0, FRONT), (LEFT + depth, y1, BACK), .005), box((LEFT, y0, BACK - depth), (RIGHT, y1, BACK), .005)]
    for y, depth in ((HEIGHT - .03, .09), (HEIGHT - .06, .06), (HEIGHT - .08, .03)):  # cornice
        trim += [box((LEFT, y, FRONT), (LEFT + depth, HEIGHT, BACK), .01), box((LEFT, y, BACK - depth), (RIGHT, HEIGHT, BACK), .01)]
    s.shape('paint', boxes(*trim))


def curtains(s):
    """Two panels of linen, each hung twice, and the rod."""
    for name, folds, seed in (('curtain0', 5, 1), ('curtain1', 4, 2)):
        rng = random.Random(seed)
        amplitudes = [rng.uniform(.6, 1.15) for _ in range(folds + 1)]
        drift = [rng.uniform(-1, 1) for _ in range(folds + 1)]

        def f(u, v):
            t = u * folds
            k = min(int(t), folds - 1)
            swell = amplitudes[k] * (1 - t + k) + amplitudes[k + 1] * (t - k)
            lean = drift[k] * (1 - t + k) + drift[k + 1] * (t - k)
            phase = 2 * math.pi * t + .9 * lean * v
            return ((.03 + .022 * v) * swell * math.sin(phase) + .02 * lean * v, -v * 2.445,
                    (u - .5) * (.40 + .07 * v) + .005 * math.sin(2 * phase) + .02 * lean * math.sin(2.5 * v))
        s.add(f'ObjectBegin "{name}"')
        s.shape('linen', sheet(f, folds * 7, 5))
        s.add('ObjectEnd')
    s.add('ObjectBegin "ring"')
    s.shape('brass', sheet(lambda u, v: tuple(c * 1.1 for c in (
        (.024 + .004 * math.cos(2 * math.pi * v)) * math.cos(2 * math.pi * u),
        (.024 + .004 * math.cos(2 * math.pi * v)) * math.sin(2 * math.pi * u), .004 * math.sin(2 * math.pi * v))), 10, 5, True), 1)
    s.add('ObjectEnd')
    x, y = LEFT + .1, 2.5
    for window, (a, b) in enumerate(WINDOWS):
        for k, (z, turn) in enumerate(((a - .1, 0), (b + .1, 180))):
            s.instance(f'curtain{(window + k) % 2}', (x, y - .03, z), turn)
            for i in range(7):
                s.instance('ring', (x, y - .012, z - .19 + .38 * i / 6), 12 * (i % 3 - 1))
        s.begin((x, y, a - .36))
        s.shape('brass', tube([(0, 0, z) for z in (0, .002, .4, .8, b - a + .718, b - a + .72)], [.011] * 6), 1)
        s.end()
        for z in (a - .38, b + .38):
            s.begin((x, y, z), 0, 90)
            s.shape('brass', lathe([(.001, -.03), (.02, -.025), (.028, 0), (.02, .025), (.001, .03)]), 2)
            s.end()
        for z in (a - .33, b + .33):
            s.shape('brass', boxes(box((LEFT, y - .006, z - .006), (x, y + .006, z + .006)), box((LEFT, y - .03, z - .015), (LEFT + .006, y + .03, z + .015))))


def armchair(s):
    """Velvet on turned legs, with a pillow and a throw over its arm; it faces -z."""
    s.begin((-.72, 0, 3.72), -38)
    for side in (-1, 1):
        for z, slant in ((-.33, -.05), (.33, .06)):
            s.shape('turned', tube([(side * (.30 + .03 * t), .17 - .17 * t, z + slant * t) for t in (0, .05, .95, 1)],
                                   [.025, .025, .015, .015], 6))
        s.begin((side * .355, .385, 0), 0, 0, -3 * side)
        s.shape('velvet', cushion((.13, .43, .80), (.012, .014, .01), .8))
        s.end()
    s.shape('velvet', cushion((.62, .13, .74), (.0, .01, .0), .84, lambda x, y, z: (x, y + .235, z)))
    s.begin((0, .355, -.055), 0, -4)
    s.shape('velvet', cushion((.575, .15, .66), (.0, .028, .012), .8))
    s.end()
    s.begin((0, .57, .315), 0, 13)
    s.shape('velvet', cushion((.60, .62, .17), (.0, .02, .022), .82))
    s.end()
    s.begin((.10, .585, .15), 12, 20, 9)
    s.shape('stripes', cushion((.44, .44, .045), (-.035, -.035, .075), .9))
    s.end()

    rng = random.Random(3)
    wave = [rng.uniform(0, 6) for _ in range(4)]
    path = [(-.105, .26), (-.10, .40), (-.092, .54), (-.078, .612), (-.03, .634), (.03, .634), (.08, .612), (.092, .54), (.10, .40), (.11, .25), (.12, .12)]

    def throw(u, v):
        k = v * (len(path) - 1)
        i = min(int(k), len(path) - 2)
        x, y = (a + (b - a) * (k - i) for a, b in zip(path[i], path[i + 1]))
        ripple = .008 * math.sin(9 * u + wave[0]) + .006 * math.sin(17 * u + wave[1])
        away = max(0, abs(v - .45) - .12)
        return x + (ripple + .012) * (1 if v > .45 else -1) * min(1, 8 * away), y + .008 + .02 * away * math.sin(5 * u + wave[2]), -.30 + .36 * u + .05 * (v - .5)
    s.begin((.355, 0, 0), 0, 0, 0)
    s.shape('indigo', sheet(throw, 16, 20))
    s.end()
    s.end()


def pouf(s):
    """A knitted pouf."""
    outline = [(.12, .0), (.20, .003), (.255, .05), (.285, .16), (.265, .27), (.21, .325), (.10, .335), (.03, .332)]
    s.begin((-1.22, 0, 2.62))
    s.shape('ochre', lathe(outline, 36, ribs=12), 1)
    s.end()


def fruit(s):
    """A bowl of oranges."""
    x, y, z = .80, .36, 2.42
    s.add('ObjectBegin "orange"')
    s.shape('orange', lathe([(.004, -.034), (.02, -.032), (.038, -.012), (.038, .014), (.02, .034), (.003, .033)], 8))
    s.add('ObjectEnd')
    vase(s, 'stoneware', (x, y, z), [(.05, 0), (.055, .006), (.06, .012), (.11, .04), (.14, .075), (.146, .08)], .006, .016)
    for dx, dy, dz in ((-.045, .058, .03), (.045, .058, .022), (0, .058, -.05), (.005, .108, .002)):
        s.instance('orange', (x + dx, y + dy, z + dz), 100 * dx, 900 * dz)


def round_table(s, material, at, radius, height, legs):
    s.begin(at)
    s.shape(material, lathe([(radius - .02, height - .022), (radius - .004, height - .02), (radius, height - .012), (radius - .002, height - .002),
                             (radius - .008, height), (radius - .03, height)], 14), 2)
    for k in range(legs):
        a = 2 * math.pi * k / legs + .5
        s.shape(material, tube([((radius * .55 + radius * .33 * t) * math.cos(a), (height - .015) * (1 - t), (radius * .55 + radius * .33 * t) * math.sin(a))
                                for t in (0, .03, .97, 1)], [.018, .018, .012, .012], 6))
    s.end()


def vase(s, material, at, outline, thick=.004, bottom=.012):
    """A vessel with an inside."""
    inside = [(r - thick, y) for r, y in reversed(outline) if y > bottom]
    whole = [(outline[0][0] * .5, 0)] + outline + inside + [(inside[-1][0] * .8, bottom), (inside[-1][0] * .3, bottom)]
    s.begin(at)
    s.shape(material, lathe(whole, 8), 2)
    s.end()


COVERS = [((.50, .16, .10), (.80, .66, .38)), ((.10, .16, .24), (.75, .62, .36)), ((.62, .44, .18), (.16, .14, .12)),
          ((.68, .62, .52), (.36, .14, .10)), ((.20, .27, .22), (.74, .66, .48)), ((.26, .08, .09), (.72, .58, .34)),
          ((.56, .53, .48), (.12, .14, .18)), ((.14, .26, .28), (.80, .74, .62)), ((.05, .05, .06), (.66, .60, .50)),
          ((.44, .27, .17), (.82, .74, .58)), ((.74, .70, .63), (.14, .20, .26)), ((.34, .38, .30), (.84, .78, .66))]


def bookcase(s):
    """Six shelves in two columns, full of books."""
    for k, (cover, print_) in enumerate(COVERS):
        s.add(f'Texture "spine{k}" "float" "imagemap" "string filename" "spines.png" "bool gamma" "false" '
              f'"float uscale" 0.25 "float udelta" {k % 4 * .25}',
              f'Texture "cover{k}" "spectrum" "mix" "rgb tex1" [ {numbers(cover)} ] "rgb tex2" [ {numbers(print_)} ] "texture amount" "spine{k}"',
              f'MakeNamedMaterial "cover{k}" "string type" "substrate" "texture Kd" "cover{k}" "rgb Ks" [ 0.025 0.025 0.025 ] '
              '"float uroughness" 0.2 "float vroughness" 0.2',
              f'ObjectBegin "book{k}"', f'NamedMaterial "cover{k}"', 'Include "cover.pbrt"',
              'NamedMaterial "paper"', 'Include "pages.pbrt"', 'ObjectEnd')
    x0, x1, z0, z1, board, top = .62, 2.22, 4.66, BACK - .02, .026, 2.24
    middle = (x0 + x1) / 2
    levels = [.10, .47, .85, 1.20, 1.55, 1.88]
    parts = [box((x, 0, z0), (x + board, top, z1), .002) for x in (x0, middle - board / 2, x1 - board)]
    parts += [box((x0 - .015, top, z0 - .02), (x1 + .015, top + .035, z1), .006), box((x0 + board, 0, z0 + .02), (x1 - board, .10 - board, z0 + .04))]
    parts.append(box((x0, .05, z1), (x1, top, z1 + .006)))
    for a, b in ((x0 + board, middle - board / 2), (middle + board / 2, x1 - board)):
        parts += [box((a, y - board, z0 + .004), (b, y, z1), .002) for y in levels]
    s.shape('oak', boxes(*parts))

    rng = random.Random(23)
    gaps = {(0, 5): .34, (1, 4): .30, (0, 3): .26, (1, 2): .0, (1, 5): .42, (0, 1): .0, (1, 3): .16}
    for column, (a, b) in enumerate(((x0 + board, middle - board / 2), (middle + board / 2, x1 - board))):
        for level, y in enumerate(levels):
            clear = (levels + [top])[level + 1] - board - y
            x, end, set_ = a + .004, b - gaps.get((column, level), .06), 0
            while True:
                if set_ == 0:  # a few volumes of one series, or single ones
                    set_ = rng.choice((1, 1, 1, 1, 2, 3, 5))
                    thick, tall, deep, kind = (rng.uniform(.016, .048), clear * rng.uniform(.66, .93), rng.uniform(.15, .23), rng.randrange(len(COVERS)))
                if x + thick > end:
                    break
                set_ -= 1
                out = rng.uniform(.018, .045)
                s.instance(f'book{kind}', (x, y, z0 + out), scale=(thick, tall * rng.uniform(.995, 1), deep))
                x += thick + rng.uniform(.0005, .002)
            if gaps.get((column, level), .06) >= .06:  # the last one leans
                thick, tall, lean = rng.uniform(.018, .03), clear * rng.uniform(.66, .8), rng.uniform(5, 9)
                away = math.radians(lean)
                if x + thick * math.cos(away) + tall * math.sin(away) < b:
                    s.instance(f'book{rng.randrange(len(COVERS))}', (x + tall * math.sin(away), y, z0 + .03), roll=lean, scale=(thick, tall, .18))

    def stack(at, sizes, turn=0):
        y = at[1]
        for i, (wide, thick, deep, kind) in enumerate(sizes):
            s.instance(f'book{kind}', (at[0] + wide / 2, y, at[2]), turn + rng.uniform(-7, 7), roll=90, scale=(thick, wide, deep))
            y += thick + .0005
        return y
    right = x1 - board
    stack((right - .14, levels[4], z0 + .05), [(.23, .035, .17, 4), (.21, .028, .16, 9), (.19, .022, .15, 1)])
    stack((middle - .20, levels[5], z0 + .05), [(.24, .03, .18, 7), (.22, .04, .16, 0)])
    vase(s, 'celadon', (middle - .14, levels[3], z0 + .13), [(.035, 0), (.05, .004), (.075, .06), (.07, .12), (.03, .17), (.026, .2), (.034, .215)], bottom=.16)
    vase(s, 'stoneware', (right - .085, levels[3], z0 + .12), [(.03, 0), (.045, .004), (.06, .05), (.055, .10), (.05, .11)], bottom=.09)
    s.begin((.02, .43, 3.72))  # what lies on the side table
    s.end()
    stack((-.03, .522, 3.66), [(.24, .03, .17, 10), (.22, .024, .16, 5)], -62)
    stack((.66, .362, 2.72), [(.30, .032, .23, 6), (.26, .028, .20, 2), (.23, .02, .17, 7)], 24)


def book():
    """A book of 1 x 1 x 1 that shows its spine: its cover, its pages."""
    arc = [(.5 - .5 * math.cos(math.pi * i / 6), .035 - .035 * math.sin(math.pi * i / 6)) for i in range(7)]
    outer = [(0, 1)] + arc + [(1, 1)]
    inner = [(.08, 1)] + [(.08 + .84 * x, .04 + z) for x, z in arc] + [(.92, 1)]
    n = len(outer)
    points, uvs = [], []
    for outline in (outer, inner):
        for y in (0, 1):
            for x, z in outline:
                points.append((x, y, z))
                uvs.append((min(.999, max(.001, x)), y * (.998 if z < .04 else 0) + .001))
    triangles = []
    for i in range(n - 1):
        for a, b in ((0, n), (2 * n, 3 * n), (0, 2 * n), (n, 3 * n)):
            triangles += [(a + i, a + i + 1, b + i), (a + i + 1, b + i + 1, b + i)]
    text = lambda t, p, uv: ('Shape "trianglemesh" "integer indices" [ ' + ' '.join('%d %d %d' % v for v in t) + ' ]\n"point P" [ ' +
                             '  '.join(numbers(v) for v in p) + ' ]\n' + ('"float uv" [ ' + '  '.join(numbers(v) for v in uv) + ' ]\n' if uv else ''))
    (FOLDER / 'cover.pbrt').write_text('# Of a book. Made by room.py.\n' + text(triangles, points, uvs))
    pages = box((.06, .015, .05), (.94, .985, .97), .001)
    (FOLDER / 'pages.pbrt').write_text('# Of a book. Made by room.py.\n' + text(pages[1], pages[0], None))


def lamps(s):
    """Without their bulbs: the floor lamp, and a globe of glass that hangs from the ceiling."""
    s.begin((.20, 0, 4.42))
    s.shape('brass', lathe([(.06, 0), (.13, .0), (.14, .004), (.14, .016), (.13, .02), (.012, .024), (.010, .1), (.010, .8), (.010, 1.56), (.009, 1.57), (.002, 1.575)], 10, True), 2)
    s.shape('shade', lathe([(.235, 1.38), (.234, 1.385), (.21, 1.5), (.182, 1.65), (.180, 1.655)], 16, False))
    for y, r in ((1.38, .235), (1.655, .180)):
        s.shape('brass', sheet(lambda u, v: ((r + .004 * math.cos(2 * math.pi * v)) * math.cos(2 * math.pi * u), y + .004 * math.sin(2 * math.pi * v),
                                             (r + .004 * math.cos(2 * math.pi * v)) * math.sin(2 * math.pi * u)), 16, 4, True), 1)
    s.end()
    s.begin((-.60, 0, 2.75))
    s.shape('iron', tube([(0, y, .0005 * (y < 2)) for y in (2.17, 2.2, 2.45, 2.72, 2.749)], [.004] * 5), 1)
    s.shape('brass', lathe([(.001, 2.749), (.05, 2.748), (.055, 2.735), (.03, 2.72), (.002, 2.715)]), 2)
    s.shape('brass', lathe([(.030, 2.105), (.033, 2.11), (.034, 2.14), (.030, 2.17), (.012, 2.19), (.003, 2.2)]), 2)
    globe = [(.03, .118), (.06, .106), (.095, .07), (.115, .0), (.095, -.07), (.06, -.102), (.02, -.118)]
    s.shape('glass', lathe([(r, 2.0 + y) for r, y in globe] + [(r * .965, 2.0 + y * .965) for r, y in reversed(globe)], 12, False), 3)
    s.end()


def leaf(length, width, droop, steps=5):
    """A leaf along z that bends down, folded a little along its middle."""
    def f(u, v):
        t = 2 * u - 1
        w = width * math.sin(math.pi * min(1, .04 + .96 * v) ** .8) ** .7
        return t * w / 2, abs(t) * w * .16 - droop * v * v + .012 * math.sin(9 * v) * t * t, length * v
    return sheet(f, 4, steps)


def plants(s):
    """A rubber plant in the corner, ivy on the bookcase, eucalyptus in glass, a pot on the sill."""
    for name, material, mesh, levels in (('leaf', 'leaf', leaf(.27, .12, .07), 2), ('ivy', 'leaf', joined((leaf(.07, .06, .02, 3), (.004, 0, 0), 55), (leaf(.06, .052, .025, 3), (-.004, -.02, 0), -65)), 1),
                                         ('twig', 'sage', joined((leaf(.05, .042, .008, 3), (0, 0, 0), 0), (leaf(.046, .04, .004, 3), (0, .003, 0), 170)), 1), ('blade', 'leaf', leaf(.34, .05, -.02), 2)):
        s.add(f'ObjectBegin "{name}"')
        s.shape(material, mesh, levels)
        s.add('ObjectEnd')
    rng = random.Random(4)
    pot = [(.105, 0), (.125, .005), (.15, .15), (.168, .28), (.172, .30), (.185, .302), (.185, .34), (.18, .344)]
    x, z = -1.62, 4.42
    vase(s, 'clay', (x, 0, z), pot, .014, .27)
    s.begin((x, .285, z))
    s.shape('soil', lathe([(.05, 0), (.155, 0), (.162, -.01)], 12), 1)
    s.end()
    for k, (lean, turn, height) in enumerate(((.10, 20, 1.75), (.22, 150, 1.35), (.2, 265, 1.1))):
        a = math.radians(turn)
        path = [(x + lean * t * t * math.cos(a) + .012 * math.sin(7 * t + k) + .03 * math.cos(a), .26 + (height - .26) * t,
                 z + lean * t * t * math.sin(a) + .03 * math.sin(a)) for t in (i / 8 for i in range(9))]
        s.shape('bark', tube(path, [.012 - .008 * i / 8 for i in range(9)], 5), 1)
        count = int(height * 15)
        for i in range(count):
            t = .28 + .72 * (i + .5) / count
            p = path[min(7, int(t * 8))], path[min(8, int(t * 8) + 1)]
            at = [c + (d - c) * (t * 8 - int(t * 8)) for c, d in zip(*p)]
            size = rng.uniform(.75, 1.1) * (1.15 - .35 * t)
            around = i * 137.5 + turn + rng.uniform(-12, 12)
            if at[0] + .34 * size * math.sin(math.radians(around)) < LEFT + .16 or at[2] + .34 * size * math.cos(math.radians(around)) > BACK - .02:
                around += 180
            s.instance('leaf', at, around, rng.uniform(-12, 16) - 62 * max(0, t - .6), rng.uniform(-14, 14), [size] * 3)

    x, y, z = 1.05, 2.275, 4.80  # ivy, from the top of the bookcase
    vase(s, 'stoneware', (x, y, z), [(.05, 0), (.06, .003), (.075, .05), (.085, .11), (.087, .12)], .006, .09)
    for k in range(9):
        turn = 180 + (k - 4) * 22 + rng.uniform(-8, 8)
        a, drop, at = math.radians(turn), rng.uniform(.15, .62), [x, y + .11, z]
        n = 5 + int(8 * drop)
        path = []
        for i in range(n):
            t = i / (n - 1)
            out = .21 * min(1, 1.7 * t) * (.7 + .3 * math.sin(k * 2.1))
            path.append((x + out * math.sin(a) * 1.5 + .012 * math.sin(9 * t + k), y + .12 + .05 * math.sin(math.pi * min(1, 2 * t)) - drop * max(0, t - .33) * 1.4,
                         z + min(out, .23) * math.cos(a) * (1.1 if t < .5 else 1.12)))
        for i, at in enumerate(path[1:]):
            s.instance('ivy', at, turn + (35 if i % 2 else -35) + rng.uniform(-25, 25), rng.uniform(15, 60), rng.uniform(-20, 20), [rng.uniform(.7, 1.15)] * 3)
        s.shape('bark', tube([(a_, b_, c_) for a_, b_, c_ in path], [.0022] * n, 3), 1)

    x, y, z = .98, .362, 2.60  # eucalyptus
    vase(s, 'glass', (x, y, z), [(.035, 0), (.045, .004), (.06, .05), (.062, .10), (.045, .16), (.036, .20), (.042, .225)], .0035, .012)
    for k in range(7):
        a, lean = 2 * math.pi * k / 7 + .3, rng.uniform(.10, .24)
        path = [(x + (.018 * (1 - 3 * t) * (t < .33) * -1 + lean * max(0, t - .3) ** 1.4) * math.cos(a), y + .02 + rng.uniform(.50, .54) * t * (1.2 - lean),
                 z + (lean * max(0, t - .3) ** 1.4) * math.sin(a)) for t in (i / 7 for i in range(8))]
        s.shape('bark', tube(path[::2] + path[-1:], [.0025] * 5, 3), 1)
        for i in range(14):
            t = .42 + .58 * i / 14
            p, q = path[min(6, int(t * 7))], path[min(7, int(t * 7) + 1)]
            at = [c + (d - c) * (t * 7 - int(t * 7)) for c, d in zip(p, q)]
            s.instance('twig', at, i * 97 + k * 40, rng.uniform(-35, 5), rng.uniform(-20, 20), [rng.uniform(.7, 1.2) * (1.2 - .5 * t)] * 3)

    x, y, z = LEFT - .07, SILL, 3.72
    vase(s, 'celadon', (x, y, z), [(.045, 0), (.055, .003), (.065, .06), (.07, .10), (.072, .108)], .006, .085)
    for k in range(11):
        s.instance('blade', (x + .02 * math.sin(k * 2.4), y + .08, z + .02 * math.cos(k * 2.4)), k * 137.5, -78 + 4 * (k % 4), 0, [rng.uniform(.6, 1)] * 3)


def pictures(s):
    """Three prints in frames."""
    for x, y, wide, high, mount in ((-1.06, 1.66, .66, .86, .085), (-.40, 1.90, .34, .40, .06), (-.40, 1.43, .34, .40, .06)):
        s.begin((x, y, BACK))
        w, h, f = wide / 2, high / 2, .022
        s.shape('turned' if wide < .5 else 'walnut', boxes(
            box((-w, -h, -.03), (-w + f, h, -.002)), box((w - f, -h, -.03), (w, h, -.002)),
            box((-w + f, -h, -.03), (w - f, -h + f, -.002)), box((-w + f, h - f, -.03), (w - f, h, -.002))))
        s.shape('mount', box((-w + f, -h + f, -.012), (w - f, h - f, -.002), 0))
        a, b = w - f - mount, h - f - mount
        s.add('NamedMaterial "print"', f'Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ '
              f'{numbers((-a, -b, -.0125))}  {numbers((a, -b, -.0125))}  {numbers((a, b, -.0125))}  {numbers((-a, b, -.0125))} ] '
              '"float uv" [ 0 0 1 0 1 1 0 1 ]')
        s.end()


def rug(s):
    """A kilim with fringes."""
    s.begin((-.05, 0, 3.02), -4)
    wide, deep, n, m = 2.5, 1.7, 12, 8
    points = [((i / n - .5) * wide + .004 * math.sin(5 * j / m + i), .007 + .0016 * math.sin(i * 1.3 + 2 * math.sin(j)), (j / m - .5) * deep) for j in range(m + 1) for i in range(n + 1)]
    triangles = [t for j in range(m) for i in range(n) for a in [j * (n + 1) + i] for t in ((a, a + 1, a + n + 1), (a + 1, a + n + 2, a + n + 1))]
    s.add('NamedMaterial "kilim"', 'Shape "trianglemesh" "integer indices" [ ' + ' '.join('%d %d %d' % t for t in triangles) + ' ]', '"point P" [ ' + '  '.join(numbers(p) for p in points) + ' ]',
          '"float uv" [ ' + '  '.join(numbers((i / n, j / m), 3) for j in range(m + 1) for i in range(n + 1)) + ' ]')
    s.shape('wool', box((-wide / 2 + .006, .0005, -deep / 2 + .004), (wide / 2 - .006, .0052, deep / 2 - .004), .002))
    s.add('ObjectBegin "tassel"')
    tassel = tube([(0, .005, 0), (0.001, .004, .02), (.004, .002, .05), (.002, .002, .075)], [.004, .003, .004, .002], 4)
    s.shape('wool', joined(*((tassel, (.0169 * k, 0, 0), (11, -9, 4, -13)[k]) for k in range(4))), 1)
    s.add('ObjectEnd')
    rng = random.Random(9)
    for side in (-1, 1):
        for i in range(25):
            s.instance('tassel', (side * (wide / 2 - .004), .001, side * (.5 - (i + .15) / 25) * (deep - .01)), 90 * side + rng.uniform(-3, 3), scale=[1, 1, rng.uniform(.85, 1.15)])
    s.end()


def main():
    write_pictures()
    book()
    s = Scene('All of the room but its light.')
    for part in (room, curtains, rug, armchair, pouf, bookcase, lamps, plants, pictures):
        s.add(f'\n# {part.__doc__}' if part.__doc__ else '')
        part(s)
    fruit(s)
    round_table(s, 'turned', (.02, 0, 3.70), .24, .52, 3)
    round_table(s, 'turned', (.82, 0, 2.66), .46, .36, 4)
    s.write('geometry.pbrt')


FOLDER = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
if __name__ == '__main__':
    main()
