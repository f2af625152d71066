"""Evaluates sockets of materials by Cycles: to a plain value, or to an image over UVs."""
import bpy
import numpy as np

_UV = "lull"  # the layer of meshes whose own UVs do not fit
_PLAIN = 4  # pixels across, of a value that is the same everywhere


class Baker:
    """Bakes in a scene of its own. `size` is that of images that have no size of their own, in pixels."""

    def __init__(self, size):
        self.size = size
        self.scene = bpy.data.scenes.new('lull bake')
        self.scene.render.engine = 'CYCLES'
        self.scene.cycles.samples = 1
        self.scene.cycles.use_denoising = False
        self.scene.cycles.device = 'CPU'
        self.scene.render.bake.margin = 8
        self.unwrapped = set()

    def plain(self, material, socket):
        """Returns the R, G, B of a socket that is the same everywhere."""
        return self._bake(material, socket, self._square(()), _PLAIN)[:, :, :3].mean((0, 1))

    def over_uvs(self, material, socket, names, size, kind='EMIT'):
        """Returns the pixels over a square, whose UV layers have these names."""
        return self._bake(material, socket, self._square(names), size or self.size, kind)

    def over_mesh(self, material, socket, mesh, matrix, kind='EMIT'):
        """Returns the pixels over the UV layer `lull` of a mesh, which it adds."""
        o = bpy.data.objects.new('bake', mesh)
        o.matrix_world = matrix
        self.scene.collection.objects.link(o)
        if mesh.name not in self.unwrapped:
            self._unwrap(o, mesh)
            self.unwrapped.add(mesh.name)
        return self._bake(material, socket, o, self.size, kind)

    def end(self):
        bpy.data.scenes.remove(self.scene)

    def _square(self, names):
        mesh = bpy.data.meshes.new('bake')
        mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
        for name in names or ("UVMap",):
            layer = mesh.uv_layers.new(name=name)
            for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
                loop.uv = uv
        o = bpy.data.objects.new('bake', mesh)
        self.scene.collection.objects.link(o)
        return o

    def _unwrap(self, o, mesh):
        active = mesh.uv_layers.active_index
        mesh.uv_layers.new(name=_UV)
        mesh.uv_layers.active = mesh.uv_layers[_UV]
        self._select(o)
        bpy.ops.object.mode_set(mode='EDIT')
        bpy.ops.mesh.select_all(action='SELECT')
        bpy.ops.uv.smart_project(island_margin=0.005)
        bpy.ops.object.mode_set(mode='OBJECT')
        mesh.uv_layers.active_index = max(active, 0)

    def _select(self, o):
        bpy.context.window.scene = self.scene
        layer = self.scene.view_layers[0]
        for other in layer.objects:
            other.select_set(False)
        o.select_set(True)
        layer.objects.active = o

    def _bake(self, material, socket, o, size, kind='EMIT'):
        """Renders what a socket says into an image; for normals, what the surface itself does."""
        image = bpy.data.images.new('bake', size, size, alpha=True, float_buffer=True)
        image.colorspace_settings.name = 'Non-Color'
        before = bpy.context.window.scene
        mesh = o.data
        old, faces = list(mesh.materials), [p.material_index for p in mesh.polygons]
        own = material.copy()
        tree = own.node_tree
        if kind == 'EMIT':
            _emit(tree, tree.nodes[socket.node.name].outputs[_index(socket)])
        blank = bpy.data.materials.new('blank')
        blank.use_nodes = True
        mesh.materials.clear()
        for slot in old or [material]:
            mesh.materials.append(own if slot is None or slot == material or len(old) < 2 else blank)
        if own not in list(mesh.materials):
            mesh.materials[0] = own
        if len(faces) > 1:
            mesh.polygons.foreach_set("material_index", faces)
        for each in (own, blank):
            target = each.node_tree.nodes.new('ShaderNodeTexImage')
            target.image = image if each == own else _scrap()
            each.node_tree.nodes.active = target
        uvs = mesh.uv_layers
        active = uvs.active_index
        if _UV in uvs:
            uvs.active = uvs[_UV]
        self._select(o)
        bpy.ops.object.bake(type=kind)
        pixels = np.empty(size * size * 4, np.float32)
        image.pixels.foreach_get(pixels)
        uvs.active_index = max(active, 0)
        mesh.materials.clear()
        for slot in old:
            mesh.materials.append(slot)
        if len(faces) > 1:
            mesh.polygons.foreach_set("material_index", faces)
        bpy.data.objects.remove(o)
        bpy.data.materials.remove(own)
        bpy.data.materials.remove(blank)
        bpy.data.images.remove(image)
        bpy.context.window.scene = before
        return pixels.reshape(size, size, 4)


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
