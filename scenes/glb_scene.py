"""glTF files of scenes that a script makes, with the functions of PbrtScene (cages.py). Needs Python alone.

Cages are subdivided here, as glTF has no subdivision. pbrt's axes are left-handed, glTF's right-handed: z changes
its sign.
"""
import array
import contextlib
import json
import math
import struct


class Glb:
    """Collects a glTF scene and writes it as one .glb file."""

    def __init__(self):
        self.data = b''
        self.root = {'asset': {'version': '2.0', 'generator': 'glb_scene.py'}, 'scene': 0,
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


def subdivided(points, triangles):
    """Returns a mesh after one step of Loop's subdivision."""
    edges, rim = {}, {}
    for a, b, c in triangles:
        for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
            edges.setdefault((min(p, q), max(p, q)), []).append(r)
    around = [set() for _ in points]
    for (p, q), opposite in edges.items():
        around[p].add(q)
        around[q].add(p)
        if len(opposite) == 1:
            rim.setdefault(p, []).append(q)
            rim.setdefault(q, []).append(p)

    def mean(weighted):
        return tuple(sum(w * points[i][axis] for i, w in weighted) for axis in range(3))

    moved = []
    for i in range(len(points)):
        if i in rim:
            moved.append(mean([(i, .75), (rim[i][0], .125), (rim[i][1], .125)]))
            continue
        n = len(around[i])
        beta = 3 / 16 if n == 3 else 3 / (8 * n)
        moved.append(mean([(i, 1 - n * beta)] + [(j, beta) for j in sorted(around[i])]) if n else points[i])
    middle = {}
    for (p, q), opposite in edges.items():
        middle[p, q] = len(moved)
        moved.append(mean([(p, .5), (q, .5)] if len(opposite) == 1 else
                          [(p, .375), (q, .375), (opposite[0], .125), (opposite[1], .125)]))
    faces = []
    for a, b, c in triangles:
        ab, bc, ca = (middle[min(p, q), max(p, q)] for p, q in ((a, b), (b, c), (c, a)))
        faces += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return moved, faces


def normals_of(points, triangles):
    """Returns the mean normal at each point, weighted by area."""
    sums = [[0, 0, 0] for _ in points]
    for face in triangles:
        p, q, r = (points[k] for k in face)
        u, v = [b - a for a, b in zip(p, q)], [b - a for a, b in zip(p, r)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for k in face:
            sums[k] = [a + b for a, b in zip(sums[k], n)]
    return [[c / (math.hypot(*n) or 1) for c in n] for n in sums]


def matrix(at, turn=0, tilt=0, roll=0, scale=(1, 1, 1)):
    """Returns rows of Translate(at) Rotate(turn, y) Rotate(tilt, x) Rotate(roll, z) Scale, with z turned round."""
    (ct, st), (cx, sx), (cz, sz) = ((math.cos(math.radians(a)), math.sin(math.radians(a))) for a in (turn, tilt, roll))
    rows = product([[ct, 0, st, at[0]], [0, 1, 0, at[1]], [-st, 0, ct, at[2]], [0, 0, 0, 1]],
                   product([[1, 0, 0, 0], [0, cx, -sx, 0], [0, sx, cx, 0], [0, 0, 0, 1]],
                           [[cz * scale[0], -sz * scale[1], 0, 0], [sz * scale[0], cz * scale[1], 0, 0],
                            [0, 0, scale[2], 0], [0, 0, 0, 1]]))
    flip = (1, 1, -1, 1)
    return [[flip[i] * rows[i][j] * flip[j] for j in range(4)] for i in range(4)]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


class GlbScene(Glb):
    """`material_of(glb, name)` adds a material and returns its number."""

    def __init__(self, material_of):
        super().__init__()
        self.material_of, self.materials, self.objects, self.stack = material_of, {}, {}, []
        self.current = None  # primitives of the object that is being described

    @contextlib.contextmanager
    def placed(self, at, turn=0, tilt=0, roll=0):
        self.stack.append(matrix(at, turn, tilt, roll))
        yield
        self.stack.pop()

    @contextlib.contextmanager
    def object(self, name):
        self.current = []
        yield
        self.objects[name], self.current = self.add('meshes', name=name, primitives=self.current), None

    def shape(self, material, shape, levels=2, textured=False, file=None):
        points, triangles, *uvs = shape
        for _ in range(0 if uvs else levels):
            points, triangles = subdivided(points, triangles)
        points = [(x, y, -z) for x, y, z in points]
        triangles = [(a, c, b) for a, b, c in triangles]
        primitive = {'attributes': {'POSITION': self.accessor('f', 'VEC3', points)},
                     'indices': self.indices(triangles), 'material': self.number_of(material)}
        if not uvs:
            primitive['attributes']['NORMAL'] = self.bytes_of(normals_of(points, triangles))
        elif textured:
            primitive['attributes']['TEXCOORD_0'] = self.accessor('f', 'VEC2', [(u, 1 - v) for u, v in uvs[0]])
        if self.current is not None:
            self.current.append(primitive)
        else:
            self.place_mesh(self.add('meshes', primitives=[primitive]))

    def instance(self, name, at, turn=0, tilt=0, roll=0, scale=(1, 1, 1)):
        with self.placed(at, round(turn), round(tilt), round(roll)):
            self.place_mesh(self.objects[name], scale)

    def place_mesh(self, mesh, scale=(1, 1, 1)):
        rows = matrix((0, 0, 0), scale=scale)
        for outer in reversed(self.stack):
            rows = product(outer, rows)
        self.node(mesh=mesh, matrix=[round(rows[i][j], 6) for j in range(4) for i in range(4)])

    def number_of(self, name):
        if name not in self.materials:
            self.materials[name] = self.material_of(self, name)
        return self.materials[name]

    def accessor(self, code, kind, rows):
        data = array.array(code, [v for row in rows for v in row])
        rows = list(zip(*[iter(data)] * len(rows[0])))  # as they are rounded
        return self.add('accessors', componentType=5126, count=len(rows), type=kind,
                        bufferView=self.view(data.tobytes()),
                        **{end.__name__: [end(column) for column in zip(*rows)] for end in (min, max)})

    def bytes_of(self, normals):
        data = array.array('b', [v for n in normals for v in (*(round(127 * c) for c in n), 0)]).tobytes()
        return self.add('accessors', componentType=5120, count=len(normals), type='VEC3', normalized=True,
                        bufferView=self.view(data, byteStride=4))

    def indices(self, triangles):
        flat = [k for t in triangles for k in t]
        small = max(flat) < 65535
        return self.add('accessors', componentType=5123 if small else 5125, count=len(flat), type='SCALAR',
                        bufferView=self.view(array.array('H' if small else 'I', flat).tobytes()))
