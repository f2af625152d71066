#!/usr/bin/env python3
"""Makes the parts of the scenes that no one would write by hand; run it here, it needs Python alone.

Everything is a function of the numbers below: the files it writes are the files that are here.
"""

import json
import math
import random
import struct
import zlib


def png(width, height, pixel):
    """Encodes an 8-bit PNG; pixel(x, y) returns 1 or 3 values in [0, 1]."""
    channels = len(pixel(0, 0))
    rows = b''
    for y in range(height):
        row = (max(0, min(255, round(255 * v))) for x in range(width) for v in pixel(x, y))
        rows += b'\0' + bytes(row)

    def chunk(kind, data):
        crc = struct.pack('>I', zlib.crc32(kind + data))
        return struct.pack('>I', len(data)) + kind + data + crc

    header = struct.pack('>IIBBBBB', width, height, 8, 2 if channels == 3 else 0, 0, 0, 0)
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) +
            chunk(b'IDAT', zlib.compress(rows, 9)) + chunk(b'IEND', b''))


def write_png(path, width, height, pixel):
    with open(path, 'wb') as f:
        f.write(png(width, height, pixel))


def write_exr(path, width, height, pixel):
    """Writes an OpenEXR file of half floats, uncompressed; pixel(x, y) returns R, G, B."""
    def attribute(name, kind, data):
        return name + b'\0' + kind + b'\0' + struct.pack('<i', len(data)) + data

    box = struct.pack('<4i', 0, 0, width - 1, height - 1)
    channels = b''.join(c + b'\0' + struct.pack('<iB3xii', 1, 0, 1, 1) for c in (b'B', b'G', b'R'))
    head = (struct.pack('<ii', 20000630, 2) +
            attribute(b'channels', b'chlist', channels + b'\0') +
            attribute(b'compression', b'compression', b'\0') +
            attribute(b'dataWindow', b'box2i', box) +
            attribute(b'displayWindow', b'box2i', box) +
            attribute(b'lineOrder', b'lineOrder', b'\0') +
            attribute(b'pixelAspectRatio', b'float', struct.pack('<f', 1)) +
            attribute(b'screenWindowCenter', b'v2f', struct.pack('<2f', 0, 0)) +
            attribute(b'screenWindowWidth', b'float', struct.pack('<f', 1)) + b'\0')
    line = 8 + width * 6
    first = len(head) + 8 * height
    with open(path, 'wb') as f:
        f.write(head + struct.pack('<%dQ' % height, *(first + y * line for y in range(height))))
        for y in range(height):
            row = [pixel(x, y) for x in range(width)]
            f.write(struct.pack('<ii', y, width * 6))
            for c in (2, 1, 0):
                f.write(struct.pack('<%de' % width, *(p[c] for p in row)))


def write_ply(path, vertices, triangles):
    """Writes a binary PLY; a vertex is x, y, z, nx, ny, nz, u, v."""
    names = ''.join('property float %s\n' % n for n in 'x y z nx ny nz u v'.split())
    with open(path, 'wb') as f:
        f.write(('ply\nformat binary_little_endian 1.0\nelement vertex %d\n%selement face %d\n'
                 'property list uchar int vertex_indices\nend_header\n'
                 % (len(vertices), names, len(triangles))).encode())
        for v in vertices:
            f.write(struct.pack('<8f', *v))
        for t in triangles:
            f.write(struct.pack('<B3i', 3, *t))


def numbers(values, digits=4):
    return ' '.join(('%.*f' % (digits, v)).rstrip('0').rstrip('.') for v in values)


def goblet():
    """A wine glass as a control cage: its outline, from the foot up and down inside, revolved."""
    sides = 12
    outline = [(.42, -.005), (.58, 0), (.58, .05), (.42, .075), (.13, .11), (.085, .3), (.075, .6),
               (.09, .84), (.27, .93), (.53, 1.1), (.64, 1.4), (.61, 1.75), (.55, 1.99),
               (.525, 2.02), (.505, 1.99), (.56, 1.75), (.585, 1.4), (.48, 1.14), (.23, 1.0)]
    points, faces = [(0, 0, 0), (0, .965, 0)], []
    for i, (r, y) in enumerate(outline):
        for j in range(sides):
            a = 2 * math.pi * (j + i / 2) / sides  # a half step a ring makes all triangles alike
            points.append((r * math.cos(a), y, r * math.sin(a)))
    ring = lambda i, j: 2 + i * sides + j % sides
    for j in range(sides):
        faces.append((0, ring(0, j), ring(0, j + 1)))
        for i in range(len(outline) - 1):
            faces.append((ring(i, j), ring(i + 1, j), ring(i, j + 1)))
            faces.append((ring(i, j + 1), ring(i + 1, j), ring(i + 1, j + 1)))
        faces.append((1, ring(len(outline) - 1, j + 1), ring(len(outline) - 1, j)))
    with open('caustic/goblet.pbrt', 'w') as f:
        f.write('# A wine glass, 2 high, standing on the origin. Made by ../make.py.\n'
                'Shape "loopsubdiv" "integer levels" [ 3 ]\n')
        f.write('    "integer indices" [\n')
        for t in faces:
            f.write('%d %d %d\n' % t)
        f.write(']\n    "point P" [\n')
        for p in points:
            f.write(numbers(p, 3) + '\n')
        f.write(']\n')


def revolved(outline, sides, v_scale=1):
    """Revolves an outline [(radius, height)], smooth along it and around; see write_ply."""
    vertices, triangles = [], []
    length = 0
    for i, (r, y) in enumerate(outline):
        r0, y0 = outline[max(i - 1, 0)]
        r1, y1 = outline[min(i + 1, len(outline) - 1)]
        length += math.hypot(r - r0, y - y0)
        nr, ny = y1 - y0, r0 - r1
        l = math.hypot(nr, ny)
        for j in range(sides + 1):
            a = 2 * math.pi * j / sides
            vertices.append((r * math.cos(a), y, r * math.sin(a), nr / l * math.cos(a), ny / l,
                             nr / l * math.sin(a), j / sides, length * v_scale))
    row = sides + 1
    for i in range(len(outline) - 1):
        for j in range(sides):
            a, b = i * row + j, (i + 1) * row + j
            triangles += [(a, b, a + 1)] * (outline[i][0] > 0)  # none of no area at the axis
            triangles += [(a + 1, b, b + 1)]
    return vertices, triangles


def revolve(path, outline, sides, v_scale=1):
    write_ply(path, *revolved(outline, sides, v_scale))


def bricks():
    """A running bond, 8 courses of 4, that repeats; colour and height."""
    rng = random.Random(1)
    width, height, rows, columns, joint = 128, 128, 8, 4, .06
    tone = {(r, c): rng.random() for r in range(rows) for c in range(columns)}
    grain = [[rng.random() for _ in range(width)] for _ in range(height)]

    def place(x, y):
        r = y * rows // height
        u = (x / width * columns + .5 * (r % 2)) % columns
        v = y / height * rows - r
        edge = min(u % 1, 1 - u % 1, v / 2, (1 - v) / 2)
        return (r, int(u)), min(1, max(0, (edge - joint / 2) / (joint / 2)))

    def colour(x, y):
        brick, inside = place(x, y)
        t = tone[brick]
        g = round(grain[y][x] * 7) / 7 * .08
        red = (.62 + .14 * t - g, .4 + .14 * t * t - g, .33 + .12 * t * t - g)
        grey = (.7 - g, .68 - g, .64 - g)
        return [i * inside + o * (1 - inside) for i, o in zip(red, grey)]

    write_png('textured/brick.png', width, height, colour)
    write_png('textured/brick-height.png', width, height,
              lambda x, y: [place(x, y)[1] * (.9 + .1 * round(grain[y][x] * 3) / 3)])


def leaf():
    """A pointed leaf along v, in the middle of the picture: colour and mask."""
    size = 64

    def shape(x, y):
        u, v = (x + .5) / size * 2 - 1, 1 - (y + .5) / size
        return abs(u), v, .85 * math.sin(math.pi * v ** .75) ** .8

    def colour(x, y):
        u, v, half = shape(x, y)
        vein = min(abs(u) / .05, abs(((v * 7 - u * 2.2) % 1) - .5) / .12)
        t = 1 if vein > 1 else .6
        return [.16 + .3 * (1 - t), .36 + .3 * (1 - t) + .1 * v, .08 + .2 * (1 - t)]

    write_png('textured/leaf.png', size, size, colour)
    write_png('textured/leaf-mask.png', size, size,
              lambda x, y: [1 if shape(x, y)[0] < shape(x, y)[2] else 0])


def plants():
    """Two bushes of leaves: each leaf an instance, turned and tilted."""
    rng = random.Random(7)
    with open('textured/plants.pbrt', 'w') as f:
        f.write('# The leaves of the two plants. Made by ../make.py.\n')
        for x, y, z, count, size in ((-1.3, .98, .55, 60, .62), (1.5, .62, -.35, 40, .42)):
            for i in range(count):
                t = (i + .5) / count
                f.write('AttributeBegin Translate %s Rotate %s 0 1 0 Rotate %s 1 0 0 Scale %s '
                        'ObjectInstance "leaf" AttributeEnd\n' % (
                            numbers((x, y + .5 * size * t, z), 3),
                            numbers((i * 137.508 + rng.uniform(-15, 15),), 1),
                            numbers((78 - 70 * t + rng.uniform(-9, 9),), 1),
                            numbers([size * (1.35 - .5 * t) * rng.uniform(.85, 1.1)] * 3, 3)))


def sky():
    """A clear sky with haze about the sun, z up; the sun itself is a distant light."""
    width, height = 64, 32
    sun = (-.55, .6, .58)
    norm = math.sqrt(sum(c * c for c in sun))

    def pixel(x, y):
        phi, theta = 2 * math.pi * (x + .5) / width, math.pi * (y + .5) / height
        d = (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))
        if d[2] < 0:
            return .16, .13, .1
        haze = (1 - d[2]) ** 3
        glow = 2.5 * max(0, sum(a * b for a, b in zip(d, sun)) / norm) ** 12
        return [b + (w - b) * haze + g * glow
                for b, w, g in zip((.22, .42, .85), (.9, .9, .88), (1, .85, .6))]

    write_exr('textured/sky.exr', width, height, pixel)


def bulbs():
    """Four strings of coloured bulbs, each hanging as a parabola between two posts."""
    hues = [(1, .04, .02), (1, .3, .03), (.03, .7, .05), (.02, .12, 1), (.5, .03, .8), (1, .6, .3)]
    strings = [((-3.2, 2.6, 3.4), (3.2, 2.7, 3.0), 18), ((-3.4, 2.3, 1.2), (3.4, 2.5, 1.6), 16),
               ((-3.2, 2.5, -1), (3.2, 2.3, -.4), 14), ((-3.3, 2.3, 3.3), (3.3, 2.4, -.5), 16)]
    with open('many-lights/bulbs.pbrt', 'w') as f:
        f.write('# 64 bulbs. Made by ../make.py.\n')
        n = 0
        for a, b, count in strings:
            for i in range(count):
                t = (i + .5) / count
                p = [s + (e - s) * t for s, e in zip(a, b)]
                p[1] -= 3.2 * t * (1 - t)
                f.write('AttributeBegin AreaLightSource "diffuse" "rgb L" [ %s ] Translate %s '
                        'Shape "sphere" "float radius" [ 0.075 ] AttributeEnd\n'
                        % (numbers([16 * c for c in hues[n % len(hues)]], 2), numbers(p, 3)))
                n += 5 if i % 3 == 2 else 1


class Glb:
    """Collects a glTF scene and writes it as one .glb file."""

    def __init__(self):
        self.data = b''
        self.root = {'asset': {'version': '2.0', 'generator': 'make.py'}, 'scene': 0,
                     'scenes': [{'nodes': []}], 'extensionsUsed': ['KHR_mesh_quantization'],
                     'extensionsRequired': ['KHR_mesh_quantization']}

    def add(self, kind, **entry):
        self.root.setdefault(kind, []).append(entry)
        return len(self.root[kind]) - 1

    def view(self, data, **more):
        self.data += bytes(-len(self.data) % 4)
        self.data += data
        return self.add('bufferViews', buffer=0, byteOffset=len(self.data) - len(data),
                        byteLength=len(data), **more)

    def shape(self, vertices, triangles):
        """Adds the arrays of a mesh: normals in bytes, texture coordinates in 16 bits."""
        count = len(vertices)
        at = [v[:3] for v in vertices]
        position = self.add(
            'accessors', componentType=5126, count=count, type='VEC3',
            min=[min(p[i] for p in at) for i in range(3)],
            max=[max(p[i] for p in at) for i in range(3)],
            bufferView=self.view(b''.join(struct.pack('<3f', *p) for p in at)))
        normal = self.add(
            'accessors', componentType=5120, count=count, type='VEC3', normalized=True,
            bufferView=self.view(b''.join(struct.pack('<3bx', *(round(127 * n) for n in v[3:6]))
                                          for v in vertices), byteStride=4))
        uv = self.add(
            'accessors', componentType=5126, count=count, type='VEC2',
            bufferView=self.view(b''.join(struct.pack('<2f', *v[6:]) for v in vertices)))
        indices = self.add(
            'accessors', componentType=5123, count=3 * len(triangles), type='SCALAR',
            bufferView=self.view(b''.join(struct.pack('<3H', *t) for t in triangles)))
        return {'attributes': {'POSITION': position, 'NORMAL': normal, 'TEXCOORD_0': uv},
                'indices': indices}

    def texture(self, picture):
        image = self.add('images', bufferView=self.view(picture), mimeType='image/png')
        return self.add('textures', source=image)

    def material(self, name, color, metallic=0, roughness=.5, extensions=None, **more):
        for extension in extensions or {}:
            if extension not in self.root['extensionsUsed']:
                self.root['extensionsUsed'].append(extension)
        pbr = {'baseColorFactor': [*color, 1], 'metallicFactor': metallic,
               'roughnessFactor': roughness}
        pbr.update(more.pop('pbr', {}))
        if extensions:
            more['extensions'] = extensions
        return self.add('materials', name=name, pbrMetallicRoughness=pbr, **more)

    def place(self, shape, material, at, scale=1, **more):
        mesh = self.add('meshes', primitives=[{**shape, 'material': material}])
        self.node(mesh=mesh, translation=at, scale=[scale] * 3, **more)

    def look(self, eye, at, **entry):
        """Adds a node that looks along its -z, as cameras and lights do."""
        def unit(v):
            length = math.sqrt(sum(c * c for c in v))
            return [c / length for c in v]

        def cross(a, b):
            return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

        back = unit([e - a for e, a in zip(eye, at)])
        right = unit(cross((0, 1, 0), back))
        axes = [right, cross(back, right), back]
        self.node(matrix=[round(v, 6) for axis in axes for v in (*axis, 0)] + [*eye, 1], **entry)

    def node(self, **entry):
        nodes = self.root['scenes'][0]['nodes']
        nodes.append(self.add('nodes', **entry))
        return nodes[-1]

    def write(self, path):
        self.data += bytes(-len(self.data) % 4)
        self.root['buffers'] = [{'byteLength': len(self.data)}]
        text = json.dumps(self.root, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        with open(path, 'wb') as f:
            f.write(b'glTF' + struct.pack('<II', 2, 28 + len(text) + len(self.data)) +
                    struct.pack('<I', len(text)) + b'JSON' + text +
                    struct.pack('<I', len(self.data)) + b'BIN\0' + self.data)


def tiles():
    """Glazed tiles with a star each: colour, roughness with metal, normals."""
    size, groove = 128, .035
    rng = random.Random(4)
    grain = [[round(rng.random() * 3) / 3 for _ in range(size)] for _ in range(size)]

    def place(x, y):
        """The height of the surface, whether it is glaze, and whether it is inside the star."""
        u, v = (2 * x / size) % 1, (2 * y / size) % 1
        edge = min(u, 1 - u, v, 1 - v)
        a, r = math.atan2(v - .5, u - .5), math.hypot(u - .5, v - .5)
        star = r < .22 + .09 * math.cos(8 * a)
        height = min(1, edge / groove) ** .5
        return height + (.25 if star else 0), edge > groove / 2, star

    def colour(x, y):
        _, glazed, star = place(x, y)
        odd = (2 * x // size + 2 * y // size) % 2
        if not glazed:
            return [.45 - .05 * grain[y % size][x % size]] * 3
        if star:
            return (.93, .8, .52)
        return (.1, .3, .42) if odd else (.82, .8, .74)

    def packed(x, y):
        _, glazed, star = place(x, y)
        return (0, (.25 if star else .15 + .05 * grain[y][x]) if glazed else .9, 1. * star)

    def normal(x, y):
        dx = place((x + 1) % size, y)[0] - place(x - 1, y)[0]
        dy = place(x, y - 1)[0] - place(x, (y + 1) % size)[0]
        n = (-.7 * dx, -.7 * dy, 1)
        l = math.sqrt(sum(c * c for c in n))
        return [.5 + .5 * c / l for c in n]

    return png(size, size, colour), png(size, size, packed), png(size, size, normal)


def still_life():
    """Spheres and vessels of metal, glass and lacquer on a tiled table."""
    glb = Glb()
    colour, packed, normal = (glb.texture(picture) for picture in tiles())
    ball = glb.shape(*revolved(
        [(math.sin(math.pi * i / 24), -math.cos(math.pi * i / 24)) for i in range(25)], 48))
    vase = glb.shape(*revolved(
        [(0, 0), (.3, 0), (.34, .02), (.5, .3), (.58, .6), (.52, .9), (.33, 1.15), (.22, 1.35),
         (.2, 1.5), (.25, 1.62), (.33, 1.68), (.31, 1.69), (.22, 1.62), (.17, 1.5), (.19, 1.35),
         (.3, 1.12), (.48, .9), (.54, .6), (.46, .32), (.3, .06), (0, .05)], 40))
    bowl = glb.shape(*revolved(
        [(0, 0), (.28, 0), (.3, .03), (.3, .06), (.55, .2), (.74, .42), (.76, .45), (.73, .45),
         (.52, .24), (.28, .1), (0, .08)], 40))
    table = glb.shape([(-1, 0, -1, 0, 1, 0, 0, 0), (1, 0, -1, 0, 1, 0, 6, 0),
                       (1, 0, 1, 0, 1, 0, 6, 6), (-1, 0, 1, 0, 1, 0, 0, 6)],
                      [(0, 2, 1), (0, 3, 2)])

    tiled = glb.material(
        'tiles', (1, 1, 1), 1, 1, pbr={'baseColorTexture': {'index': colour},
                                       'metallicRoughnessTexture': {'index': packed}},
        normalTexture={'index': normal})
    glass = glb.material('glass', (.97, 1, .98), 0, 0, {
        'KHR_materials_transmission': {'transmissionFactor': 1},
        'KHR_materials_volume': {'thicknessFactor': 1}, 'KHR_materials_ior': {'ior': 1.5}})
    copper = glb.material('copper', (.93, .52, .36), 1, .3)
    gold = glb.material('gold', (1, .77, .34), 1, .12)
    lacquer = glb.material('lacquer', (.5, .02, .025), 0, .6, {
        'KHR_materials_clearcoat': {'clearcoatFactor': 1, 'clearcoatRoughnessFactor': .03}})
    clay = glb.material('clay', (.75, .6, .45), 0, .9)
    lamp = glb.material('lamp', (0, 0, 0), 0, 1,
                        {'KHR_materials_emissive_strength': {'emissiveStrength': 9}},
                        emissiveFactor=[1, .85, .65])

    glb.place(table, tiled, [0, 0, 0], 4)
    glb.place(vase, copper, [-.85, 0, -.6], 1.1)
    glb.place(ball, glass, [.35, .55, .35], .55)
    glb.place(ball, lacquer, [-.55, .36, .75], .36)
    glb.place(bowl, clay, [1.25, 0, -.45], 1)
    pearl = glb.add('meshes', primitives=[{**ball, 'material': gold}])
    for x, y, z in ((1.1, .3, -.5), (1.42, .3, -.62), (1.3, .3, -.24), (1.28, .53, -.46),
                    (-.05, .16, 1.15), (1.35, .16, .75)):
        glb.node(mesh=pearl, translation=[x, y, z], scale=[.16] * 3)
    # Turned over, so that it shines downwards.
    glb.place(table, lamp, [-1.5, 3.2, 1.2], .6, rotation=[.966, 0, .259, 0])
    glb.root['extensionsUsed'].append('KHR_lights_punctual')
    glb.root['extensions'] = {'KHR_lights_punctual': {'lights': [
        {'type': 'spot', 'color': [.6, .75, 1], 'intensity': 12000,
         'spot': {'innerConeAngle': .3, 'outerConeAngle': .6}}]}}
    glb.look((3.2, 2.6, 1.6), (.3, .3, 0), extensions={'KHR_lights_punctual': {'light': 0}})
    camera = glb.add('cameras', type='perspective', name='view', perspective={
        'yfov': .52, 'aspectRatio': 1, 'znear': .1})
    glb.look((.8, 2.6, 5.4), (.15, .55, 0), camera=camera)
    glb.write('gltf/scene.glb')


if __name__ == '__main__':
    goblet()
    revolve('caustic/shade.ply', [(.34, 0), (.37, .2), (.36, .45), (.3, .7), (.24, .85)], 32)
    revolve('textured/pot.ply',
            [(0, 0), (.3, 0), (.31, .02), (.36, .3), (.42, .6), (.44, .68), (.5, .69), (.51, .72),
             (.51, .84), (.5, .86), (.46, .86), (.44, .83), (.42, .7)], 40)
    bricks()
    leaf()
    plants()
    sky()
    bulbs()
    still_life()
