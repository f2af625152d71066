"""Evaluates nodes by Cycles, to a plain value or to an image over UVs; in another Blender (see second.py)."""
import bpy
import numpy as np

from . import displacement, shown
from .meshes import GENERATED, corner_normals
from .rebuild import built

_UV = "lull"  # the layer of meshes whose own UVs do not fit
_PLAIN = 4  # pixels across, of a value that is the same everywhere
_KINDS = {1: ('FLOAT', "value"), 2: ('FLOAT2', "vector"), 3: ('FLOAT_VECTOR', "vector"), 4: ('FLOAT_COLOR', "color")}


class Baker:
    """Bakes in a scene of its own, of a frame."""

    def __init__(self, frame, subframe):
        self.scene = bpy.data.scenes.new('lull bake')
        self.scene.frame_set(frame, subframe=subframe)
        self.scene.render.engine = 'CYCLES'
        self.scene.cycles.samples = 1
        self.scene.cycles.use_denoising = False
        self.scene.cycles.device = 'CPU'
        self.scene.render.bake.margin = 8

    def plain(self, described, what=None):
        """Returns the R, G, B of a value that is the same everywhere, or on an object, described as in body()."""
        o = self._square(())
        if what is not None:
            _liken(o, what)
        return self._bake(described, o, _PLAIN)[:, :, :3].mean((0, 1))

    def over_uvs(self, described, names, size):
        """Returns the pixels over a square, whose UV layers have these names."""
        return self._bake(described, self._square(names), size)[:, :, :3]

    def over_mesh(self, described, mesh, size, slots, kind):
        """Returns the pixels over the UV layer `lull` of a Body, where it has the material of these slots."""
        pixels = self._bake(described, mesh.placed(self.scene), size, mesh, slots, kind)
        baked = pixels[:, :, 3] > 0
        if baked.any():  # others do not count in averages
            pixels[~baked] = pixels[baked].mean(0)
        return pixels[:, :, :3]

    def body(self, arrays, what):
        """Returns a mesh of its arrays, unwrapped. `what` has the name, matrix, color, pass_index and properties of its object."""
        return _Body(arrays, what, self)

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

    def select(self, o):
        bpy.context.window.scene = self.scene
        layer = self.scene.view_layers[0]
        layer.update()  # removed objects are in its list
        for other in layer.objects:
            other.select_set(False)
        o.select_set(True)
        layer.objects.active = o

    def _bake(self, described, o, size, body=None, slots=(0,), kind='EMIT'):
        """Renders a value, or the normals of a surface that a value tilts or displaces, into an image. Removes the object."""
        image = bpy.data.images.new('bake', size, size, alpha=True, float_buffer=True)
        image.colorspace_settings.name = 'Non-Color'
        image.pixels.foreach_set(np.zeros(size * size * 4, np.float32))  # clearing would leave an alpha of 1
        own, blank = bpy.data.materials.new('own'), bpy.data.materials.new('blank')
        own.use_nodes = blank.use_nodes = True
        _show(own, described, kind)
        if body is not None and body.has_generated:
            _take_generated(own.node_tree)
        _aim(own, image)
        _aim(blank, bpy.data.images.get('lull scrap') or bpy.data.images.new('lull scrap', 4, 4))
        for i in range(len(o.data.materials)):
            o.data.materials[i] = own if i in slots else blank
        self.select(o)
        bpy.ops.object.bake(type='EMIT' if kind == 'EMIT' else 'NORMAL', use_clear=False)
        pixels = np.empty(size * size * 4, np.float32)
        image.pixels.foreach_get(pixels)
        mesh = o.data
        bpy.data.objects.remove(o)
        if body is None:
            bpy.data.meshes.remove(mesh)
        for made in own, blank:
            bpy.data.materials.remove(made)
        bpy.data.images.remove(image)
        return pixels.reshape(size, size, 4)


class _Body:
    """A mesh of arrays, for all bakes over it."""

    def __init__(self, arrays, what, baker):
        self.what, self.has_generated = what, "generated" in arrays
        mesh = self.mesh = bpy.data.meshes.new(what["name"])
        starts, corners = arrays["starts"], arrays["corners"]
        mesh.vertices.add(len(arrays["points"]))
        mesh.vertices.foreach_set("co", arrays["points"].ravel())
        mesh.loops.add(len(corners))
        mesh.loops.foreach_set("vertex_index", corners)
        mesh.polygons.add(len(starts))
        mesh.polygons.foreach_set("loop_start", starts)
        if bpy.app.version < (4, 0):
            mesh.polygons.foreach_set("loop_total", np.diff(starts, append=len(corners)).astype(np.int32))
        mesh.polygons.foreach_set("material_index", arrays["slots"])
        mesh.update(calc_edges=True)
        for _ in range(int(arrays["slots"].max(initial=0)) + 1):
            mesh.materials.append(None)
        for kind, name in (key.split(" ", 1) for key in arrays if " " in key):
            values = arrays[f"{kind} {name}"]
            if kind == "uv":
                if layer := mesh.uv_layers.new(name=name):  # there are eight
                    layer.data.foreach_set("uv", values.ravel())
                    layer.active_render = name == what["uv"]
            elif kind == "colour":
                mesh.color_attributes.new(name, 'FLOAT_COLOR', 'CORNER').data.foreach_set("color", values.ravel())
                mesh.color_attributes.render_color_index = [c.name for c in mesh.color_attributes].index(what["colour"] or name)
            elif name not in mesh.attributes:
                type_, field = _KINDS[values.shape[1] if values.ndim > 1 else 1]
                if made := mesh.attributes.new(name, type_, kind):  # of Blender's own it makes none of another type
                    made.data.foreach_set(field, values.astype(np.float32).ravel())
        if self.has_generated:
            mesh.attributes.new(GENERATED, 'FLOAT_VECTOR', 'POINT').data.foreach_set("vector", arrays["generated"].ravel())
        mesh.use_auto_texspace = False
        mesh.texspace_location, mesh.texspace_size = what["box"]
        self._unwrap(baker)
        if what["moves"]:  # with normals of its own then
            mesh.polygons.foreach_set("use_smooth", arrays["smooth"])
            return
        mesh.polygons.foreach_set("use_smooth", np.ones(len(starts), bool))
        if hasattr(mesh, "use_auto_smooth"):
            mesh.use_auto_smooth = True
        mesh.normals_split_custom_set(arrays["normals"])

    def uvs(self):
        values = np.empty(2 * len(self.mesh.loops), np.float32)
        self.mesh.uv_layers[_UV].data.foreach_get("uv", values)
        return values.reshape(-1, 2)

    def placed(self, scene):
        """Returns a new object of the mesh."""
        o = bpy.data.objects.new("placed", self.mesh)
        _liken(o, self.what)
        scene.collection.objects.link(o)
        self.mesh.uv_layers.active = self.mesh.uv_layers[_UV]
        return o

    def displace(self, baker, described, size, slots):
        """Returns the vector at each corner by which nodes displace the mesh."""
        return displacement.sampled(baker.over_mesh(described, self, size, slots, 'EMIT') - displacement.RAISED, self.uvs())

    def move(self, points):
        """Moves the vertices. Returns the normals of corners."""
        self.mesh.vertices.foreach_set("co", points.astype(np.float32).ravel())
        self.mesh.update()
        return corner_normals(self.mesh)

    def _unwrap(self, baker):
        o = bpy.data.objects.new("unwrapped", self.mesh)
        baker.scene.collection.objects.link(o)
        layers = self.mesh.uv_layers
        while len(layers) > 7:
            layers.remove(layers[7])
        layers.active = layers.new(name=_UV)
        baker.select(o)
        bpy.ops.object.mode_set(mode='EDIT')
        bpy.ops.mesh.select_all(action='SELECT')
        bpy.ops.uv.smart_project(island_margin=0.005)
        bpy.ops.object.mode_set(mode='OBJECT')
        bpy.data.objects.remove(o)


def _liken(o, what):
    """Gives an object the name, by which Cycles chooses random numbers, the place and the properties of another."""
    if other := bpy.data.objects.get(what["name"]):
        other.name = "lull other"
    o.name, o.color, o.pass_index = what["name"], what["color"], what["pass_index"]
    for name, value in what["properties"].items():
        o[name] = value
    o.matrix_world = matrix = shown.Matrix(what["matrix"])
    if shown.is_sheared(matrix):
        o.parent = bpy.data.objects.get("lull parent") or bpy.data.objects.new("lull parent", None)
        o.matrix_parent_inverse = matrix
        o.matrix_basis.identity()


def _show(material, described, kind):
    """Lets the surface shine as a value says, or have it as its normals or its displacement."""
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new('ShaderNodeOutputMaterial')
    socket = built(tree, described)
    shader = tree.nodes.new('ShaderNodeEmission' if kind == 'EMIT' else 'ShaderNodeBsdfDiffuse')
    tree.links.new(shader.outputs[0], output.inputs['Surface'])
    if kind == 'BUMP':
        tree.links.new(socket, output.inputs['Displacement'])
    else:
        tree.links.new(socket, shader.inputs['Color' if kind == 'EMIT' else 'Normal'])


def _take_generated(tree):
    """Lets nodes read the generated coordinates of an attribute."""
    source = tree.nodes.new('ShaderNodeAttribute')
    source.attribute_name = GENERATED
    for node in list(tree.nodes):
        if shown.reads_generated(node):
            tree.links.new(source.outputs['Vector'], node.inputs['Vector'])
        elif node.type == 'TEX_COORD' and not node.from_instancer:
            for link in list(node.outputs['Generated'].links):
                tree.links.new(source.outputs['Vector'], link.to_socket)


def _aim(material, image):
    """Lets a bake write into an image where a mesh has the material."""
    target = material.node_tree.nodes.new('ShaderNodeTexImage')
    target.image = image
    material.node_tree.nodes.active = target
