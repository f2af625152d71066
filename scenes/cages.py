"""Meshes for scenes that a script makes, and the text of pbrt-v3 files. Needs Python alone.

A cage is (points, triangles), which a renderer subdivides (loopsubdiv): soft things, turned things, tubes. A
mesh is (points, triangles, texture coordinates) and stays as it is: boxes. Metres, y up.
"""
import contextlib
import math
import re


def sheet(f, nu, nv, closed=False, caps=False):
    """Returns a grid of nu x nv cells, points f(u, v) with u and v in [0, 1]; closed along u, ends capped."""
    across = nu if closed else nu + 1
    points = [f(i / nu, j / nv) for j in range(nv + 1) for i in range(across)]
    triangles = []
    for j in range(nv):
        for i in range(nu):
            a, b = j * across + i, j * across + (i + 1) % across
            triangles += [(a, b, a + across), (b, b + across, a + across)]
    for first in (0, nv * across) if caps else ():
        ring = list(range(first, first + across))
        points.append(tuple(sum(points[k][axis] for k in ring) / nu for axis in range(3)))
        for a, b in zip(ring, ring[1:] + ring[:1]):
            triangles.append((len(points) - 1, a, b) if first else (len(points) - 1, b, a))
    return points, triangles


def lathe(outline, sides=10, caps=True, ribs=0):
    """Revolves an outline [(radius, height)] about y; wider by what subdivision takes off."""
    half = math.pi / sides
    wider = 1 / (.5 + (math.cos(2 * half) + 2 * math.cos(half)) / 6)

    def point(u, v):
        ring = round(v * (len(outline) - 1))
        radius, y = outline[ring]
        angle = 2 * math.pi * u + (0 if ribs else ring * half)
        radius *= wider * (1 + (.035 * math.cos(ribs * angle) if ribs else 0))
        return radius * math.cos(angle), y, radius * math.sin(angle)
    return sheet(point, sides, len(outline) - 1, True, caps)


def torus(radius, thickness, sides=16):
    """Returns a ring about y."""
    def point(u, v):
        r = radius + thickness * math.cos(2 * math.pi * v)
        return r * math.cos(2 * math.pi * u), thickness * math.sin(2 * math.pi * v), r * math.sin(2 * math.pi * u)
    return sheet(point, sides, 4, True)


def tube(path, radii, sides=6):
    """Returns a tube with closed ends along a path, which must not run along x."""
    def point(u, v):
        i = round(v * (len(path) - 1))
        d = [q - p for p, q in zip(path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)])]
        n = math.hypot(d[1], d[2])
        c, s = radii[i] * math.cos(2 * math.pi * u), radii[i] * math.sin(2 * math.pi * u)
        return path[i][0] + c, path[i][1] + s * d[2] / n, path[i][2] - s * d[1] / n
    return sheet(point, sides, len(path) - 1, True, True)


def cushion(size, puff=(0, 0, 0), edge=.86, at=(0, 0, 0)):
    """Returns a soft box; `puff` is how far the middles of its faces stand out."""
    steps = [-1, -edge, 0, edge, 1]
    index, points, triangles = {}, [], []

    def vertex(key):
        if key not in index:
            p = [steps[k] for k in key]
            index[key] = len(points)
            points.append(tuple(o + s / 2 * c + b * c * (1 - p[i - 2] ** 2) * (1 - p[i - 1] ** 2)
                                for i, (o, s, c, b) in enumerate(zip(at, size, p, puff))))
        return index[key]

    for axis in range(3):
        for end in (0, 4):
            for cell in range(16):
                def corner(di, dj):
                    key = [end] * 3
                    key[(axis + 1) % 3], key[(axis + 2) % 3] = cell // 4 + di, cell % 4 + dj
                    return vertex(tuple(key))
                a, b, c, d = corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)
                triangles += [(a, b, c), (a, c, d)] if end else [(a, c, b), (a, d, c)]
    return points, triangles


def box(low, high, bevel=.003, grain=None, shift=0):
    """Returns a box with bevels. Texture coordinates: metres, u along the longest side or the axis `grain`."""
    size = [h - l for l, h in zip(low, high)]
    if bevel == 0:
        points = [[(l, h)[corner >> k & 1] for k, (l, h) in enumerate(zip(low, high))] for corner in range(8)]
        quads = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
        return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], [(0, 0)] * 8
    longest = size.index(max(size)) if grain is None else grain
    shift = shift + 3.7 * sum(low) % 1, shift + 5.3 * sum(high) % 1  # so that no two are alike
    points, uvs, quads = [], [], []
    for axis in range(3):  # the four corners of its two faces, 8 * axis + a bit for each coordinate
        along = longest if longest != axis else (axis + 1) % 3
        for corner in range(8):
            inward = [0 if k == axis else min(bevel, s / 3) for k, s in enumerate(size)]
            p = [h - i if corner >> k & 1 else l + i for k, (l, h, i) in enumerate(zip(low, high, inward))]
            points.append(p)
            uvs.append((p[along] + shift[0], p[3 - axis - along] + shift[1]))
    for axis in range(3):
        r, s, t = 1 << axis, 1 << (axis + 1) % 3, 1 << (axis + 2) % 3
        b, d = 8 * ((axis + 1) % 3), 8 * ((axis + 2) % 3)
        quads += [[8 * axis + end + c for c in (0, s, s + t, t)] for end in (0, r)]
        quads += [(b + c, b + c + r, d + c + r, d + c) for c in (0, s, t, s + t)]  # bevels
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return points, triangles + [(c, 8 + c, 16 + c) for c in range(8)], uvs


def joined(*parts):
    """Joins meshes to one."""
    points, triangles, uvs = [], [], []
    for more, faces, coordinates in parts:
        triangles += [tuple(len(points) + k for k in face) for face in faces]
        points += more
        uvs += coordinates
    return points, triangles, uvs


def group(*parts):
    """Joins cages to one, each moved and turned about y by some degrees: (cage, at, turn)."""
    points, triangles = [], []
    for (more, faces), (x0, y0, z0), turn in parts:
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        triangles += [tuple(len(points) + k for k in face) for face in faces]
        points += [(x * c + z * s + x0, y + y0, z * c - x * s + z0) for x, y, z in more]
    return points, triangles


class PbrtScene:
    """Collects the text of a .pbrt file, and of those that it includes."""

    def __init__(self, name, title):
        self.name, self.title, self.files = name, title, {name: ''}

    def add(self, text):
        self.files[self.name] += text + '\n'

    @contextlib.contextmanager
    def placed(self, at, turn=0, tilt=0, roll=0):
        """Moves what is added; it is rolled about z, then tilted about x, then turned about y, in degrees."""
        self.add(f'AttributeBegin {self.transform(at, turn, tilt, roll)}')
        yield
        self.add('AttributeEnd')

    @contextlib.contextmanager
    def object(self, name):
        """What is added is seen only where there is an instance of it."""
        self.add(f'ObjectBegin "{name}"')
        yield
        self.add('ObjectEnd')

    def shape(self, material, shape, levels=2, textured=False, file=None):
        """Adds a cage or a mesh, with its texture coordinates if `textured`; in a file of its own if it has one."""
        points, triangles, *uvs = shape
        text = 'Shape "trianglemesh"' if uvs else f'Shape "loopsubdiv" "integer levels" {levels}'
        text += '\n"integer indices" [ ' + ' '.join('%d %d %d' % t for t in triangles) + ' ]'
        text += '\n"point P" [ ' + '  '.join(self.short(p, 4 if uvs else 3) for p in points) + ' ]'
        if textured:
            text += '\n"float uv" [ ' + '  '.join(self.short(uv) for uv in uvs[0]) + ' ]'
        if file:
            self.files[file] = text + '\n'
        self.add(f'NamedMaterial "{material}"\n' + (f'Include "{file}"' if file else text))

    def instance(self, name, at, turn=0, tilt=0, roll=0, scale=(1, 1, 1)):
        turns = self.transform(at, round(turn) % 360, round(tilt) % 360, round(roll) % 360)
        scaled = '' if tuple(scale) == (1, 1, 1) else f' Scale {self.short(scale)}'
        self.add(f'AttributeBegin {turns}{scaled} ObjectInstance "{name}" AttributeEnd')

    def transform(self, at, turn, tilt, roll):
        axes = ((turn, '0 1 0'), (tilt, '1 0 0'), (roll, '0 0 1'))
        return f'Translate {self.short(at)}' + ''.join(f' Rotate {self.short([a], 1)} {axis}' for a, axis in axes if a)

    @staticmethod
    def short(values, digits=3):
        """Returns numbers as text, without the 0 in front of the point."""
        text = ' '.join(f'{v:.{digits}f}'.rstrip('0').rstrip('.') for v in values)
        return re.sub(r'-0\b(?!\.)', '0', re.sub(r'\b0\.', '.', text))

    def write(self, folder):
        for name, text in self.files.items():
            (folder / name).write_text(f'# {self.title}\n{text}')
