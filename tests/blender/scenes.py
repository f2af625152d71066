"""Makes the scenes of the tests, for blender_test.py. Runs inside Blender, with a JSON object as its last
argument: the folder to write NAME.blend to, the names, and the size and samples of the pictures that
Cycles makes of them, NAME.cycles.exr; 0 samples: none."""
import json
import math
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from compatible import (add_input, add_output, displace, new_node, offset_shadow, set_input, shadow_transparently,  # noqa: E402
                        socket)


def material(name, node, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output, surface = tree.nodes.new('ShaderNodeOutputMaterial'), new_node(tree, 'ShaderNode' + node)
    for key, value in inputs.items():
        set_input(surface, key, value)
    tree.links.new(surface.outputs[0], output.inputs['Surface'])
    return made


def dress(made, smooth=False):
    o = bpy.context.object
    if made:
        o.data.materials.append(made)
    for polygon in o.data.polygons:
        polygon.use_smooth = smooth
    return o


def floor(made):
    bpy.ops.mesh.primitive_plane_add(size=12)
    return dress(made)


def sphere(made, at, radius=0.7):
    bpy.ops.mesh.primitive_uv_sphere_add(location=at, radius=radius, segments=32, ring_count=16)
    return dress(made, smooth=True)


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
    return bpy.context.object.data


def matte(name="matte", color=(0.6, 0.5, 0.4, 1)):
    return material(name, 'BsdfDiffuse', Color=color)


def lamps(folder):
    """Primitives, lamps of all kinds, out of view, shift and depth of field; no world."""
    floor(matte())
    bpy.ops.mesh.primitive_cube_add(size=1.2, location=(-1.6, 0.5, 0.6))
    dress(matte("red", (0.8, 0.1, 0.1, 1)))
    sphere(material("metal", 'BsdfGlossy', Color=(0.9, 0.7, 0.3, 1), Roughness=0.4), (1.5, 0, 0.7))
    lamp('POINT', 60, (-3, -2, 2), shadow_soft_size=0.3, color=(1, 0.8, 0.6))
    noded = lamp('POINT', 10, (3, 3, 2)).data
    noded.use_nodes = True
    times = noded.node_tree.nodes.new('ShaderNodeMath')
    times.operation, times.inputs[0].default_value, times.inputs[1].default_value = 'MULTIPLY', 1.5, 2
    noded.node_tree.links.new(times.outputs[0], noded.node_tree.nodes["Emission"].inputs['Strength'])
    noded.node_tree.nodes["Emission"].inputs['Color'].default_value = (1, 0.5, 0.5, 1)
    lamp('SUN', 0.3, (0, 0, 5), (0.5, 0.3, 0), angle=0)
    lamp('SPOT', 150, (2, -3, 4), (0.6, 0.3, 0), spot_size=0.8)
    lamp('AREA', 40, (3.5, -1, 2.5), (0, 0.8, 0), shape='RECTANGLE', size=1.5, size_y=0.5)
    disk = lamp('AREA', 40, (-2, -2, 3), (0.4, -0.4, 0), shape='DISK', size=0.8, color=(0.4, 0.6, 1))
    disk.scale = (1.5, 1, 1)
    data = camera((0, -7, 3.2), (1.2, 0, 0), lens=35, shift_x=0.08, shift_y=-0.1)
    data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop = True, 7, 0.2


def world_image(folder):
    """Returns a picture of all directions whose parts differ, as a file of high range."""
    width, height = 64, 32
    image = bpy.data.images.new("sky", width, height, float_buffer=True)
    pixels = []
    for y in range(height):
        for x in range(width):
            sun = 60 if (x - 44) ** 2 + (y - 24) ** 2 < 5 else 0
            pixels += [0.1 + 0.5 * x / width + sun, 0.2 + sun, 0.6 * y / height + sun, 1]
    image.pixels = pixels
    image.filepath_raw, image.file_format = os.path.join(folder, "sky.exr"), 'OPEN_EXR'
    image.save()
    return image


def glass(folder):
    """Glass and an emitting sphere under a world that is an image, turned, twice as strong."""
    floor(matte())
    sphere(material("glass", 'BsdfGlass', Color=(1, 1, 1, 1), Roughness=0, IOR=1.5), (0.9, 0, 0.8))
    sphere(material("glowing", 'Emission', Color=(0.2, 1, 0.3, 1), Strength=3), (-0.9, 0.3, 0.5), 0.4)
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    background = next(n for n in nodes if n.type == 'BACKGROUND')
    background.inputs['Strength'].default_value = 2
    image, turn = nodes.new('ShaderNodeTexEnvironment'), nodes.new('ShaderNodeMapping')
    where = nodes.new('ShaderNodeTexCoord')
    image.image = world_image(folder)
    turn.inputs['Rotation'].default_value = (0.2, 0, 0.7)
    links.new(where.outputs['Generated'], turn.inputs['Vector'])
    links.new(turn.outputs['Vector'], image.inputs['Vector'])
    links.new(image.outputs['Color'], background.inputs['Color'])
    camera((0, -4.5, 2), (1.25, 0, 0))


def veil(folder):
    """A sun with an angle and a grey sky; a cube and a sheet that are partly there, whatever EEVEE's
    blend mode; one that EEVEE alone would blend; a portal, which neither shines nor shades."""
    floor(matte())
    half = material("half", 'BsdfPrincipled', **{'Base Color': (0.2, 0.3, 0.8, 1), 'Alpha': 0.4, 'Specular': 0,
                                                 'Roughness': 1})
    bpy.ops.mesh.primitive_cube_add(size=1.2, location=(-1.2, 0, 0.6))
    dress(half)
    bpy.ops.mesh.primitive_plane_add(size=1.5, location=(1, 0.5, 1))
    dress(half)
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(1, -1, 0.25))
    dress(matte("blended")).active_material.blend_method = 'BLEND'
    lamp('SUN', 1, (0, 0, 5), (0.6, 0.3, 0), angle=0.2)
    lamp('AREA', 100, (0, 0, 3), size=5).data.cycles.is_portal = True
    world = bpy.data.worlds.new("grey")
    bpy.context.scene.world = world
    world.use_nodes = True
    camera((0, -7, 3.2), (1.2, 0, 0), lens=35)


def pane(folder):
    """The sun through a pane of glass, modelled as a slab."""
    floor(matte())
    lamp('SUN', 3, (0, 0, 5), (0.3, 0, 0), angle=0)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 2), rotation=(0.1, 0, 0.4))
    bpy.context.object.scale = (4, 4, 0.02)
    dress(material("glass", 'BsdfGlass', Color=(0.9, 0.95, 0.9, 1), Roughness=0, IOR=1.45)).name = "pane"
    camera((0, -3, 1.2), (1.1, 0, 0))


def nodes(folder):
    """A group of nodes, checkers by object coordinates on the sides of a cube, in mixtures, colours of two copies, a cut by an image's other channel,
    vertices that carry copies, text, a sheared box, and an area light that is seen from behind."""
    scene = bpy.context.scene
    floor(matte())
    lamp('SUN', 2, (0, 0, 5), (0.5, 0.3, 0), angle=0)
    lamp('AREA', 20, (-2, 2, 1.2), (math.pi / 2, 0, 0), size=2)

    group = bpy.data.node_groups.new("paint", 'ShaderNodeTree')
    add_input(group, 'NodeSocketColor', "Color")
    add_output(group, 'NodeSocketShader', "Shader")
    inlet, outlet, paint = (group.nodes.new(kind) for kind in ('NodeGroupInput', 'NodeGroupOutput', 'ShaderNodeBsdfDiffuse'))
    group.links.new(inlet.outputs[0], paint.inputs['Color'])
    group.links.new(paint.outputs[0], outlet.inputs[0])
    grouped = matte("grouped")
    tree = grouped.node_tree
    node = tree.nodes.new('ShaderNodeGroup')
    node.node_tree = group
    node.inputs[0].default_value = (0.1, 0.6, 0.2, 1)
    tree.links.new(node.outputs[0], tree.get_output_node('CYCLES').inputs['Surface'])
    sphere(grouped, (-1.5, -1, 0.5), 0.5)

    checked = matte("checked", (0.7, 0.1, 0.1, 1))
    tree = checked.node_tree
    red = next(n for n in tree.nodes if n.type == 'BSDF_DIFFUSE')
    blue, mix, checker, place = (tree.nodes.new('ShaderNode' + kind) for kind in
                                 ('BsdfDiffuse', 'MixShader', 'TexChecker', 'TexCoord'))
    blue.inputs['Color'].default_value = (0.1, 0.1, 0.7, 1)
    checker.inputs['Scale'].default_value = 2
    for a, b in ((place.outputs['Object'], checker.inputs['Vector']), (checker.outputs['Fac'], mix.inputs[0]),
                 (red.outputs[0], mix.inputs[1]), (blue.outputs[0], mix.inputs[2]),
                 (mix.outputs[0], tree.get_output_node('CYCLES').inputs['Surface'])):
        tree.links.new(a, b)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 0.5))
    cube = dress(checked)
    finer = checked.copy()
    next(n for n in finer.node_tree.nodes if n.type == 'TEX_CHECKER').inputs['Scale'].default_value = 4
    cube.data.materials.append(finer)
    for polygon in cube.data.polygons:
        polygon.material_index = polygon.index % 2

    own = matte("own")
    tree = own.node_tree
    info = tree.nodes.new('ShaderNodeObjectInfo')
    tree.links.new(info.outputs['Color'], next(n for n in tree.nodes if n.type == 'BSDF_DIFFUSE').inputs['Color'])
    for x, colour in (1.2, (0.8, 0.6, 0.1, 1)), (2.2, (0.1, 0.6, 0.6, 1)):
        sphere(own, (x, 0, 0.4), 0.4).color = colour

    carrier = bpy.data.objects.new("carrier", bpy.data.meshes.new("carrier"))
    carrier.data.from_pydata([(-2.5, 1, 0.2), (-1.5, 1, 0.2), (-0.5, 1, 0.2)], [(0, 1), (1, 2)], [])
    scene.collection.objects.link(carrier)
    carrier.instance_type = 'VERTS'
    bpy.ops.mesh.primitive_cube_add(size=0.4)
    dress(matte("copies", (0.6, 0.3, 0.6, 1))).parent = carrier

    bpy.ops.object.text_add(location=(0.5, -2, 0.1), rotation=(1.2, 0, 0))
    bpy.context.object.data.body, bpy.context.object.data.extrude = "lull", 0.1
    bpy.context.object.data.materials.append(matte("ink", (0.05, 0.05, 0.05, 1)))

    stretched = bpy.data.objects.new("stretched", None)
    stretched.scale = (2, 1, 1)
    scene.collection.objects.link(stretched)
    bpy.ops.mesh.primitive_cube_add(size=0.6, location=(1, 1.5, 0.3), rotation=(0, 0, 0.7))
    dress(matte("sheared", (0.6, 0.6, 0.2, 1))).parent = stretched
    camera((4, -5, 3), (1.1, 0, 0.68))


def skin(folder):
    """A bone bends a bar in the frames 1 to 11; the world is a plain colour, the floor has no
    material, and what is in an excluded collection is not there."""
    scene = bpy.context.scene
    floor(None)
    sphere(matte("unseen"), (2, -2, 2), 1)
    unseen = bpy.data.collections.new("unseen")
    scene.collection.children.link(unseen)
    unseen.objects.link(bpy.context.object)
    scene.collection.objects.unlink(bpy.context.object)
    scene.view_layers[0].layer_collection.children["unseen"].exclude = True
    bpy.ops.mesh.primitive_cylinder_add(radius=0.4, depth=3, location=(0, 0, 1.5))
    bar = dress(matte("bar", (0.2, 0.4, 0.7, 1)))
    bpy.ops.object.mode_set(mode='EDIT')
    bpy.ops.mesh.select_all(action='SELECT')
    bpy.ops.mesh.subdivide(number_cuts=8)
    bpy.ops.object.mode_set(mode='OBJECT')
    bpy.ops.object.armature_add()
    rig = bpy.context.object
    bpy.ops.object.mode_set(mode='EDIT')
    bones = rig.data.edit_bones
    bones[0].head, bones[0].tail = (0, 0, 0), (0, 0, 1.5)
    upper = bones.new("upper")
    upper.head, upper.tail, upper.parent = (0, 0, 1.5), (0, 0, 3), bones[0]
    bpy.ops.object.mode_set(mode='OBJECT')
    for number, name in enumerate((rig.data.bones[0].name, "upper")):
        group = bar.vertex_groups.new(name=name)
        group.add([v.index for v in bar.data.vertices if (v.co.z > 0) == number], 1, 'REPLACE')
    modifier = bar.modifiers.new("skin", 'ARMATURE')
    modifier.object = rig
    bone = rig.pose.bones["upper"]
    bone.rotation_mode = 'XYZ'
    for frame, angle in (1, 0), (11, 1.2):
        bone.rotation_euler = (angle, 0, 0)
        bone.keyframe_insert("rotation_euler", frame=frame)
    scene.frame_end = 11
    scene.world = bpy.data.worlds.new("plain")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs['Color'].default_value = (0.5, 0.6, 0.8, 1)
    lamp('SUN', 2, (0, 0, 5), (0.5, 0.5, 0), angle=0)
    camera((5, -5, 3), (1.2, 0, math.pi / 4))


def passes(folder):
    """What view layers ask for: mist, positions, indices, mattes, and the light of two groups and of the world."""
    scene = bpy.context.scene
    layer = scene.view_layers[0]
    floor(matte()).name = "floor"
    sphere(matte("red", (0.7, 0.1, 0.1, 1)), (-1, 0, 0.7)).name = "ball"
    bpy.ops.mesh.primitive_cube_add(size=1, location=(1, 0, 0.5))
    dress(matte("blue", (0.1, 0.1, 0.7, 1))).pass_index = 3
    bpy.data.materials["red"].pass_index = 5
    bpy.ops.mesh.primitive_plane_add(size=1, location=(2.5, 0, 3), rotation=(math.pi, 0, 0))
    dress(material("glowing", 'Emission', Strength=5)).lightgroup = "warm"
    lamp('POINT', 100, (-3, -2, 3), shadow_soft_size=0.2).lightgroup = "warm"
    lamp('AREA', 100, (0, -1, 4), (0.2, 0, 0), size=1).lightgroup = "cold"
    world = scene.world = bpy.data.worlds.new("grey")
    world.use_nodes, world.lightgroup = True, "sky"
    world.mist_settings.start, world.mist_settings.depth = 2, 10
    for name in "warm", "cold", "sky", "none":
        layer.lightgroups.add().name = name
    for name in "mist", "position", "object_index", "material_index", "cryptomatte_object", "cryptomatte_material", "uv":
        setattr(layer, "use_pass_" + name, True)
    camera((0, -7, 3.2), (1.2, 0, 0), lens=35)


def fur(folder):
    """Hair, displacement, leaves that light comes through, a wall before the camera's clip start, and a world whose backdrop is
    another than its light."""
    scene = bpy.context.scene
    lamp('AREA', 300, (1, 3, 4), (-0.6, 0, 0), size=2)
    ground = floor(matte("ground", (0.2, 0.4, 0.1, 1)))
    ground.modifiers.new("hair", 'PARTICLE_SYSTEM')
    settings = ground.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length, settings.root_radius = 'HAIR', 500, 0.4, 4

    waved = matte("waved")
    tree = waved.node_tree
    wave, move = tree.nodes.new('ShaderNodeTexWave'), tree.nodes.new('ShaderNodeDisplacement')
    wave.inputs['Scale'].default_value, move.inputs['Scale'].default_value = 1, 0.2
    tree.links.new(wave.outputs['Fac'], move.inputs['Height'])
    tree.links.new(move.outputs[0], tree.get_output_node('CYCLES').inputs['Displacement'])
    displace(waved, 'DISPLACEMENT')
    sphere(waved, (-1.3, 0, 0.8))

    leaf = material("leaf", 'BsdfDiffuse', Color=(0.2, 0.5, 0.1, 1))
    tree = leaf.node_tree
    front = next(n for n in tree.nodes if n.type == 'BSDF_DIFFUSE')
    behind, mix = tree.nodes.new('ShaderNodeBsdfTranslucent'), tree.nodes.new('ShaderNodeMixShader')
    behind.inputs['Color'].default_value, mix.inputs[0].default_value = (0.6, 0.8, 0.1, 1), 0.7
    tree.links.new(front.outputs[0], mix.inputs[1]), tree.links.new(behind.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.get_output_node('CYCLES').inputs['Surface'])
    bpy.ops.mesh.primitive_plane_add(size=1.5, location=(1.3, 0, 1), rotation=(math.pi / 2, 0, 0))
    dress(leaf)

    bpy.ops.mesh.primitive_plane_add(size=4, location=(0, -6, 2), rotation=(math.pi / 2, 0, 0))
    dress(matte("outside"))
    world = scene.world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    tree = world.node_tree
    shown, rays, mix = (tree.nodes.new('ShaderNode' + kind) for kind in ('Background', 'LightPath', 'MixShader'))
    shown.inputs['Color'].default_value = (0.2, 0.4, 1, 1)
    for a, b in ((rays.outputs['Is Camera Ray'], mix.inputs[0]), (tree.nodes["Background"].outputs[0], mix.inputs[1]),
                 (shown.outputs[0], mix.inputs[2]), (mix.outputs[0], tree.get_output_node('CYCLES').inputs['Surface'])):
        tree.links.new(a, b)
    camera((0, -7, 2), (1.35, 0, 0), lens=35, clip_start=2)


def stored(folder, name, rows, colours='sRGB'):
    """Returns a PNG of rows of encoded pixels, the lowest first."""
    image = bpy.data.images.new(name, len(rows[0]), len(rows), alpha=len(rows[0][0]) == 4)
    image.colorspace_settings.name = colours
    image.pixels = [v for row in rows for pixel in row for v in (*pixel, 1)[:4]]
    image.filepath_raw, image.file_format = os.path.join(folder, name + ".png"), 'PNG'
    image.save()
    return image


def card(x, made):
    """Adds an upright rectangle with UVs. Returns its mesh."""
    mesh = bpy.data.meshes.new("card")
    mesh.from_pydata([(x - 0.45, 0, 0), (x + 0.45, 0, 0), (x + 0.45, 0, 2), (x - 0.45, 0, 2)], [], [(0, 1, 2, 3)])
    for loop, uv in zip(mesh.uv_layers.new(name="UVMap").data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        loop.uv = uv
    mesh.materials.append(made)
    bpy.context.collection.objects.link(bpy.data.objects.new("card", mesh))
    return mesh


def linked(name, *kinds):
    """Returns a matte material whose colour comes through nodes in a row, each linked by the output that is named after its kind,
    and its nodes."""
    made = matte(name)
    tree, socket, found = made.node_tree, made.node_tree.nodes[1].inputs['Color'], []
    for kind, output in reversed(kinds):
        found.insert(0, tree.nodes.new('ShaderNode' + kind))
        tree.links.new(found[0].outputs[output], socket)
        socket = next(iter(found[0].inputs), None)
    return made, found


def sides(folder):
    """Upright rectangles: colours of corners; a channel of an image; an image moved by two Mapping nodes, the second one muted, the
    third one not; one over a UV map that is lacking; a property of the object; other surfaces on both sides. A tapered cube with
    Generated coordinates."""
    floor(matte())
    lamp('SUN', 2, (0, 0, 5), (0.9, 0.2, 0), angle=0)
    steps = stored(folder, "steps", [[(0.1 + 0.1 * x, 0.1 * y, 0.3) for x in range(8)] for y in range(8)])
    corners = card(-3, linked("corners", ('VertexColor', 'Color'))[0]).color_attributes.new("mask", 'BYTE_COLOR', 'CORNER')
    for one, colour in zip(corners.data, ((0.8, 0.1, 0.1, 1), (0.1, 0.8, 0.1, 1), (0.1, 0.1, 0.8, 1), (0.8, 0.8, 0.1, 1))):
        one.color = colour
    made, (shown, _) = linked("channel", ('TexImage', 'Color'), ('SeparateColor', 'Red'))
    shown.image = steps
    card(-2, made)
    made, (_, turned, muted, moved, shown) = linked("moved", ('TexCoord', 'UV'), *[('Mapping', 'Vector')] * 3, ('TexImage', 'Color'))
    shown.image, muted.mute = steps, True
    turned.inputs['Rotation'].default_value, moved.inputs['Scale'].default_value = (0, 0, 0.5), (0.5, 1, 1)
    muted.inputs['Scale'].default_value = (9, 9, 9)
    card(-1, made)
    made, (named, shown) = linked("lacking", ('UVMap', 'UV'), ('TexImage', 'Color'))
    named.uv_map = "nowhere"
    shown.image = stored(folder, "framed", [[(0.7, 0.2, 0.1) if {x, y} & {0, 3} else (0.1, 0.2, 0.7) for x in range(4)] for y in range(4)])
    card(0, made)
    made, (attribute,) = linked("property", ('Attribute', 'Color'))
    attribute.attribute_type, attribute.attribute_name = 'OBJECT', "paint"
    card(1, made)
    bpy.context.collection.objects[-1]["paint"] = [0.2, 0.5, 0.7]
    for x, turn in (2, 0), (3, math.pi):
        made = matte("front", (0.7, 0.2, 0.1, 1))
        tree = made.node_tree
        front, (mix, back, where) = tree.nodes[1], [tree.nodes.new('ShaderNode' + kind) for kind in ('MixShader', 'BsdfDiffuse', 'NewGeometry')]
        back.inputs['Color'].default_value = (0.1, 0.6, 0.2, 1)
        for a, b in ((where.outputs['Backfacing'], mix.inputs[0]), (front.outputs[0], mix.inputs[1]), (back.outputs[0], mix.inputs[2]),
                     (mix.outputs[0], tree.get_output_node('CYCLES').inputs['Surface'])):
            tree.links.new(a, b)
        card(0, made)
        o = bpy.context.collection.objects[-1]
        o.location.x, o.rotation_euler.z = x, turn
    bpy.ops.mesh.primitive_cube_add(size=0.7, location=(0, -2, 0.35))
    taper = dress(linked("generated", ('TexNoise', 'Color'))[0]).modifiers.new("taper", 'SIMPLE_DEFORM')
    taper.deform_method, taper.factor, taper.deform_axis = 'TAPER', 1.5, 'Z'
    world = bpy.context.scene.world = bpy.data.worlds.new("grey")
    world.use_nodes = True
    camera((0, -7, 2.2), (1.4, 0, 0), lens=32)


def cards(folder):
    """Upright rectangles: an image of few pixels that differ much; one with an alpha that no node asks for; its alpha on a plain
    colour; an image with a mapping in its own node; colours of vertices that are not the first; light added to a
    transparent surface; nothing on the surface."""
    floor(matte())
    lamp('SUN', 2, (0, 0, 5), (0.9, 0.2, 0), angle=0)
    contrast = stored(folder, "contrast", [[((x + y) % 2 * 0.9,) * 3 for x in range(4)] for y in range(4)])
    veiled = stored(folder, "veiled", [[(0.9, 0.2, 0.1, x // 4) for x in range(8)] for _ in range(8)])

    def fed(kind, image=None, made=None, socket='Color', output=0):
        made = made or matte("card")
        source = made.node_tree.nodes.new('ShaderNode' + kind)
        if image:
            source.image = image
        made.node_tree.links.new(source.outputs[output], made.node_tree.nodes[1].inputs[socket])
        return made, source

    card(-3, fed('TexImage', contrast)[0])
    card(-2, fed('TexImage', veiled)[0])
    card(-1, fed('TexImage', veiled, material("cut", 'BsdfPrincipled'), 'Alpha', 1)[0])
    made, source = fed('TexImage', contrast)
    source.texture_mapping.scale = (0.4, 0.4, 1)
    card(0, made)
    colours = card(1, fed('VertexColor')[0]).color_attributes
    for name, colour in ("red", (0.8, 0.1, 0.1, 1)), ("green", (0.1, 0.8, 0.1, 1)):
        for one in colours.new(name, 'FLOAT_COLOR', 'POINT').data:
            one.color = colour
    colours.active_color_index, colours.render_color_index = 0, 1
    made = material("glow", 'Emission', Strength=0.5)
    tree = made.node_tree
    clear, add = (tree.nodes.new('ShaderNode' + kind) for kind in ('BsdfTransparent', 'AddShader'))
    for a, b in ((tree.nodes[1].outputs[0], add.inputs[0]), (clear.outputs[0], add.inputs[1]),
                 (add.outputs[0], tree.get_output_node('CYCLES').inputs['Surface'])):
        tree.links.new(a, b)
    card(2, made)
    made = matte("nothing")
    made.node_tree.nodes.remove(made.node_tree.nodes[1])
    card(3, made)
    world = bpy.context.scene.world = bpy.data.worlds.new("grey")
    world.use_nodes = True
    camera((0, -7, 2.2), (1.4, 0, 0), lens=32)


def mixtures(folder):
    """Diffuse and Glossy, mixed and added; Generated coordinates on a sheared box; an image moved by a Mapping of the kind Texture."""
    floor(matte())
    lamp('AREA', 300, (1.5, -2, 5), (0.35, 0, 0.26), size=1)
    for x, kind in (-2, 'MixShader'), (-0.5, 'AddShader'):
        made = matte("both", (0.1, 0.3, 0.6, 1))
        tree = made.node_tree
        both, shine = tree.nodes.new('ShaderNode' + kind), tree.nodes.new('ShaderNodeBsdfGlossy')
        shine.inputs['Color'].default_value, shine.inputs['Roughness'].default_value = (0.5, 0.4, 0.3, 1), 0.3
        for a, b in zip((tree.nodes[1].outputs[0], shine.outputs[0]), (i for i in both.inputs if i.type == 'SHADER')):
            tree.links.new(a, b)
        tree.links.new(both.outputs[0], tree.get_output_node('CYCLES').inputs['Surface'])
        sphere(made, (x, 0, 0.7))

    made = matte("generated")
    place = made.node_tree.nodes.new('ShaderNodeTexCoord')
    made.node_tree.links.new(place.outputs['Generated'], made.node_tree.nodes[1].inputs['Color'])
    wide = bpy.data.objects.new("wide", None)
    wide.scale = (2, 1, 1)
    bpy.context.collection.objects.link(wide)
    bpy.ops.mesh.primitive_cube_add(size=0.8, location=(0.5, 0, 0.4), rotation=(0, 0, 0.7))
    dress(made).parent = wide

    made = matte("moved")
    tree = made.node_tree
    place, turn, shown = (tree.nodes.new('ShaderNode' + kind) for kind in ('TexCoord', 'Mapping', 'TexImage'))
    shown.image = stored(folder, "steps", [[(0.1 + 0.2 * x, 0.2 * y, 0.3) for x in range(4)] for y in range(4)])
    turn.vector_type = 'TEXTURE'
    turn.inputs['Rotation'].default_value, turn.inputs['Scale'].default_value = (0, 0, 0.6), (1.5, 0.4, 1)
    for a, b in ((place.outputs['UV'], turn.inputs[0]), (turn.outputs[0], shown.inputs[0]), (shown.outputs[0], tree.nodes[1].inputs['Color'])):
        tree.links.new(a, b)
    bpy.ops.mesh.primitive_plane_add(size=1.6, location=(2.5, 0.5, 0.8), rotation=(math.pi / 2, 0, 0))
    dress(made)
    world = bpy.context.scene.world = bpy.data.worlds.new("grey")
    world.use_nodes = True
    camera((0, -7, 2.2), (1.4, 0, 0), lens=32)


def doubtful(folder):
    """What differs, with a warning: a material each, lamps and copies."""
    scene = bpy.context.scene

    def shader(made, kind, **inputs):
        node = new_node(made.node_tree, 'ShaderNode' + kind)
        for key, value in inputs.items():
            set_input(node, key, value)
        return node

    def mixed(name, first, second, kind=None, output=0):
        made = material(name, first)
        tree = made.node_tree
        front, mix = tree.nodes[-1], shader(made, 'MixShader')
        tree.links.new(front.outputs[0], mix.inputs[1])
        if second:
            tree.links.new(shader(made, second).outputs[0], mix.inputs[2])
        if kind:
            tree.links.new(shader(made, kind).outputs[output], mix.inputs[0])
        tree.links.new(mix.outputs[0], tree.get_output_node('CYCLES').inputs['Surface'])
        return made, front

    def fed(name, name_of_input, kind, output=0, **inputs):
        made = material(name, 'BsdfPrincipled')
        made.node_tree.links.new(shader(made, kind, **inputs).outputs[output],
                                 socket(made.node_tree.nodes["Principled BSDF"], name_of_input))
        return made

    bumped, front = mixed("bumped", 'BsdfDiffuse', 'BsdfGlossy')
    bumped.node_tree.links.new(shader(bumped, 'Bump').outputs[0], front.inputs['Normal'])
    moved = matte("moved")
    moved.node_tree.links.new(shader(moved, 'Displacement').outputs[0], moved.node_tree.get_output_node('CYCLES').inputs['Displacement'])
    displace(moved, 'BOTH')
    veiled, _ = mixed("veiled", 'BsdfDiffuse', 'BsdfTransparent')
    shadow_transparently(veiled, False)
    coated = fed("coated", 'Clearcoat Normal', 'Bump')
    set_input(coated.node_tree.nodes["Principled BSDF"], 'Clearcoat', 1)
    shown = [mixed("by rays", 'BsdfDiffuse', 'BsdfTransparent', 'LightPath', 'Is Glossy Ray')[0], bumped, moved, veiled, coated,
             mixed("half known", 'BsdfDiffuse', 'BsdfHairPrincipled')[0], fed("patchy", 'Transmission', 'TexChecker'),
             fed("shaded", 'Base Color', 'AmbientOcclusion'), material("brushed", 'BsdfAnisotropic', Anisotropy=0.5), fed("haired", 'Roughness', 'HairInfo', 'Length'),
             material("rough", 'BsdfDiffuse', Roughness=0.5)]
    for i, made in enumerate(shown):
        sphere(made, (i - 4, 0, 0.4), 0.4)
    floor(fed("fine", 'Base Color', 'TexNoise', 1, Scale=500)).scale = (10, 10, 1)
    facing, _ = mixed("facing", 'BsdfDiffuse', 'BsdfGlossy', 'LayerWeight', 1)
    sphere(facing, (2, 2, 0.4), 0.4)
    leaning = fed("leaning", 'Normal', 'NormalMap')
    tree = leaning.node_tree
    leant = shader(leaning, 'TexImage')
    leant.image = stored(folder, "leant", [[(0.8, 0.5, 0.9)] * 4] * 4, 'Non-Color')
    tree.links.new(leant.outputs[0], next(n for n in tree.nodes if n.type == 'NORMAL_MAP').inputs['Color'])
    offset_shadow(sphere(leaning, (1, 2, 0.4), 0.4), 0.5)
    bpy.context.object.name = "soft"
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(3, 3, 0.5))
    dress(matte("plain"), smooth=True).name = "round"
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(-3, 3, 0.5))
    dress(material("unknown", 'Holdout'))

    parts = bpy.data.collections.new("parts")
    bpy.ops.mesh.primitive_cube_add(size=0.3)
    parts.objects.link(dress(fed("random", 'Roughness', 'ObjectInfo', 'Random')))
    scene.collection.objects.unlink(bpy.context.object)
    for x in -1, 1:
        copy = bpy.data.objects.new("copy", None)
        copy.location, copy.instance_type, copy.instance_collection = (x, -1, 0.3), 'COLLECTION', parts
        scene.collection.objects.link(copy)

    for i in range(17):
        name = scene.view_layers[0].lightgroups.add().name = f"group {i}"
        lamp('POINT', 10, (i - 8, 0, 3)).lightgroup = name
    lamp('POINT', -10, (0, 0, 4)).name = "dark"
    edge = lamp('AREA', 10, (-5, 0, 1.5), (0, -math.pi / 4, 0), size=5)
    edge.name, edge.visible_camera = "edge", False
    askew = lamp('AREA', 10, (0, 0, 1.5), (0.5, 0, 0.5))
    askew.name, askew.parent = "askew", bpy.data.objects.new("wide", None)
    askew.parent.scale.x = 2
    scene.collection.objects.link(askew.parent)
    scene.render.film_transparent = scene.cycles.film_transparent_glass = True
    scene.render.use_simplify = scene.cycles.use_camera_cull = edge.cycles.use_camera_cull = True
    scene.view_layers[0].pass_cryptomatte_depth, scene.view_layers[0].use_pass_cryptomatte_object = 8, True
    scene.cycles.use_fast_gi, scene.view_settings.view_transform, scene.view_settings.look = True, 'Filmic', 'High Contrast'
    camera((0, -7, 3.2), (1.2, 0, 0), lens=35)


def factory(folder):
    """Blender's own scene."""
    bpy.ops.wm.read_factory_settings()


def main():
    o = json.loads(sys.argv[-1])
    for name in o["names"]:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        globals()[name](o["folder"])
        scene = bpy.context.scene
        r, c = scene.render, scene.cycles
        r.resolution_x, r.resolution_y = o["size"]
        c.sample_clamp_indirect = c.light_sampling_threshold = c.blur_glossy = 0
        c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = 12
        c.pixel_filter_type, c.filter_width = 'BOX', 1
        path = os.path.join(o["folder"], name)
        bpy.ops.wm.save_as_mainfile(filepath=path + ".blend", check_existing=False)
        if not o["spp"]:
            continue
        r.engine = 'CYCLES'
        r.image_settings.file_format, r.image_settings.color_depth = 'OPEN_EXR_MULTILAYER', '32'
        r.image_settings.exr_codec = 'ZIP'
        c.samples, c.use_denoising, c.use_adaptive_sampling = o["spp"], False, False
        for used in scene.view_layers:
            used.use_pass_z = used.use_pass_normal = True
        scene.frame_set(o.get("frame", 1))
        r.filepath = path + ".cycles.exr"
        bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
