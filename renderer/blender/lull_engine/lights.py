"""Converts lights to those of glTF and lull."""
import math
import os

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

import flatten
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


def add(lamps, scene, flat, base, notes):
    """Adds lights to a scene, point and spot lights with a radius, suns with an angle, and meshes for area lights, which glTF
    lacks. `base` begins the names of files beside that of the scene."""
    folded = {}
    for o, matrix in lamps:
        if not flatten.is_seen(o, flatten.SEEING_RAYS):
            continue
        light = folded.get(o.data)
        if light is None:
            light = folded[o.data] = _folded(o.data.copy(), "%s-profile%d.exr" % (base, len(folded)), notes)
        if min(light.energy * c for c in light.color) < 0:
            notes.add("left out, taking light away", o.name, "lights")
            continue
        if not o.visible_camera and any(_is_in_view(scene, p) for p in _points(scene, light, matrix)):
            if light.type == 'AREA' or "lull" in light and "profile" not in light["lull"]:
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
    flat.collection.objects.link(made)


def _folded(light, profile, notes):
    if light.use_nodes:
        _fold_nodes(light, profile, notes)
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


def _fold_nodes(light, profile, notes):
    """Applies strength and colour of simple nodes to the light."""
    output = next((n for n in light.node_tree.nodes if n.type == 'OUTPUT_LIGHT'), None)
    links = output.inputs['Surface'].links if output else ()
    emission = links[0].from_node if links else None
    if emission is None or emission.type != 'EMISSION':
        notes.add("shining without nodes", light.name, "lights")
        return
    strength, colour = emission.inputs['Strength'], emission.inputs['Color']
    source = colour.links[0].from_node if colour.links else None
    if source is not None and source.type == 'BLACKBODY' and not source.inputs[0].links:
        shown = _blackbody(source.inputs[0].default_value)
    elif source is not None and source.type == 'RGB':
        shown = source.outputs[0].default_value
    else:
        shown = colour.default_value
        if source is not None:
            notes.add("shining in the plain colour, without nodes", light.name, "lights")
    if strength.links and strength.links[0].from_node.type == 'VALUE':
        light.energy *= strength.links[0].from_socket.default_value
    elif strength.links and strength.links[0].from_node.type == 'LIGHT_FALLOFF':
        _fold_falloff(light, strength.links[0].from_socket, notes)
    elif strength.links and _fold_profile(light, strength.links[0].from_node, profile):
        if light.shadow_soft_size > 0:
            notes.add("casting hard shadows, having an IES profile", light.name, "lights")
    elif strength.links:
        notes.add("shining evenly, without an IES profile or other nodes", light.name, "lights")
    else:
        light.energy *= strength.default_value
    light.color = [a * b for a, b in zip(light.color, shown)]


def _fold_falloff(light, output, notes):
    inputs = output.node.inputs
    light.energy *= inputs['Strength'].default_value
    if output.name != 'Quadratic' or inputs['Smooth'].links or inputs['Smooth'].default_value > 0:
        notes.add("dimming with the square of the distance, whatever its falloff", light.name, "lights")
    if inputs['Strength'].links:
        notes.add("shining evenly, without an IES profile or other nodes", light.name, "lights")


def _fold_profile(light, node, path):
    """Gives a point light the profile of an IES node; returns whether it can have one."""
    if light.type != 'POINT' or node.type != 'TEX_IES' or node.inputs['Vector'].links or node.inputs['Strength'].links:
        return False
    try:
        strengths = ies.strengths(ies.text_of(node))
    except ies.Unreadable:
        return False
    ies.paint(strengths * node.inputs['Strength'].default_value, path)
    light["lull"] = {"profile": os.path.basename(path)}
    return True


def _blackbody(kelvin):
    """Returns the R, G, B of a luminance of 1 of a black body: its spectrum in 10 nm, by the fit of Wyman et al. (2013) to the
    functions of the CIE."""
    def lobe(x, mean, below, above):
        return math.exp(-0.5 * ((x - mean) / (below if x < mean else above)) ** 2)

    total = [0, 0, 0]
    for nm in range(380, 781, 10):
        radiance = (nm / 560) ** -5 / (math.exp(14387768.8 / (nm * kelvin)) - 1)
        total[0] += radiance * (1.056 * lobe(nm, 599.8, 37.9, 31) + 0.362 * lobe(nm, 442, 16, 26.7)
                                - 0.065 * lobe(nm, 501.1, 20.4, 26.2))
        total[1] += radiance * (0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1))
        total[2] += radiance * (1.217 * lobe(nm, 437, 11.8, 36) + 0.681 * lobe(nm, 459, 26, 13.8))
    x, y, z = (t / total[1] for t in total)
    return [max(0, v) for v in (3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
                                0.0557 * x - 0.2040 * y + 1.0570 * z)]


def _points(scene, light, matrix):
    """Yields points of a light that the camera might see."""
    steps, eye = [(x / 4, y / 4) for x in range(-4, 5) for y in range(-4, 5)], scene.camera.matrix_world
    if light.type == 'AREA':
        away = eye.col[2].xyz if scene.camera.data.type == 'ORTHO' else eye.translation - matrix.translation
        if away.dot(matrix.col[2].xyz) >= 0:  # where it is not there
            return
        width, height = _size(light)
        yield from (matrix @ Vector((x * width / 2, y * height / 2, 0)) for x, y in steps)
    elif light.type == 'SUN':
        axes, wide = matrix.to_3x3().normalized(), math.tan(min(light.angle, 3) / 2)
        yield from (eye.translation + 1e4 * (axes @ Vector((wide * x, wide * y, 1))) for x, y in steps if x * x + y * y <= 1)
    else:
        across, radius = eye.to_3x3().normalized(), light.shadow_soft_size
        yield from (matrix.translation + radius * (across @ Vector((x, y, 0))) for x, y in steps if x * x + y * y <= 1)


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
