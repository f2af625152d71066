"""Converts lights to those of glTF and lull."""
import math

import bpy
from bpy_extras.object_utils import world_to_camera_view


def prepare(scene, warn):
    """Gives point lights a radius, suns an angle, and makes meshes of area lights: glTF lacks these."""
    graph = bpy.context.evaluated_depsgraph_get()
    lamps = [(i.object.original, i.matrix_world.copy()) for i in graph.object_instances
             if i.object.type == 'LIGHT' and not i.object.original.hide_render
             and not _is_portal(i.object.original.data)]
    for light in {o.data for o, _ in lamps}:
        if light.use_nodes:
            _fold_nodes(light, warn)
        if light.type == 'POINT' and light.shadow_soft_size > 0:
            light["lull"] = {"radius": light.shadow_soft_size}
        if light.type == 'SUN' and light.angle > 0:
            light["lull"] = {"angle": light.angle}
        if light.type == 'SPOT':
            light.spot_blend = _blend_of(light)
        light.use_nodes = False  # would be taken for all of its strength
    for o, matrix in lamps:
        light = o.data
        if light.type == 'SPOT' and light.shadow_soft_size > 0:
            warn(f"spot light '{o.name}' has no radius: its shadows are sharp")
        elif not o.visible_camera and _is_in_view(scene, matrix.translation):
            if light.type == 'AREA' or "lull" in light:
                warn(f"light '{o.name}' is seen by the camera")
        if light.type == 'AREA':
            _add_area(scene, o, matrix, warn)


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


def _fold_nodes(light, warn):
    """Applies strength and colour of simple nodes to the light."""
    output = next((n for n in light.node_tree.nodes if n.type == 'OUTPUT_LIGHT'), None)
    links = output.inputs['Surface'].links if output else ()
    emission = links[0].from_node if links else None
    if emission is None or emission.type != 'EMISSION' or any(i.links for i in emission.inputs):
        warn(f"light '{light.name}' shines without its nodes")
        return
    light.energy *= emission.inputs['Strength'].default_value
    light.color = [a * b for a, b in zip(light.color, emission.inputs['Color'].default_value)]


def _is_in_view(scene, point):
    x, y, depth = world_to_camera_view(scene, scene.camera, point)
    return depth > 0 and 0 < x < 1 and 0 < y < 1


def _add_area(scene, o, matrix, warn):
    """Adds a mesh that emits downwards, like the light."""
    light = o.data
    if light.spread < math.pi - 1e-4:
        warn(f"area light '{o.name}' shines to all sides: its spread is left out")
    width = light.size
    height = light.size_y if light.shape in ('RECTANGLE', 'ELLIPSE') else width
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
    made = bpy.data.objects.new(o.name, mesh)
    made.matrix_world = matrix
    scene.collection.objects.link(made)


def _shining(name, color, radiance):
    """Returns a black material that emits on its front."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.use_backface_culling = True
    nodes = material.node_tree.nodes
    principled = next(n for n in nodes if n.type == 'BSDF_PRINCIPLED')
    principled.inputs['Base Color'].default_value = (0, 0, 0, 1)
    for specular in 'Specular', 'Specular IOR Level':  # until and from Blender 4
        if specular in principled.inputs:
            principled.inputs[specular].default_value = 0
    emission = 'Emission' if 'Emission' in principled.inputs else 'Emission Color'
    # The exporter writes colours up to 1, and a strength.
    largest = max(*color, 1e-9)
    principled.inputs[emission].default_value = [c / largest for c in color] + [1]
    principled.inputs['Emission Strength'].default_value = radiance * largest
    return material
