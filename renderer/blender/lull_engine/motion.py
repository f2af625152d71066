"""Motion blur: where objects are when the shutter opens and closes, as the animation of a glTF file."""
import math

import bpy
import numpy as np

from .versions import motion_settings

_STARTS = {'START': 0, 'CENTER': -0.5, 'END': -1}  # of the time that the shutter is open
_BENT = 0.2  # of the way, that the middle may be off a straight one


class Motion:
    """The movements while the shutter is open; none without motion blur. `set_frame(frame, subframe)` evaluates the graph at another."""

    def __init__(self, scene, graph, set_frame, notes):
        self._moves, self.shutter = {}, 0
        r = scene.render
        if not r.use_motion_blur:
            return
        length, now = r.motion_blur_shutter, (scene.frame_current, scene.frame_subframe)
        first = sum(now) + length * _STARTS[motion_settings(scene).motion_blur_position]
        moments = []
        for at in first, first + length / 2, first + length:
            set_frame(math.floor(at), at - math.floor(at))
            moments.append(_Moment(graph))
        set_frame(*now)
        start, middle, end = moments
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

    def of(self, instance, matrix):
        """Returns the places of a thing at `matrix` that moves with an instance or an object; None where nothing moves."""
        start, end = self._moves.get(_key(instance), (None, None))
        if start is None or not instance.matrix_world.determinant():
            return None
        away = instance.matrix_world.inverted() @ matrix
        return start @ away, end @ away


class _Moment:
    """The places of objects and instances, and the points of meshes that modifiers or keys change."""

    def __init__(self, graph):
        self.places = {_key(i): i.matrix_world.copy() for i in graph.object_instances}
        if camera := graph.scene_eval.camera:
            self.places[_key(camera)] = camera.matrix_world.copy()
        self.shapes = {i.object.original.name_full: _points(i.object) for i in graph.object_instances
                       if i.object.type == 'MESH' and not i.is_instance and
                       (i.object.original.modifiers or i.object.original.data.shape_keys)}


def _key(instance):
    """Returns the identity of an instance, or of a camera."""
    if not getattr(instance, "is_instance", False):
        return getattr(instance, "object", instance).original.name_full, "", ()
    return instance.object.original.name_full, instance.parent.original.name_full, tuple(instance.persistent_id)


def _points(o):
    found = np.empty(3 * len(o.data.vertices), np.float32)
    o.data.vertices.foreach_get("co", found)
    return found


def _apart(a, b):
    return max(abs(v) for row in a - b for v in row)


def animate(writer, moving, shutter):
    """Adds an animation, from 0 to `shutter` in seconds, of nodes by their numbers, each with its two places."""
    samplers, channels = [], []
    times = writer.array(np.array([0, shutter], np.float32), is_bounded=True) if moving else None
    for number, places in moving.items():
        keys = {"translation": [], "rotation": [], "scale": []}
        for place in places:
            location, turn, scale = place.decompose()
            keys["translation"].append(tuple(location))
            keys["rotation"].append((turn.x, turn.y, turn.z, turn.w))
            keys["scale"].append(tuple(scale))
        for path, values in keys.items():
            channels.append({"sampler": len(samplers), "target": {"node": number, "path": path}})
            samplers.append({"input": times, "output": writer.array(np.array(values, np.float32))})
    if channels:
        writer.add("animations", {"name": "shutter", "samplers": samplers, "channels": channels})
