"""Converts lights to those of glTF and lull."""
import math
import os

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

import flatten
import groups
import ies
import surfaces
from versions import principled_input


def find(scene, wanted):
    """Returns the lights of the objects `wanted` and where they are, instances too."""
    graph = bpy.context.evaluated_depsgraph_get()
    return [(i.object.original, i.matrix_world.copy()) for i in graph.object_instances
            if i.object.type == 'LIGHT' and not _is_portal(i.object.original.data)
            and (i.is_instance or flatten.shows_itself(i, ()))
            and (i.parent.original if i.is_instance else i.object.original) in wanted]


def add(lamps, scene, flat, base, baker, notes):
    """Adds lights to a scene, point and spot lights with a radius, suns with an angle, and meshes for area lights, which glTF
    lacks. `base` begins the names of files beside that of the scene."""
    folded = {}
    for o, matrix in lamps:
        if not flatten.is_seen(o, flatten.SEEING_RAYS):
            continue
        light = folded.get(o.data)
        if light is None:
            light = folded[o.data] = _folded(o.data.copy(), baker, "%s-profile%d.exr" % (base, len(folded)), notes)
        if light.energy * max(light.color) == 0:
            continue
        if light.energy < 0:
            notes.add("left out, taking light away", o.name, "lights")
            continue
        if light.type == 'SUN' and not o.visible_camera and any(_is_in_view(scene, p) for p in _points(scene, light, matrix)):
            notes.add("seen by the camera", o.name, "lights")
        if not all(getattr(o, "visible_" + ray) for ray in ("diffuse", "glossy", "transmission")):
            notes.add("lighting all surfaces, whatever its visibility", o.name, "lights")
        if light.cycles.max_bounces < 12:
            notes.add("lighting after any number of bounces", o.name, "lights")
        if not light.use_shadow or not getattr(light.cycles, "cast_shadow", True):
            notes.add("casting shadows all the same", o.name, "lights")
        if light.type == 'AREA' and flatten.is_sheared(matrix):
            notes.add("shining in another direction, being sheared", o.name, "lights")
        if light.type == 'AREA':
            _add_area(flat, o, light, matrix)
        else:
            _place(flat, o, light, matrix)


def add_suns(suns, flat):
    """Adds the suns of the world, which belong to the light group of all infinite lights."""
    for light, matrix in suns:
        made = bpy.data.objects.new("environment", light)
        made.matrix_world = matrix
        made["lull_source"] = "environment"
        flat.collection.objects.link(made)


def _place(flat, o, data, matrix):
    made = bpy.data.objects.new(o.name, data)
    made.matrix_world = matrix
    made["lull_source"], made["lull_group"] = o.name, o.lightgroup
    if not o.visible_camera:
        made["lull_hidden"] = True
    flat.collection.objects.link(made)


def _folded(light, baker, profile, notes):
    if light.use_nodes:
        _fold_nodes(light, baker, profile, notes)
    if light.type in ('POINT', 'SPOT') and light.shadow_soft_size > 0 and "lull" not in light:
        light["lull"] = {"radius": light.shadow_soft_size}
    if light.type == 'SUN' and light.angle > 0:
        light["lull"] = {"angle": light.angle}
    if light.type == 'SPOT':
        if 1 / math.cos(min(light.spot_size / 2, 1.5)) > 1.1:  # Cycles dims by the cosine of the angle from the axis
            notes.add("brighter towards the edge of its cone", light.name, "lights")
        light.spot_blend = _blend_of(light)
    light.use_nodes = False  # would be taken for all of its strength
    return light


def _is_portal(light):
    """Returns whether a light only tells Cycles where the sky comes from."""
    return light.type == 'AREA' and getattr(getattr(light, "cycles", None), "is_portal", False)


def _blend_of(light):
    """Returns the fraction of a cone's angle over which glTF fades as much light as Cycles.

    glTF fades by the square of the cosine's distance from the edge, Cycles by a smooth step.
    """
    half = light.spot_size / 2
    edge = math.cos(half)
    way = max(light.spot_blend, 1e-3) * (1 - edge) * (1 - 1 / 2) / (1 - 1 / 3)
    return 1 - math.acos(min(1, edge + way)) / half


def _fold_nodes(light, baker, profile, notes):
    """Applies strength and colour of nodes to the light, where they are the same for all rays."""
    groups.inline(light.node_tree)
    output = light.node_tree.get_output_node('CYCLES')
    surface = surfaces.source_of(output.inputs['Surface']) if output else None
    if surface is None:
        light.energy = 0
        return
    if surface.node.type != 'EMISSION':
        notes.add("shining without nodes", light.name, "lights")
        return
    strength, colour = (surface.node.inputs[name] for name in ('Strength', 'Color'))
    _pass_falloff(light, notes)
    shown = _plain(colour, baker)
    if shown is None:
        notes.add("shining in the plain colour, without nodes", light.name, "lights")
        shown = colour.default_value[:3]
    factor = _plain(strength, baker)
    if factor is None:
        factor = _fold_profile(light, strength, baker, profile)
        if factor is None:
            notes.add("shining evenly, without an IES profile or other nodes", light.name, "lights")
            factor = (1,)
        elif light.shadow_soft_size > 0:
            notes.add("casting hard shadows, having an IES profile", light.name, "lights")
    # Colours of lights are not negative.
    light.energy *= factor[0] if min(shown) >= 0 else -abs(factor[0])
    light.color = [a * abs(b) for a, b in zip(light.color, shown)]


def _plain(socket, baker):
    """Returns an input's value, three numbers or one; None where it is not the same for all rays."""
    value = surfaces.value_of(socket)
    if isinstance(value, (int, float)):
        return (value,)
    if not isinstance(value, bpy.types.NodeSocket):
        return value
    if not surfaces.is_even(value):
        return None
    found = _baked(value, baker)
    return (surfaces.grey(*found),) if socket.type == 'VALUE' and value.type == 'RGBA' else found


def _baked(output, baker):
    material = bpy.data.materials.new('light')
    material.use_nodes = True
    copies = groups.copy_into(material.node_tree, surfaces.upstream(output))
    found = baker.plain(material, copies[output.node].outputs[list(output.node.outputs).index(output)])
    bpy.data.materials.remove(material)
    return tuple(float(v) for v in found)


def _pass_falloff(light, notes):
    """Lets the light dim with the square of the distance, as glTF's do."""
    tree = light.node_tree
    for node in [n for n in tree.nodes if n.type == 'LIGHT_FALLOFF']:
        smooth = node.inputs['Smooth']
        for output in node.outputs:
            if output.links and (output.name != 'Quadratic' or smooth.links or smooth.default_value > 0):
                notes.add("dimming with the square of the distance, whatever its falloff", light.name, "lights")
            groups.replace(tree, output, node.inputs['Strength'])


def _fold_profile(light, socket, baker, path):
    """Gives a point light the profile of an IES node on which its strength depends. Returns the factor of the profile, in a tuple; None
    if it can have none."""
    nodes = [n for n in surfaces.upstream(surfaces.source_of(socket)) if n.type == 'TEX_IES']
    if light.type != 'POINT' or len(nodes) != 1 or nodes[0].inputs['Vector'].links:
        return None
    node, = nodes
    try:
        profile = ies.strengths(ies.text_of(node))
    except ies.Unreadable:
        return None
    tree = light.node_tree
    times = tree.nodes.new('ShaderNodeMath')
    times.operation = 'MULTIPLY'
    groups.replace(tree, node.outputs[0], times.outputs[0])
    strength = surfaces.source_of(node.inputs['Strength'])
    if strength is None:
        times.inputs[1].default_value = node.inputs['Strength'].default_value
    else:
        tree.links.new(strength, times.inputs[1])
    found = []
    for value in 0, 1, 2:
        times.inputs[0].default_value = value
        found.append(_plain(socket, baker))
    if None in found or abs(found[0][0]) > 1e-4 * abs(found[1][0]) or abs(found[2][0] - 2 * found[1][0]) > 1e-3 * abs(found[1][0]):
        return None
    ies.paint(profile, path)
    light["lull"] = {"profile": os.path.basename(path)}
    return found[1]


def _points(scene, sun, matrix):
    """Yields points of a sun that the camera might see: none of one without an angle."""
    if sun.angle == 0:
        return
    steps, eye = [(x / 4, y / 4) for x in range(-4, 5) for y in range(-4, 5)], scene.camera.matrix_world
    axes, wide = matrix.to_3x3().normalized(), math.tan(min(sun.angle, 3) / 2)
    yield from (eye.translation + 1e4 * (axes @ Vector((wide * x, wide * y, 1))) for x, y in steps if x * x + y * y <= 1)


def _size(light):
    return light.size, light.size_y if light.shape in ('RECTANGLE', 'ELLIPSE') else light.size


def _is_in_view(scene, point):
    x, y, depth = world_to_camera_view(scene, scene.camera, point)
    return depth > 0 and 0 < x < 1 and 0 < y < 1


def _add_area(flat, o, light, matrix):
    """Adds a mesh that emits downwards, like the light."""
    width, height = _size(light)
    if light.shape in ('SQUARE', 'RECTANGLE'):
        corners, shrunk = [(-1, -1), (-1, 1), (1, 1), (1, -1)], 1
    else:
        count = 64
        angles = [-2 * math.pi * i / count for i in range(count)]
        corners = [(math.cos(a), math.sin(a)) for a in angles]
        # A polygon of the disk's area.
        shrunk = math.sqrt(math.pi / (count / 2 * math.sin(2 * math.pi / count)))
    points = [(x * shrunk * width / 2, y * shrunk * height / 2, 0) for x, y in corners]
    # Cycles measures the area in the world, whatever scales the light.
    scale = matrix.to_scale()
    area = width * height * abs(scale.x * scale.y)
    if light.shape in ('DISK', 'ELLIPSE'):
        area *= math.pi / 4
    if area == 0 or light.energy == 0:
        return
    mesh = bpy.data.meshes.new(o.name)
    mesh.from_pydata(points, [], [tuple(range(len(points)))])
    # Blender's watts: a Lambertian surface of this radiance emits pi / 4 of them.
    mesh.materials.append(_shining(o.name, light.color, light.energy / (4 * area)))
    mesh.materials[0]["lull_open"] = True
    if light.spread < math.pi - 1e-4:
        mesh.materials[0]["lull_spread"] = light.spread
    _place(flat, o, mesh, matrix)


def _shining(name, color, radiance):
    """Returns a black material that emits on its front."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.use_backface_culling = True
    principled = surfaces.principled(material)
    principled.inputs['Base Color'].default_value = (0, 0, 0, 1)
    principled_input(principled, 'Specular').default_value = 0
    # The exporter writes colours up to 1, and a strength.
    largest = max(*color, 1e-9)
    principled_input(principled, 'Emission').default_value = [c / largest for c in color] + [1]
    principled.inputs['Emission Strength'].default_value = radiance * largest
    return material
