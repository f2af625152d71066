"""Writes the scene of a render as glTF, with the files beside it that `lull render` takes."""
import os
from dataclasses import dataclass, field

import numpy as np
from mathutils import Matrix

from . import dress, lights, motion
from .baking import Baker
from .camera import View
from .glb import Writer
from .images import Images
from .notes import Notes, limits, note_film
from .shown import Collector, is_flat, is_sheared
from .surroundings import Surroundings
from .versions import not_tested

_Y_UP = (1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1)  # column by column
_MOST_GROUPS = 16  # that lull renders
_FAST, _SMALL = 0, 6  # levels of zlib, for files that are read once, and that are kept
_ROUNDS = 3  # of questions to a second Blender, at most


@dataclass
class Exported:
    """`groups` are the names of light groups for lull; `shutter` is the time that it is open, in seconds, 0 where nothing moves;
    `stereo` are arguments of `lull render` for two eyes; `objects` and `materials` are pass indices by their names; `names` are the names
    in the file, by kinds such as "nodes"."""
    gltf: str
    environment: str = None
    backdrop: str = None
    groups: dict = field(default_factory=dict)
    shutter: float = 0
    stereo: list = field(default_factory=list)
    objects: dict = field(default_factory=dict)
    materials: dict = field(default_factory=dict)
    names: dict = field(default_factory=dict)
    warnings: list = field(default_factory=list)
    remarks: list = field(default_factory=list)


def export(graph, set_frame, folder, scratch, name, suffix, is_render, stopped, heard):
    """Writes the scene of a render's depsgraph as NAME.gltf or NAME.glb into a folder; `scratch` is another. `set_frame(frame, subframe)`
    evaluates it at another time. `is_render`: the file is read once, and the background has a picture of its own. `heard` is called with
    the output of a second Blender.

    Returns: Exported; None if `stopped` has returned true. Raises: Failure.
    """
    scene, notes = graph.scene_eval, Notes()
    layer = scene.original.view_layers[graph.view_layer_eval.name]
    base = os.path.join(folder, name)
    if told := not_tested():
        notes.say(told)
    moving = motion.Motion(scene, graph, set_frame, notes)
    view = View(scene, graph, notes)
    note_film(scene.original, layer, notes)
    found = Collector(graph, layer, moving, notes)
    baker = Baker(scene.lull.texture, view, notes)
    pictures = Images(_FAST if is_render else _SMALL, notes)
    dresser = dress.Dresser(found.shown, baker, pictures, notes)
    lamps = lights.Lights(found.lamps, scene, base, baker, notes)
    world = Surroundings(scene, layer, view, base, is_render and not (view.stereo or moving.moves(scene.camera)), baker, notes)
    for _ in range(_ROUNDS):
        baker.is_lacking, told = False, Notes()
        parts, lit = dresser.dress(told), lamps.read(told)
        if not baker.is_asked:
            break
        if not baker.run(scene, scratch, stopped, heard):
            return None
    notes.take(told)
    if world.backdrop and moving.moves(scene.camera):
        notes.say("the background is sharp although the camera moves")
    if world.backdrop and view.stereo:
        notes.say("both eyes have the same background")
    if scene.lull.panes:
        dress.make_sheets(found.shown, parts, notes)
    _move_flat(found.shown, parts, notes)
    nodes = _Nodes(layer, Writer(), notes)
    nodes.add_camera(view, moving.of(scene.camera, view.matrix))
    nodes.add_meshes(found.shown, parts)
    nodes.add_lights(lit, baker.suns)
    if not nodes.shines and not world.light:  # without any light, lull would have a studio
        world.black()
        notes.say("the picture is black, as nothing shines")
    path = base + suffix
    shutter = nodes.write(path, moving.shutter)
    groups = nodes.groups
    if world.light and scene.world and scene.world.lightgroup in layer.lightgroups:
        groups[scene.world.lightgroup] = "environment"
    materials = {m.original for s in found.shown for m in s.mesh.materials if m}
    chosen, usual = limits(scene.original, scene.lull.max_depth)
    return Exported(path, world.light, world.backdrop, groups, shutter, view.stereo, _indices(s.original for s in found.shown),
                    _indices(materials), nodes.names(), notes.lines() + chosen, usual)


def _move_flat(shown, parts, notes):
    """Moves the vertices of objects that are scaled to no volume, whose matrix has no inverse."""
    for s in shown:
        if is_flat(s.matrix) and s.mesh in parts:
            moved = s.mesh.moved(np.array(s.matrix))
            has_area = moved.normals.any()
            parts[moved] = parts[s.mesh] if has_area else []
            s.mesh, s.matrix, s.moves = moved, Matrix(), None
            if has_area:
                notes.add("scaled to no height and shown in full colours, where Cycles has black", s.name)


def _indices(blocks):
    """Returns the pass indices that are not 0, by name."""
    return {block.name: block.pass_index for block in blocks if block.pass_index}


class _Nodes:
    """The nodes of a file, below one that turns z up. `groups` are the names that `lull render --light-groups` takes for groups that
    shine."""

    def __init__(self, layer, writer, notes):
        self.groups, self._names, self._notes = {}, [g.name for g in layer.lightgroups], notes
        self._writer, self._children, self._moving, self._lights = writer, [], {}, []
        self.shines = False

    def add_camera(self, view, moves):
        self._add(view.name, view.matrix, moves, camera=self._writer.add("cameras", view.described()))

    def add_meshes(self, shown, parts):
        numbers, shining = dress.add_meshes(self._writer, shown, parts, self._notes)
        for s in shown:
            if s.mesh not in numbers:
                continue
            shines, moves = s.mesh in shining, s.moves
            self.shines |= shines
            if shines and moves:
                self._notes.add("sharp although it moves, as it shines", s.name)
                moves = None
            own = {name: True for name, on in (("hiddenFromCamera", s.is_hidden), ("castsNoShadow", s.is_shadowless)) if on}
            self._add(self._named(s.name, s.group, shines), s.matrix, moves, own, mesh=numbers[s.mesh])

    def add_lights(self, lit, suns):
        numbers = {}
        self.shines |= bool(lit or suns)
        for light, lamp in lit:
            o = lamp.original
            own = {} if o.visible_camera else {"hiddenFromCamera": True}
            name = self._named(o.name, o.lightgroup, True)
            place, turn, scale = lamp.matrix.decompose()
            upright = Matrix.LocRotScale(place, turn, scale if lamp.matrix.determinant() else None)  # not sheared, nor without a size
            if light.type != 'AREA':
                if id(light) not in numbers:
                    numbers[id(light)] = self._light(lights.punctual(light))
                self._add(name, upright, None, own, extensions={"KHR_lights_punctual": {"light": numbers[id(light)]}})
            elif made := lights.area(light, lamp.matrix):
                mesh, material = made
                number = dress.add_meshes(self._writer, [_Placed(mesh)], {mesh: [dress.Part(material, 0)]}, self._notes)[0][mesh]
                self._add(name, upright, None, own, mesh=number)
        for said in suns:  # of the light group of all infinite lights
            light, matrix = lights.sun(said)
            self._add("environment", matrix, None, extensions={"KHR_lights_punctual": {"light": self._light(lights.punctual(light))}})

    def _light(self, made):
        self._lights.append(made)
        return len(self._lights) - 1

    def _named(self, name, group, shines):
        """Returns a node's name, or that of its light group."""
        if group not in self._names or not shines:
            return name
        if group not in self.groups and len(self.groups) == _MOST_GROUPS:
            self._notes.add(f"black in its pass, as one of more than {_MOST_GROUPS}", group, "light groups")
            return name
        return self.groups.setdefault(group, f"light group {len(self.groups)}")

    def _add(self, name, matrix, moves, own=None, **what):
        node = {"name": name, **what}
        if own:
            node["extras"] = {"lull": own}
        if moves is None:
            node["matrix"] = _columns(matrix)
        elif is_sheared(matrix):  # animated nodes cannot be sheared; a node above one can
            node["matrix"] = _columns(matrix)
            node, moves = {"children": [self._writer.add("nodes", node)]}, [place @ matrix.inverted() for place in moves]
        number = self._writer.add("nodes", node)
        self._children.append(number)
        if moves is not None:
            self._moving[number] = moves

    def names(self):
        return {kind: [v.get("name", "") for v in values] for kind, values in self._writer.root.items()
                if isinstance(values, list) and kind in ("nodes", "meshes", "materials", "images")}

    def write(self, path, shutter):
        """Writes the file. Returns the time that the shutter is open, 0 where nothing moves."""
        w = self._writer
        motion.animate(w, self._moving, shutter)
        w.add("nodes", {"name": "z up", "matrix": _Y_UP, "children": self._children})
        w.root["scenes"], w.root["scene"] = [{"nodes": [len(w.root["nodes"]) - 1]}], 0
        if self._lights:
            w.root["extensions"] = {"KHR_lights_punctual": {"lights": self._lights}}
        w.write(path)
        return shutter if self._moving else 0


@dataclass(frozen=True, eq=False)
class _Placed:
    mesh: object


def _columns(matrix):
    return [v for column in Matrix(matrix).transposed() for v in column]
