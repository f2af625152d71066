#!/usr/bin/env python3
"""Makes glTF files of extensions and poses, each of quads and spheres; it needs Python alone:

    tests/side_by_side/extensions.py FOLDER

absorption.glb: KHR_materials_volume, anisotropy.glb, variants.glb: the extensions of these names;
pose.glb: a skin and morph targets, to be seen at 1 s; shutter.glb: things that move, to be seen while a
shutter is open for 0.5 s from 0.5 s on.
"""

import json
import math
import pathlib
import struct
import sys

MATTE = {'KHR_materials_specular': {'specularFactor': 0}}


class Glb:
    """Collects a scene, and writes it as one file: a matte floor and wall, a lamp above, a camera, and further objects."""

    def __init__(self):
        self.data = b''
        self.root = {'asset': {'version': '2.0', 'generator': 'extensions.py'}, 'scene': 0, 'scenes': [{'nodes': []}],
                     'extensionsUsed': []}
        grey = self.material('grey', (.6, .6, .6), 0, 1, MATTE)
        self.node(mesh=self.quad(grey), scale=(6, 6, 1), rotation=turn((1, 0, 0), -90))
        self.node(mesh=self.quad(grey), scale=(6, 6, 1), translation=(0, 3, -3))
        lamp = self.material('lamp', (0, 0, 0), 0, 1, {**MATTE, 'KHR_materials_emissive_strength': {'emissiveStrength': 6}},
                             emissiveFactor=[1, 1, .9])
        self.node(mesh=self.quad(lamp), scale=(1.5, 1.5, 1), translation=(0, 5, 2), rotation=turn((1, 0, 0), 100))
        camera = self.add('cameras', type='perspective', perspective={'yfov': .5, 'aspectRatio': 1.6, 'znear': .1})
        self.node(camera=camera, translation=(0, 2.2, 7), rotation=turn((1, 0, 0), -12))

    def add(self, kind, **entry):
        self.root.setdefault(kind, []).append(entry)
        return len(self.root[kind]) - 1

    def view(self, data, **more):
        self.data += bytes(-len(self.data) % 4)
        self.data += data
        return self.add('bufferViews', buffer=0, byteOffset=len(self.data) - len(data),
                        byteLength=len(data), **more)

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

    def accessor(self, values, kind, code='f', **more):
        """Adds numbers, in tuples, of type `kind`: 'f' floats, 'H' and 'B' whole numbers."""
        flat = [v for value in values for v in value]
        return self.add('accessors', bufferView=self.view(struct.pack(f'<{len(flat)}{code}', *flat)), count=len(values),
                        type=kind, componentType={'f': 5126, 'H': 5123, 'B': 5121}[code], **more)

    def mesh(self, points, normals, uvs, triangles, material, attributes={}, **more):
        positions = self.accessor(points, 'VEC3', min=[min(c) for c in zip(*points)], max=[max(c) for c in zip(*points)])
        attributes = dict(attributes, POSITION=positions, TEXCOORD_0=self.accessor(uvs, 'VEC2'))
        if normals:
            attributes['NORMAL'] = self.accessor(normals, 'VEC3')
        indices = self.accessor([(i,) for t in triangles for i in t], 'SCALAR', 'H')
        return self.add('meshes', primitives=[dict(attributes=attributes, indices=indices, material=material, **more)])

    def quad(self, material):
        """From -1 to 1 in the plane z = 0, its front towards +z."""
        corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
        return self.mesh(corners, [(0, 0, 1)] * 4, [(0, 1), (1, 1), (1, 0), (0, 0)],
                         [(0, 1, 2), (0, 2, 3)], material)

    def box(self, material):
        """From -1 to 1."""
        points, normals, uvs, triangles = [], [], [], []
        for axis in range(3):
            for side in (-1, 1):
                first = len(points)
                for u, v in ((-1, -1), (side, -side), (1, 1), (-side, side)):
                    p = [0, 0, 0]
                    p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, u, v
                    points.append(tuple(p))
                    normals.append(tuple(side * (i == axis) for i in range(3)))
                    uvs.append(((u + 1) / 2, (v + 1) / 2))
                triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
        self.corners = points
        return self.mesh(points, normals, uvs, triangles, material)

    def sphere(self, material, columns=64, rows=32):
        """Of radius 1 about the origin, its poles at y = -1 and 1."""
        points, uvs = [], []
        for r in range(rows + 1):
            for c in range(columns + 1):
                t, p = math.pi * r / rows, 2 * math.pi * c / columns
                points.append((math.sin(t) * math.sin(p), math.cos(t), math.sin(t) * math.cos(p)))
                uvs.append((c / columns, r / rows))
        triangles = []
        for r in range(rows):
            for c in range(columns):
                a = r * (columns + 1) + c
                b = a + columns + 1
                triangles += [(a, b, b + 1)] * (r < rows - 1) + [(a, b + 1, a + 1)] * (r > 0)
        return self.mesh(points, points, uvs, triangles, material)

    def animate(self, *channels):
        """Adds an animation of (node, path, times, values)."""
        animation = {'samplers': [], 'channels': []}
        for node, path, times, values in channels:
            kind = {3: 'VEC3', 4: 'VEC4', 1: 'SCALAR'}[len(values[0])]
            animation['channels'].append({'sampler': len(animation['samplers']), 'target': {'node': node, 'path': path}})
            animation['samplers'].append({
                'input': self.accessor([(t,) for t in times], 'SCALAR', min=[times[0]], max=[times[-1]]),
                'output': self.accessor(values, kind)})
        self.root['animations'] = [animation]


def turn(axis, degrees):
    """Returns the quaternion of a rotation."""
    half = math.radians(degrees) / 2
    return [*(math.sin(half) * a for a in axis), math.cos(half)]


def absorption():
    """Boxes and spheres of coloured glass, thicker from left to right, and of two densities."""
    glb = Glb()
    for row, distance in enumerate((1, .3)):
        glass = glb.material(f'glass {row}', (1, 1, 1), 0, 0, {
            'KHR_materials_transmission': {'transmissionFactor': 1},
            'KHR_materials_volume': {'thicknessFactor': 1, 'attenuationDistance': distance, 'attenuationColor': [.2, .7, .9]}})
        shape = glb.sphere(glass) if row == 0 else glb.box(glass)
        for i, size in enumerate((.2, .35, .5)):
            glb.node(mesh=shape, scale=(size, size, size), rotation=turn((0, 1, 0), 30 * row),
                     translation=(-1.6 + 1.5 * i, size + .001, -.8 + 1.8 * row))
    return glb


def anisotropy():
    """White metal: spheres and panels, brushed along four directions and three strengths."""
    glb = Glb()
    for i, (strength, angle) in enumerate(((.4, 0), (.8, 0), (.8, 45), (1, 90))):
        metal = glb.material(f'brushed {i}', (1, 1, 1), 1, .3, {'KHR_materials_anisotropy': {
            'anisotropyStrength': strength, 'anisotropyRotation': math.radians(angle)}})
        x = -2.1 + 1.4 * i
        glb.node(mesh=glb.sphere(metal), scale=(.6, .6, .6), translation=(x, .61, .5))
        glb.node(mesh=glb.quad(metal), scale=(.6, .6, 1), translation=(x, 2.2, -.8),
                 rotation=turn((1, 0, 0), -25))
    return glb


def variants():
    """Two spheres in three sets of colours; the floor has none."""
    glb = Glb()
    glb.root['extensionsUsed'].append('KHR_materials_variants')
    names = ('clay', 'brass', 'plastic')
    glb.root['extensions'] = {'KHR_materials_variants': {'variants': [{'name': n} for n in names]}}
    sets = [(glb.material('clay', (.7, .4, .3), 0, 1, MATTE),) * 2,
            (glb.material('brass', (.9, .7, .3), 1, .3),
             glb.material('steel', (.6, .6, .6), 1, .2)),
            (glb.material('blue', (.1, .2, .8), 0, .3),) * 2]
    for i in range(2):
        mappings = [{'material': s[i], 'variants': [v]} for v, s in enumerate(sets)]
        mesh = glb.sphere(sets[0][i])
        glb.root['meshes'][mesh]['primitives'][0]['extensions'] = {
            'KHR_materials_variants': {'mappings': mappings}}
        glb.node(mesh=mesh, translation=(-1.2 + 2.4 * i, 1.01, 0))
    return glb


def pose():
    """A strip that two joints bend, and a box that grows at a slant: both move until 1 s."""
    glb = Glb()
    red = glb.material('red', (.7, .2, .1), 0, 1, MATTE)
    blue = glb.material('blue', (.1, .3, .7), 0, 1, MATTE, doubleSided=True)
    steps = 24
    points, weights, joints = [], [], []
    for i in range(steps + 1):
        along = 2 * i / steps
        bend = min(max((along - .7) / .6, 0), 1)
        for side in (-.4, .4):
            points.append((side, along, 0))
            weights.append((1 - bend, bend, 0, 0))
            joints.append((0, 1, 0, 0))
    triangles = [t for i in range(0, 2 * steps, 2) for t in ((i, i + 1, i + 3), (i, i + 3, i + 2))]
    # Without normals: Blender makes new ones of posed meshes, others pose those of the file.
    strip = glb.mesh(points, None, [(p[0], p[1]) for p in points], triangles, blue,
                     {'JOINTS_0': glb.accessor(joints, 'VEC4', 'B'),
                      'WEIGHTS_0': glb.accessor(weights, 'VEC4')})
    lower = glb.node(translation=(-1.2, 0, .3))
    upper = glb.add('nodes', translation=(0, 1, 0))
    glb.root['nodes'][lower]['children'] = [upper]
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    bind = glb.accessor([identity, identity[:13] + [-1] + identity[14:]], 'MAT4')
    glb.add('skins', joints=[lower, upper], inverseBindMatrices=bind)
    glb.node(mesh=strip, skin=0)

    block = glb.box(red)
    primitive = glb.root['meshes'][block]['primitives'][0]
    del primitive['attributes']['NORMAL']
    pull = [(0, 1.2 * (y > 0) + .3 * x * (y > 0), 0) for x, y, _ in glb.corners]
    primitive['targets'] = [{'POSITION': glb.accessor(pull, 'VEC3', min=[0, 0, 0],
                                                      max=[0, 1.5, 0])}]
    glb.root['meshes'][block]['weights'] = [0]
    growing = glb.node(mesh=block, scale=(.6, .6, .6), translation=(1.2, .61, 0),
                       rotation=turn((0, 1, 0), 25))
    glb.animate((upper, 'rotation', (0, 1), (turn((1, 0, 0), 0), turn((1, 0, 0), 70))),
                (lower, 'rotation', (0, 1), (turn((0, 0, 1), 0), turn((0, 0, 1), -15))),
                (growing, 'weights', (0, 1), ((0,), (1,))))
    return glb


def shutter():
    """A sphere that rolls by, a box that turns and a panel that grows."""
    glb = Glb()
    red = glb.material('red', (.7, .2, .1), 0, 1, MATTE)
    green = glb.material('green', (.2, .6, .2), 0, 1, MATTE)
    blue = glb.material('blue', (.1, .3, .7), 0, 1, MATTE, doubleSided=True)
    ball = glb.node(mesh=glb.sphere(red), scale=(.6, .6, .6), translation=(-2, .61, 1))
    box = glb.node(mesh=glb.box(green), scale=(.5, .5, .5), translation=(1.6, .8, .3))
    panel = glb.node(mesh=glb.quad(blue), translation=(0, 2.4, -1), scale=(.4, .4, 1))
    glb.animate((ball, 'translation', (0, 2), ((-2.5, .61, 1), (2, .61, 1))),
                (box, 'rotation', (0, 1), (turn((0, 1, 0), 0), turn((0, 1, 0), 60))),
                (panel, 'scale', (0, 1), ((.4, .4, 1), (1.2, .6, 1))))
    return glb


if __name__ == '__main__':
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for scene in absorption, anisotropy, variants, pose, shutter:
        scene().write(folder / f'{scene.__name__}.glb')
