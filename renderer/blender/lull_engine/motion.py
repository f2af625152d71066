"""Motion blur: where objects are when the shutter opens and closes, as the animation of a glTF file."""
import base64
import math
import struct

import bpy
import numpy as np
from mathutils import Matrix

import matrices

_STARTS = {'START': 0, 'CENTER': -0.5, 'END': -1}  # of the time that the shutter is open
_BENT = 0.2  # of the way, that the middle may be off a straight one
_Y_UP = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
_FLOAT = 5126


class Motion:
    """What moves while the shutter is open; nothing without motion blur. Leaves the scene at another frame."""

    def __init__(self, scene, frame, notes):
        self._moves, self.shutter = {}, 0
        r = scene.render
        if not r.use_motion_blur:
            return
        length = r.motion_blur_shutter
        first = frame + length * _STARTS[scene.cycles.motion_blur_position]
        start, middle, end = (_Moment(scene, at) for at in (first, first + length / 2, first + length))
        for key in start.places.keys() & middle.places.keys() & end.places.keys():
            self._compare(key, *(m.places[key] for m in (start, middle, end)), notes)
        for name, points in start.shapes.items():
            if not np.array_equal(points, end.shapes.get(name)):
                notes.add("sharp where its shape moves", name)
        if self._moves:
            self.shutter = length * r.fps_base / r.fps
        if self._moves and scene.cycles.rolling_shutter_type != 'NONE':
            notes.say("the shutter opens for all rows at once")
        if self._moves and any(p.location.y < 1 for p in r.motion_blur_shutter_curve.curves[0].points):
            notes.say("the shutter opens and closes at once, whatever its curve")

    def _compare(self, key, start, middle, end, notes):
        way = _apart(start, end)
        if way < 1e-6:
            return
        o = bpy.data.objects.get(key[0])
        if o and o.type == 'LIGHT':
            notes.add("still while the shutter is open", o.name, "lights")
        elif not o or o.cycles.use_motion_blur:
            self._moves[key] = start, end
            if _apart(middle, (start + end) * 0.5) > _BENT * way:
                notes.add("blurred along a straight line", key[0])

    def moves(self, o):
        """Returns whether an object that is no copy moves."""
        return (o.original.name_full, "", ()) in self._moves

    def mark(self, made, instance):
        """Leaves the places of an instance, or an object, to the file that has the object made of it."""
        start, end = self._moves.get(_key(instance), (None, None))
        if start is None or not instance.matrix_world.determinant():
            return
        away = instance.matrix_world.inverted() @ made.matrix_world
        made["lull_moves"] = matrices.packed(start @ away, end @ away)


class _Moment:
    """The places of objects and instances at a time in frames, and the points of meshes that modifiers or keys change."""

    def __init__(self, scene, at):
        scene.frame_set(math.floor(at), subframe=at - math.floor(at))
        graph = bpy.context.evaluated_depsgraph_get()
        self.places = {_key(i): i.matrix_world.copy() for i in graph.object_instances}
        if scene.camera:
            self.places[_key(scene.camera)] = scene.camera.evaluated_get(graph).matrix_world.copy()
        self.shapes = {i.object.original.name_full: _points(i.object) for i in graph.object_instances
                       if i.object.type == 'MESH' and not i.is_instance and
                       (i.object.original.modifiers or i.object.original.data.shape_keys)}


def _key(instance):
    """Returns what tells instances apart, also of a camera, which is none."""
    if not getattr(instance, "is_instance", False):
        return getattr(instance, "object", instance).original.name_full, "", ()
    return instance.object.original.name_full, instance.parent.original.name_full, tuple(instance.persistent_id)


def _points(o):
    found = np.empty(3 * len(o.data.vertices), np.float32)
    o.data.vertices.foreach_get("co", found)
    return found


def _apart(a, b):
    return max(abs(v) for row in a - b for v in row)


def animate(root, shutter, notes, shines):
    """Turns the marks of nodes into an animation of a glTF file, from 0 to `shutter` in seconds. `shines(node)` tells lamps."""
    data, samplers, channels = _Data(root), [], []
    times = None
    for number, node in enumerate(root.get("nodes", [])):
        values = node.get("extras", {}).pop("lull_moves", None)
        if not values:
            continue
        if shines(node):
            notes.add("sharp although it moves, as it shines", node["name"])
            continue
        if times is None:
            times = data.add([(0,), (shutter,)], "SCALAR", is_bounded=True)
        for path, keys in _poses(matrices.unpacked(values), "camera" in node).items():
            channels.append({"sampler": len(samplers), "target": {"node": number, "path": path}})
            samplers.append({"input": times, "output": data.add(keys, "VEC4" if path == "rotation" else "VEC3")})
    if channels:
        root["animations"] = [{"name": "shutter", "samplers": samplers, "channels": channels}]
        data.end()
    return bool(channels)


def _poses(places, is_camera):
    """Returns the keys of a node by their path. glTF's cameras look along -z, as Blender's."""
    found = {"translation": [], "rotation": [], "scale": []}
    for place in places:
        location, turn, scale = (_Y_UP @ place @ (Matrix.Identity(4) if is_camera else _Y_UP.inverted())).decompose()
        found["translation"].append(tuple(location))
        found["rotation"].append((turn.x, turn.y, turn.z, turn.w))
        found["scale"].append(tuple(scale))
    return found


class _Data:
    """Numbers in a buffer of their own, which is part of the JSON."""

    def __init__(self, root):
        self.root, self.bytes, self.buffer = root, b"", len(root.get("buffers", []))

    def add(self, rows, kind, is_bounded=False):
        """Returns the number of a new accessor."""
        views, accessors = self.root.setdefault("bufferViews", []), self.root.setdefault("accessors", [])
        packed = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
        views.append({"buffer": self.buffer, "byteOffset": len(self.bytes), "byteLength": len(packed)})
        self.bytes += packed
        accessor = {"bufferView": len(views) - 1, "componentType": _FLOAT, "count": len(rows), "type": kind}
        if is_bounded:
            bounds = [struct.unpack("<f", struct.pack("<f", v))[0] for row in (rows[0], rows[-1]) for v in row]
            accessor.update({"min": bounds[:1], "max": bounds[1:]})
        accessors.append(accessor)
        return len(accessors) - 1

    def end(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        self.root.setdefault("buffers", []).append({"uri": uri, "byteLength": len(self.bytes)})
