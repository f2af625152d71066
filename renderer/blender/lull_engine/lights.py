"""Converts lights to lights of glTF and lull."""
import math
import os
from types import SimpleNamespace

import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Matrix, Vector

from . import exr, ies, materials, meshes, shown, values
from .nodes import Tree, computed, grey, is_output, upstream, value_of
from .versions import HAS_COLOURED_LAMPS, HAS_DIM_LAMPS

_LUMENS = 683  # per watt, by which glTF's units are divided
_COPIED = ("name", "type", "energy", "shadow_soft_size", "angle", "spot_size", "spot_blend", "spread", "shape", "size", "size_y")


class Lights:
    """The lights of a render (shown.Lamp)."""

    def __init__(self, lamps, scene, base, baker, notes):
        """`base` begins the names of files beside that of the scene."""
        self._lamps, self._scene, self._base, self._baker, self._notes = lamps, scene, base, baker, notes
        self._trees = {}  # kept, as the baker knows values by their outputs

    def read(self, notes):
        """Returns the lights that shine, with the properties in _COPIED, and their lamps. To be called again while the baker lacks
        something."""
        folded, found = {}, []
        for lamp in self._lamps:
            with notes.of(lamp.original.name, "lights"):
                self._read(lamp, folded, found, notes)
        return found

    def _read(self, lamp, folded, found, notes):
        o, data = lamp.original, lamp.data
        if not shown.is_seen(o, shown.SEEING_RAYS):
            return
        key = data.original.name_full
        if key not in folded:
            folded[key] = self._folded(data, "%s-profile%d.exr" % (self._base, len(folded)), notes)
        light = folded[key]
        if light.energy * max(light.color) == 0:
            return
        if light.energy < 0:
            notes.add("left out, taking light away", o.name, "lights")
            return
        scale = lamp.matrix.to_scale()
        notes.add_true({
            "seen by the camera": light.type == 'SUN' and not o.visible_camera and any(
                _is_in_view(self._scene, p) for p in _points(self._scene, light, lamp.matrix)),
            "lighting all surfaces, whatever its visibility": not all(shown.is_seen(o, (ray,)) for ray in shown.BOUNCES),
            "lighting after any number of bounces": data.cycles.max_bounces < 12,
            "casting shadows all the same": not data.use_shadow or not getattr(data.cycles, "cast_shadow", True),
            "shining in a round cone of its angle, whatever its scale": light.type == 'SPOT' and max(scale) > 1.01 * min(scale),
            "shining in another direction, being sheared": light.type == 'AREA' and shown.is_sheared(lamp.matrix),
        }, o.name, "lights")
        shown.note_linking(o, notes)
        found.append((light, lamp))

    def _folded(self, data, profile, notes):
        """Returns a light with the strength and colour of its nodes."""
        light = SimpleNamespace(**{n: getattr(data, n, None) for n in _COPIED}, color=list(data.color), own={})
        if data.use_nodes:
            self._fold_nodes(light, data, profile, notes)
        if light.type in ('POINT', 'SPOT') and light.shadow_soft_size > 0 and not light.own:
            light.own = {"radius": light.shadow_soft_size}
        if light.type == 'SUN' and light.angle > 0:
            light.own = {"angle": light.angle}
            if HAS_DIM_LAMPS:
                cosine = math.cos(light.angle / 2)
                light.energy *= 2 * cosine / (1 + cosine)
        if light.type == 'SPOT':
            if HAS_DIM_LAMPS and 1 / math.cos(min(light.spot_size / 2, 1.5)) > 1.1:  # Cycles dims by the cosine of the angle from the axis
                notes.add("brighter towards the edge of its cone", light.name, "lights")
            light.spot_blend = _blend_of(light)
        return light

    def _fold_nodes(self, light, data, profile, notes):
        """Applies strength and colour of nodes to the light, where they are the same for all rays."""
        def replaced(node, output):
            return _passing(node, output, light.name, self._notes)

        output = self._trees.setdefault(data.original.name_full, Tree(data, replaced)).output
        surface = output.inputs['Surface'].source if output is not None else None
        is_colour = surface is not None and surface.type != 'SHADER'
        if surface is None or is_colour and not HAS_COLOURED_LAMPS:
            if is_colour:
                notes.add("dark, as a colour is linked to its output", light.name, "lights")
            light.energy = 0
            return
        if not is_colour and surface.node.type != 'EMISSION':
            notes.add("shining without nodes", light.name, "lights")
            return
        color = self._plain(data, output.inputs['Surface'] if is_colour else surface.node.inputs['Color'])
        if color is None:
            notes.add("shining in the plain colour, without nodes", light.name, "lights")
            color = (1, 1, 1) if is_colour else surface.node.origin.inputs['Color'].default_value[:3]
        strength = None if is_colour else surface.node.inputs['Strength']
        factor = (1,) if is_colour else self._plain(data, strength)
        if factor is None:
            factor = self._profile(light, data, strength, profile)
            if factor is None:
                notes.add("shining evenly, without an IES profile or other nodes", light.name, "lights")
                factor = (1,)
            elif light.shadow_soft_size > 0:
                notes.add("casting hard shadows, having an IES profile", light.name, "lights")
        # Colours of lights are not negative.
        light.energy *= factor[0] if min(color) >= 0 else -abs(factor[0])
        light.color = [a * abs(b) for a, b in zip(light.color, color)]

    def _plain(self, data, socket):
        """Returns an input's value, three numbers or one; None where it is not the same for all rays."""
        value = value_of(socket)
        if not is_output(value):
            return value if isinstance(value, tuple) else (value,)
        if not values.is_even(value):
            return None
        found = tuple(float(v) for v in self._baker.plain(data, value))
        return (grey(*found),) if socket.type == 'VALUE' and value.type == 'RGBA' else found

    def _profile(self, light, data, socket, path):
        """Gives a point light the profile of an IES node on which its strength depends. Returns the factor of the profile, in a tuple;
        None if it can have none."""
        nodes = [n for n in upstream(socket.source) if n.type == 'TEX_IES']
        if light.type != 'POINT' or len(nodes) != 1 or nodes[0].inputs['Vector'].source is not None:
            return None
        try:
            profile = ies.strengths(ies.text_of(nodes[0]))
        except ies.Unreadable:
            return None
        found = []
        for value in 0., 1., 2.:
            def replaced(node, output, value=value):
                if node.type == 'TEX_IES':
                    strength = node.inputs['Strength']
                    return computed('MULTIPLY', strength.source or strength.default_value, value)
                return _passing(node, output, None, None)

            key = path, value
            tree = self._trees.setdefault(key, Tree(data, replaced))
            found.append(self._plain(data, tree.output.inputs['Surface'].source.node.inputs['Strength']))
        if self._baker.is_lacking:
            return (1,)
        if None in found or abs(found[0][0]) > 1e-4 * abs(found[1][0]) or abs(found[2][0] - 2 * found[1][0]) > 1e-3 * abs(found[1][0]):
            return None
        exr.write(path, dict.fromkeys("RGB", profile))
        light.own = {"profile": os.path.basename(path)}
        return found[1]


def _passing(node, output, name, notes):
    """Lets a light dim with the square of the distance, as glTF's do."""
    if node.type != 'LIGHT_FALLOFF':
        return None
    smooth, strength = node.inputs['Smooth'], node.inputs['Strength']
    if notes is not None and (output != 'Quadratic' or smooth.source is not None or smooth.default_value > 0):
        notes.add("dimming with the square of the distance, whatever its falloff", name, "lights")
    return strength.source or computed('ADD', strength.default_value, 0.)


def _blend_of(light):
    """Returns the fraction of a cone's angle over which glTF fades as much light as Cycles.

    glTF fades by the square of the cosine's distance from the edge, Cycles by a smooth step.
    """
    half = light.spot_size / 2
    edge = math.cos(half)
    way = max(light.spot_blend, 1e-3) * (1 - edge) * (1 - 1 / 2) / (1 - 1 / 3)
    return 1 - math.acos(min(1, edge + way)) / half


def _points(scene, sun, matrix):
    """Yields points of a sun that the camera might see: none of one without an angle."""
    if sun.angle == 0:
        return
    steps, eye = [(x / 4, y / 4) for x in range(-4, 5) for y in range(-4, 5)], scene.camera.matrix_world
    axes, wide = matrix.to_3x3().normalized(), math.tan(min(sun.angle, 3) / 2)
    yield from (eye.translation + 1e4 * (axes @ Vector((wide * x, wide * y, 1))) for x, y in steps if x * x + y * y <= 1)


def _is_in_view(scene, point):
    x, y, depth = world_to_camera_view(scene, scene.camera, point)
    return depth > 0 and 0 < x < 1 and 0 < y < 1


def punctual(light):
    """Returns a point light, a spot light or a sun for KHR_lights_punctual."""
    made = {"name": light.name, "type": {'POINT': "point", 'SPOT': "spot", 'SUN': "directional"}[light.type], "color": list(light.color),
            "intensity": light.energy * _LUMENS / (1 if light.type == 'SUN' else 4 * math.pi)}
    if light.type == 'SPOT':
        half = light.spot_size / 2
        made["spot"] = {"innerConeAngle": half * (1 - light.spot_blend), "outerConeAngle": half}
    if light.own:
        made["extras"] = {"lull": light.own}
    return made


def sun(said):
    """Returns a sun of the world, and its matrix; `said` is a result of world.write()."""
    light = SimpleNamespace(name="environment", type='SUN', energy=said["energy"], color=said["color"], own={"angle": said["angle"]})
    return light, Matrix(said["matrix"])


def area(light, matrix):
    """Returns a mesh that emits downwards, like an area light, and its material; None for one of no size."""
    width, height = light.size, light.size_y if light.shape in ('RECTANGLE', 'ELLIPSE') else light.size
    if light.shape in ('SQUARE', 'RECTANGLE'):
        corners, shrunk = [(-1, -1), (-1, 1), (1, 1), (1, -1)], 1
    else:
        count = 64
        angles = [-2 * math.pi * i / count for i in range(count)]
        corners = [(math.cos(a), math.sin(a)) for a in angles]
        # A polygon of the disk's area.
        shrunk = math.sqrt(math.pi / (count / 2 * math.sin(2 * math.pi / count)))
    points = np.array([(x * shrunk * width / 2, y * shrunk * height / 2, 0) for x, y in corners], np.float32)
    # Cycles measures the area in the world, whatever scales the light.
    scale = matrix.to_scale()
    size = width * height * abs(scale.x * scale.y) * (math.pi / 4 if light.shape in ('DISK', 'ELLIPSE') else 1)
    if size == 0:
        return None
    mesh = meshes.Mesh(light.name, points, np.arange(len(points), dtype=np.int32), np.zeros(1, np.int32))
    mesh.cut()
    # Of Blender 3's watts, a Lambertian surface emits pi / 4.
    radiance = [c * light.energy / ((4 if HAS_DIM_LAMPS else math.pi) * size) for c in light.color]
    return mesh, materials.shining(light.name, radiance, light.spread)
