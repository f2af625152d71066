"""Meshes as a render shows them, as arrays."""
import copy

import numpy as np

_KINDS = {'FLOAT': ("value", 1, np.float32), 'INT': ("value", 1, np.int32), 'BOOLEAN': ("value", 1, bool),
          'FLOAT_VECTOR': ("vector", 3, np.float32), 'FLOAT2': ("vector", 2, np.float32),
          'FLOAT_COLOR': ("color", 4, np.float32), 'BYTE_COLOR': ("color", 4, np.float32)}
_OF_BLENDER = {"position", "material_index", "sharp_face", "sharp_edge", "crease_edge", "crease_vert", "bevel_weight_edge"}
FAR = 1e11  # from which on lull traces no rays; neither is a point there that is no number
GENERATED = "lull generated"  # the attribute of generated coordinates, in bakes


class Mesh:
    """`corners` are the vertices of the corners of faces, which begin at `starts`; `normals`, `uvs` and `colours`, by their names, are
    of corners; `triangles` are of corners, and belong to `faces`. `slots` are the materials of faces, numbers of `materials`."""

    def __init__(self, name, points, corners, starts, slots=None):
        self.name, self.points, self.corners, self.starts = name, points, corners, starts
        self.slots = np.zeros(len(starts), np.int32) if slots is None else slots
        self.triangles = self.faces = self.normals = None
        self.smooth = np.ones(len(starts), bool)
        self.uvs, self.colours, self.attributes, self.materials = {}, {}, {}, [None]
        self.uv_of_render = self.colour_of_render = ""
        self.box = self.generated = None  # the place and size of generated coordinates; the coordinates of vertices, from 0 to 1

    @property
    def totals(self):
        return np.diff(self.starts, append=len(self.corners))

    def face_corners(self, face):
        return self.corners[self.starts[face]:self.starts[face] + self.totals[face]]

    def uv(self, name):
        """Returns the UVs of a name, "" for that of the render; zeros where there are none, as in Cycles."""
        found = self.uvs.get(name or self.uv_of_render)
        if found is None and name in self.attributes:
            found = self._of_corners(name)
        return np.zeros((len(self.corners), 2), np.float32) if found is None else found

    def _of_corners(self, name):
        """Returns the U and V of an attribute, such as geometry nodes store."""
        domain, values = self.attributes[name]
        if values.ndim != 2 or domain not in ('POINT', 'CORNER'):
            return None
        return np.ascontiguousarray((values if domain == 'CORNER' else values[self.corners])[:, :2], np.float32)

    def colour(self, name):
        """Returns the colours of a name, "" for that of the render; None without them."""
        return self.colours.get(name or self.colour_of_render)

    def cut(self):
        """Adds triangles of faces that have none, fans, and even normals."""
        totals = self.totals
        counts = totals - 2
        self.faces = np.repeat(np.arange(len(totals)), counts)
        step = np.arange(len(self.faces)) - np.repeat(np.cumsum(counts) - counts, counts)
        first = self.starts[self.faces]
        self.triangles = np.stack([first, first + step + 1, first + step + 2], 1).astype(np.int32)
        self.normals = self.moved(np.eye(4)).normals

    def moved(self, matrix):
        """Returns a copy whose vertices a matrix, of 4 x 4, has moved; with the normals of its faces."""
        made = copy.copy(self)
        made.points = (self.points @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)
        a, b, c = (made.points[made.corners[made.triangles[:, i]]] for i in range(3))
        across = np.zeros((len(made.starts), 3))
        np.add.at(across, made.faces, np.cross(b - a, c - a))
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-20)
        made.normals = np.repeat(across, made.totals, 0).astype(np.float32)
        return made

    def as_triangles(self):
        """Makes each triangle a face of its own."""
        at = self.triangles.ravel()
        for values in self.uvs, self.colours:
            values.update({name: v[at] for name, v in values.items()})
        self.attributes = {name: (domain, v[at] if domain == 'CORNER' else v[self.faces] if domain == 'FACE' else v)
                           for name, (domain, v) in self.attributes.items()}
        self.corners, self.normals = self.corners[at], self.normals[at]
        self.slots, self.smooth = self.slots[self.faces], self.smooth[self.faces]
        self.triangles = np.arange(len(at), dtype=np.int32).reshape(-1, 3)
        self.starts, self.faces = self.triangles[:, 0], np.arange(len(self.triangles))


def _read(collection, name, width, kind):
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


def corner_normals(mesh):
    if hasattr(mesh, "calc_normals_split"):  # until 4.0
        mesh.calc_normals_split()
        return _read(mesh.loops, "normal", 3, np.float32)
    return _read(mesh.corner_normals, "vector", 3, np.float32)


def of_blender(mesh, name, asks_generated):
    """Returns the arrays of an evaluated mesh; None without faces. `asks_generated`: whether materials ask for generated coordinates."""
    if not len(mesh.polygons):
        return None
    made = Mesh(name, _read(mesh.vertices, "co", 3, np.float32), _read(mesh.loops, "vertex_index", 1, np.int32),
                _read(mesh.polygons, "loop_start", 1, np.int32), _read(mesh.polygons, "material_index", 1, np.int32))
    mesh.calc_loop_triangles()
    made.triangles = _read(mesh.loop_triangles, "loops", 3, np.int32)
    made.faces = _read(mesh.loop_triangles, "polygon_index", 1, np.int32)
    made.normals, made.smooth = corner_normals(mesh), _read(mesh.polygons, "use_smooth", 1, bool)
    is_somewhere = (abs(made.points) < FAR).all(1)
    if not is_somewhere.all():  # as in Cycles, faces are not there whose points are nowhere
        kept = is_somewhere[made.corners[made.triangles]].all(1)
        made.triangles, made.faces = made.triangles[kept], made.faces[kept]
        made.points, made.normals = np.where(is_somewhere[:, None], made.points, 0), np.nan_to_num(made.normals)
    made.uvs = {layer.name: _read(layer.data, "uv", 2, np.float32) for layer in mesh.uv_layers}
    made.uv_of_render = next((layer.name for layer in mesh.uv_layers if layer.active_render), "")
    colours = mesh.color_attributes
    for layer in colours:
        values = _read(layer.data, "color", 4, np.float32)
        made.colours[layer.name] = values[made.corners] if layer.domain == 'POINT' else values
    if 0 <= colours.render_color_index < len(colours):
        made.colour_of_render = colours[colours.render_color_index].name
    for a in mesh.attributes:
        if a.name not in made.uvs and a.name not in _OF_BLENDER and not a.name.startswith(".") and a.data_type in _KINDS and \
                a.domain in ('POINT', 'CORNER', 'FACE'):
            made.attributes[a.name] = a.domain, _read(a.data, *_KINDS[a.data_type])
    made.box = np.array(mesh.texspace_location), np.array(mesh.texspace_size)
    if asks_generated:  # of the shape before modifiers deform it
        place, size = made.box
        half = np.where(size, 0.5 / np.where(size, size, 1), 0)
        made.generated = (0.5 + (_read(mesh.vertices, "undeformed_co", 3, np.float32) - place) * half).astype(np.float32)
    return made


def write(writer, mesh, parts):
    """Adds a mesh to a file. `parts` are tuples: the number of a material, whose triangles, the names of its UV sets, that of its colours
    or None, and whether it is of the backs. Returns the number of the mesh; None without triangles."""
    primitives = []
    for material, triangles, uvs, colours, is_back in parts:
        if not len(triangles):
            continue
        rows = [mesh.points[mesh.corners], -mesh.normals if is_back else mesh.normals]
        names = ["POSITION", "NORMAL"]
        for i, name in enumerate(uvs):
            uv = mesh.uv(name)
            rows.append(np.stack([uv[:, 0], 1 - uv[:, 1]], 1))
            names.append(f"TEXCOORD_{i}")
        if colours is not None and (values := mesh.colour(colours)) is not None:
            rows.append(values)
            names.append("COLOR_0")
        triangles = triangles[:, ::-1] if is_back else triangles
        kept, indices = _shared(mesh, rows[1:], triangles)
        attributes = {name: writer.array(values[kept].astype(np.float32, copy=False), name == "POSITION")
                      for name, values in zip(names, rows)}
        made = {"attributes": attributes, "indices": writer.array(indices.astype(np.uint32))}
        primitives.append(made if material is None else {**made, "material": material})
    return writer.add("meshes", {"name": mesh.name, "primitives": primitives}) if primitives else None


def _shared(mesh, rows, triangles):
    """Returns the corners whose values are written, one for all corners of a vertex that have the same, and the triangles' indices."""
    used = triangles.ravel()
    first = np.full(len(mesh.points), -1, np.int64)
    first[mesh.corners[used][::-1]] = used[::-1]
    own = np.arange(len(mesh.corners))
    like = first[mesh.corners]  # for each corner the first of its vertex; -1 where it is not used
    same = like >= 0
    for values in rows:
        same &= (values[like] == values).all(1)
    stands = np.where(same, like, own)[used]
    is_kept = np.zeros(len(own), bool)
    is_kept[stands] = True
    number = np.cumsum(is_kept) - 1
    return np.flatnonzero(is_kept), number[stands]
