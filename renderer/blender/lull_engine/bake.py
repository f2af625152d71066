"""Evaluates sockets of materials by Cycles: to a plain value, or to an image over UVs."""
import bmesh
import bpy
import numpy as np

import generated
import scenes

_UV = "lull"  # the layer of meshes whose own UVs do not fit
_USED = 0.6  # of an image, by the faces of an unwrapped mesh
_SHORT = 1e-6  # of the longest edge
_PLAIN = 4  # pixels across, of a value that is the same everywhere


class Baker:
    """Bakes in a scene of its own, for the view of another. `size` is that of images that have no size of their own, in pixels."""

    def __init__(self, size, view):
        self.size, self.view = size, view
        self.scene = scenes.made_at('lull bake', view)
        self.scene.render.engine = 'CYCLES'
        self.scene.cycles.samples = 1
        self.scene.cycles.use_denoising = False
        self.scene.cycles.device = 'CPU'
        self.scene.render.bake.margin = 8

    def plain(self, material, socket):
        """Returns the R, G, B of a socket that is the same everywhere."""
        return self._bake(material, socket, self._square(()), _PLAIN)[:, :, :3].mean((0, 1))

    def over_uvs(self, material, socket, names, size):
        """Returns the pixels over a square, whose UV layers have these names."""
        return self._bake(material, socket, self._square(names), size or self.size)

    def over_mesh(self, material, socket, placed, slot, kind='EMIT'):
        """Returns the pixels over the UV layer `lull` of an object's mesh, which it adds, where the mesh has the material `slot`."""
        o = placed.copy()
        self.scene.collection.objects.link(o)
        if _UV not in o.data.uv_layers:
            self._unwrap(o)
        o.data = o.data.copy()
        o.data.uv_layers.active = o.data.uv_layers[_UV]
        others = [i for i, m in enumerate(o.data.materials) if m != slot]
        name = o["lull_source"]
        original = bpy.data.objects.get(name)
        if original:
            original.name = "lull original"
        o.name = name  # by which Cycles chooses random numbers
        pixels = self._bake(material, socket, o, self.size, others, kind)
        if original:
            original.name = name
        baked = pixels[:, :, 3] > 0
        if baked.any():  # others do not count in averages
            pixels[~baked] = pixels[baked].mean(0)
        return pixels

    def is_coarse(self, o):
        """Returns whether pixels over the mesh of an object are wider than two pixels of the view, where it is nearest."""
        camera, matrix = self.view.camera, np.array(o.matrix_world)
        eye = np.array(o.matrix_world.inverted() @ camera.matrix_world.translation)
        corners = np.array(o.bound_box)
        near = matrix[:3, :3] @ (np.clip(eye, corners.min(0), corners.max(0)) - eye)
        areas = np.empty(len(o.data.polygons))
        o.data.polygons.foreach_get("area", areas)
        area = areas.sum() * abs(np.linalg.det(matrix[:3, :3])) ** (2 / 3)
        r, lens = self.view.render, camera.data
        sides = {'HORIZONTAL': r.resolution_x, 'VERTICAL': r.resolution_y}
        side = sides.get(lens.sensor_fit, max(sides.values())) * r.resolution_percentage / 100
        width = lens.ortho_scale if lens.type == 'ORTHO' else 2 * np.tan(lens.angle / 2) * np.linalg.norm(near)
        return np.sqrt(area / _USED) / self.size > 2 * width / side

    def end(self):
        bpy.data.scenes.remove(self.scene)

    def _square(self, names):
        mesh = bpy.data.meshes.new('bake')
        mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
        mesh.materials.append(None)
        for name in names or ("UVMap",):
            layer = mesh.uv_layers.new(name=name)
            for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
                loop.uv = uv
        o = bpy.data.objects.new('bake', mesh)
        self.scene.collection.objects.link(o)
        return o

    def _unwrap(self, o):
        _divide_degenerate(o.data)
        layers = o.data.uv_layers
        active = layers.active_index
        layers.active = layers.new(name=_UV)
        self._select(o)
        bpy.ops.object.mode_set(mode='EDIT')
        bpy.ops.mesh.select_all(action='SELECT')
        bpy.ops.uv.smart_project(island_margin=0.005)
        bpy.ops.object.mode_set(mode='OBJECT')
        layers.active_index = max(active, 0)

    def _select(self, o):
        bpy.context.window.scene = self.scene
        layer = self.scene.view_layers[0]
        for other in layer.objects:
            other.select_set(False)
        o.select_set(True)
        layer.objects.active = o

    def _bake(self, material, socket, o, size, others=(), kind='EMIT'):
        """Renders the value of a socket, or the normals of the surface, into an image. Removes the object and its mesh; `others`
        are the slots of its other materials."""
        image = bpy.data.images.new('bake', size, size, alpha=True, float_buffer=True)
        image.colorspace_settings.name = 'Non-Color'
        image.pixels.foreach_set(np.zeros(size * size * 4, np.float32))  # clearing would leave an alpha of 1
        before, mesh = bpy.context.window.scene, o.data
        own, blank = material.copy(), bpy.data.materials.new('blank')
        blank.use_nodes = True
        if kind == 'EMIT':
            _emit(own.node_tree, own.node_tree.nodes[socket.node.name].outputs[_index(socket)])
        generated.take(own.node_tree, mesh)
        _aim(own, image)
        _aim(blank, _scrap())
        for i in range(len(mesh.materials)):
            mesh.materials[i] = blank if i in others else own
        self._select(o)
        bpy.ops.object.bake(type=kind, use_clear=False)
        pixels = np.empty(size * size * 4, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.objects.remove(o)
        bpy.data.meshes.remove(mesh)
        for made in own, blank:
            bpy.data.materials.remove(made)
        bpy.data.images.remove(image)
        bpy.context.window.scene = before
        return pixels.reshape(size, size, 4)


def _divide_degenerate(mesh):
    """Makes triangles of polygons with corners in one place, which would be unwrapped to a line."""
    points, edges = np.empty(3 * len(mesh.vertices), np.float32), np.empty(2 * len(mesh.edges), int)
    mesh.vertices.foreach_get("co", points)
    mesh.edges.foreach_get("vertices", edges)
    starts, ends = points.reshape(-1, 3)[edges.reshape(-1, 2)].transpose(1, 0, 2)
    lengths = np.linalg.norm(ends - starts, axis=1)
    short = np.flatnonzero(lengths < _SHORT * lengths.max(initial=0))
    if not len(short):
        return
    edited = bmesh.new()
    edited.from_mesh(mesh)
    edited.edges.ensure_lookup_table()
    faces = {f for i in short for f in edited.edges[i].link_faces if len(f.verts) > 3}
    bmesh.ops.triangulate(edited, faces=list(faces))
    edited.to_mesh(mesh)
    edited.free()


def _aim(material, image):
    """Lets a bake write into an image where a mesh has the material."""
    target = material.node_tree.nodes.new('ShaderNodeTexImage')
    target.image = image
    material.node_tree.nodes.active = target


def _scrap():
    return bpy.data.images.get('lull scrap') or bpy.data.images.new('lull scrap', 4, 4)


def _index(socket):
    return list(socket.node.outputs).index(socket)


def _emit(tree, socket):
    """Lets the surface shine as a socket says."""
    output = tree.get_output_node('CYCLES')
    emission = tree.nodes.new('ShaderNodeEmission')
    tree.links.new(socket, emission.inputs['Color'])
    tree.links.new(emission.outputs[0], output.inputs['Surface'])
    for name in 'Volume', 'Displacement':
        for link in list(output.inputs[name].links):
            tree.links.remove(link)
