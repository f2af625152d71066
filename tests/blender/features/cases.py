"""The list of features, and a scene to show each in, with functions that change it. For Blender's Python."""
import json
import os
import sys

import bpy
import numpy as np

from compatible import add_input, add_output, new_node, set_input

CASES = {}


def folder():
    """Returns the folder of the pictures, for files that scenes need."""
    return json.loads(sys.argv[-1])["folder"]


def case(title):
    """Lists a function that changes the scene of begin()."""
    def add(function):
        CASES[function.__name__] = title, function
        return function
    return add


def begin():
    """A ball on a floor, under a square lamp and a grey sky. Returns the scene."""
    scene, others = bpy.data.scenes.new("case"), list(bpy.data.scenes)
    for kind in ("objects", "meshes", "materials", "lights", "cameras", "worlds", "node_groups", "particles", "curves", "images",
                 "texts", "collections", "libraries"):
        blocks = getattr(bpy.data, kind)
        for block in list(blocks):
            blocks.remove(block)
    bpy.context.window.scene = scene
    for other in others:
        if other != scene:
            bpy.data.scenes.remove(other)
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.3, 0.33, 0.4, 1)
    bpy.ops.mesh.primitive_plane_add(size=12)
    dress(matte("floor", (0.5, 0.5, 0.5, 1))).name = "floor"
    ball(matte("ball", (0.6, 0.2, 0.1, 1)))
    lamp('AREA', 400, (1.5, -2, 5), (0.35, 0, 0.26), size=1).name = "key"
    camera((0, -6, 2.5), (1.25, 0, 0), lens=35)
    return scene


def material(name, kind, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output, shader = tree.nodes.new('ShaderNodeOutputMaterial'), node(tree, 'ShaderNode' + kind, **inputs)
    tree.links.new(shader.outputs[0], output.inputs['Surface'])
    return made


def matte(name="matte", color=(0.6, 0.5, 0.4, 1)):
    return material(name, 'BsdfDiffuse', Color=color)


def dress(made, smooth=False):
    o = bpy.context.object
    if made:
        o.data.materials.append(made)
    for polygon in o.data.polygons:
        polygon.use_smooth = smooth
    return o


def lamp(kind, energy, at, turned=(0, 0, 0), **more):
    bpy.ops.object.light_add(type=kind, location=at, rotation=turned)
    light = bpy.context.object.data
    light.energy = energy
    if hasattr(light, "shadow_soft_size"):
        light.shadow_soft_size = 0
    for key, value in more.items():
        setattr(light, key, value)
    return bpy.context.object


def camera(at, turned, **more):
    bpy.ops.object.camera_add(location=at, rotation=turned)
    bpy.context.scene.camera = bpy.context.object
    for key, value in more.items():
        setattr(bpy.context.object.data, key, value)


def ball(made, x=0):
    bpy.ops.mesh.primitive_uv_sphere_add(location=(x, 0, 0.7), radius=0.7, segments=32, ring_count=16)
    bpy.context.object.name = "ball"
    return dress(made, smooth=True)


def the(name):
    return bpy.data.objects[name]


def without(*names):
    for name in names:
        bpy.data.objects.remove(the(name))


def set_apart(scene, o, name):
    """Moves an object to a new collection. Returns the collection's settings in the first view layer."""
    made = bpy.data.collections.new(name)
    scene.collection.children.link(made)
    made.objects.link(o)
    scene.collection.objects.unlink(o)
    return scene.view_layers[0].layer_collection.children[name]


def parts_of(*objects):
    """Moves objects out of the scene, into a new collection."""
    made = bpy.data.collections.new("parts")
    for o in objects:
        made.objects.link(o)
        bpy.context.scene.collection.objects.unlink(o)
    return made


def empty(collection=None, within=None, **values):
    """Adds an empty object, perhaps as an instance of a collection, into the scene or within another collection."""
    made = bpy.data.objects.new("empty", None)
    (within or bpy.context.scene.collection).objects.link(made)
    if collection:
        made.instance_type, made.instance_collection = 'COLLECTION', collection
    for key, value in values.items():
        setattr(made, key, value)
    return made


def cube(made, size=1.0, at=(0, 0, 0.5), **more):
    bpy.ops.mesh.primitive_cube_add(size=size, location=at, **more)
    return dress(made)


def wall(made, x=1.5, y=0.0, z=2.0):
    """Puts a rectangle with UVs in the place of the ball."""
    if "ball" in bpy.data.objects:
        without("ball")
    mesh = bpy.data.meshes.new("wall")
    mesh.from_pydata([(-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z)], [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        loop.uv = uv
    mesh.materials.append(made)
    o = bpy.data.objects.new("wall", mesh)
    bpy.context.collection.objects.link(o)
    return o


def node(tree, kind, **values):
    """Adds a node. `values` are inputs by their names, with _ for spaces, and properties."""
    made = new_node(tree, kind)
    for key, value in values.items():
        if key in made.bl_rna.properties:
            setattr(made, key, value)
        else:
            set_input(made, key.replace("_", " "), value)
    return made


def surface(kind, **values):
    """Returns a new material of one node, the node and its tree."""
    made = material("surface", kind, **values)
    return made, made.node_tree.nodes[-1], made.node_tree


def cover(socket_owner, tree):
    tree.links.new(socket_owner.outputs[0], tree.get_output_node('ALL').inputs[0])


def link(tree, *pairs):
    for a, b in pairs:
        tree.links.new(a, b)


def mix(tree, factor, a, b):
    """Covers a material by a mixture of two nodes; None: nothing. Returns its node."""
    made = tree.nodes.new('ShaderNodeMixShader')
    if isinstance(factor, (int, float)):
        made.inputs[0].default_value = factor
    else:
        tree.links.new(factor, made.inputs[0])
    for i, one in enumerate((a, b)):
        if one:
            tree.links.new(one.outputs[0], made.inputs[1 + i])
    cover(made, tree)
    return made


def add(tree, a, b):
    """Covers a material by the sum of two nodes."""
    made = tree.nodes.new('ShaderNodeAddShader')
    link(tree, (a.outputs[0], made.inputs[0]), (b.outputs[0], made.inputs[1]))
    cover(made, tree)


def first(tree, kind):
    """Returns the first node of a type."""
    return next(n for n in tree.nodes if n.type == kind)


def geometry_nodes(o, *kinds):
    """Adds a modifier of geometry nodes. Returns their tree, the nodes of its input and output, and one of each kind."""
    group = bpy.data.node_groups.new("nodes", 'GeometryNodeTree')
    add_input(group, 'NodeSocketGeometry', "in"), add_output(group, 'NodeSocketGeometry', "out")
    o.modifiers.new("nodes", 'NODES').node_group = group
    return group, *(group.nodes.new(kind) for kind in ('NodeGroupInput', 'NodeGroupOutput', *kinds))


def principled(**values):
    return surface('BsdfPrincipled', **values)


def dressed(made, name="ball"):
    the(name).data.materials[0] = made


def checks():
    return np.stack([(np.indices((64, 64)).sum(0) // 8 % 2) * 0.6 + 0.2] * 3, -1)


def image(values, name="image", colours='sRGB'):
    """Returns a PNG of encoded values."""
    full = np.ones((*values.shape[:2], 4), np.float32)
    full[:, :, :values.shape[2]] = values
    made = bpy.data.images.new(name, full.shape[1], full.shape[0], alpha=values.shape[2] == 4)
    made.colorspace_settings.name = colours
    made.pixels.foreach_set(full.ravel())
    made.filepath_raw, made.file_format = os.path.join(folder(), name + ".png"), 'PNG'
    made.save()
    return made


def floats(values, name, kind='OPEN_EXR'):
    """Returns an image of linear values, stored as a file."""
    made = bpy.data.images.new(name, values.shape[1], values.shape[0], float_buffer=True)
    made.pixels.foreach_set(np.concatenate([values, np.ones((*values.shape[:2], 1))], 2).astype(np.float32).ravel())
    made.filepath_raw, made.file_format = os.path.join(folder(), name + (".png" if kind == 'PNG' else ".exr")), kind
    made.save()
    return made


def textured(values=None, **texture):
    """Returns a material whose colour is an image, the image's node, the surface's and the tree."""
    made, bsdf, tree = principled()
    shown = node(tree, 'ShaderNodeTexImage', image=image(checks() if values is None else values), **texture)
    tree.links.new(shown.outputs[0], bsdf.inputs['Base Color'])
    return made, shown, bsdf, tree
