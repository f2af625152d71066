"""Gives meshes their materials: each converted once, or once a mesh where nodes are baked over it."""
from typing import NamedTuple

import numpy as np

from . import displacement, materials, meshes, solids
from .surfaces import Surface, state_of


class Part(NamedTuple):
    """A material, as JSON, of the faces of a slot; `is_back`: of their backs."""
    material: dict
    slot: int
    is_back: bool = False


class Dresser:
    """The materials of places of meshes (shown.Shown)."""

    def __init__(self, shown, baker, pictures, notes):
        self._shown, self._baker, self._pictures = shown, baker, pictures
        self._first = {}  # place of each mesh
        baker.see(shown)
        for s in shown:
            self._first.setdefault(s.mesh, s)
        users = {}
        for mesh, place in self._first.items():
            for slot, material in enumerate(mesh.materials):
                users.setdefault(material and material.original, (material, {}))[1].setdefault(mesh, []).append(slot)
                if moves := displacement.source(material):
                    baker.displace(material, moves, mesh, place, slot)
        self._users = list(users.values())
        self._surfaces = [self._read(material, of, notes) for material, of in self._users]

    def _read(self, material, users, notes):
        """Returns the surface, two for materials whose sides differ, or a word for a material without one."""
        if material is None:
            return 'plain'
        state = state_of(material)
        if state != 'nodes':
            return state

        def is_solid():
            return any(solids.has_solid(mesh, self._first[mesh].matrix, slots) for mesh, slots in users.items())

        with notes.of(material.name, "materials"):
            surface = Surface(material, self._baker.view, is_solid, notes)
            return (surface,) if not surface.has_sides else tuple(
                Surface(material, self._baker.view, is_solid, notes, side) for side in (1, 2))
        return 'viewport'

    def dress(self, notes):
        """Returns the parts of each mesh. To be called again while the baker lacks something."""
        parts = {mesh: [] for mesh in self._first}
        for (material, users), surfaces in zip(self._users, self._surfaces):
            if surfaces == 'volume':
                continue
            if isinstance(surfaces, str):
                colour = {'plain': (0.8,) * 3, 'black': (0,) * 3}.get(surfaces) or tuple(material.diffuse_color)[:3]
                made = materials.plain(material.name if material else "plain", colour)
                self._give(parts, users, lambda mesh, made=made: made, False)
            else:
                for i, surface in enumerate(surfaces):
                    self._give(parts, users, self._writer(surface, users, notes), i > 0, len(surfaces) > 1)
        fog = {material for (material, _), surfaces in zip(self._users, self._surfaces) if surfaces == 'volume'}
        for mesh in parts:
            if fog.issuperset(mesh.materials):
                notes.add("left out, being nothing but a volume", self._first[mesh].name)
        return {mesh: found for mesh, found in parts.items() if found}

    def _give(self, parts, users, made_for, is_back, has_sides=False):
        for mesh, slots in users.items():
            material = made_for(mesh)
            if material is None:
                continue
            if has_sides:
                material = {**material, "doubleSided": False}
                material["extras"] = {"lull": {**material.get("extras", {}).get("lull", {}), "openBehind": True}}
            parts[mesh] += [Part(material, slot, is_back) for slot in slots]

    def _writer(self, surface, users, notes):
        """Returns a function of a mesh that returns the material there."""
        def note(consequence):
            notes.add(consequence, surface.name, "materials")

        if surface.parameters is None:
            made = materials.plain(surface.name, tuple(surface.material.diffuse_color)[:3])
            return lambda mesh: made
        if surface.parameters['Alpha'] == 0 and not surface.is_air:
            return lambda mesh: None
        def write(over):
            with notes.of(surface.name, "materials"):
                return materials.write(surface, self._baker, self._pictures, note, over)
            return materials.plain(surface.name, tuple(surface.material.diffuse_color)[:3])

        if not materials.needs_mesh(surface, self._pictures):
            made = write(None)
            return lambda mesh: made
        return lambda mesh: write((mesh, self._first[mesh], users[mesh]))


def add_meshes(writer, shown, parts, notes):
    """Writes meshes and their materials. Returns their numbers, and the set of meshes that shine."""
    known, numbers, shining = {}, {}, set()

    def material_of(part):
        if id(part.material) not in known:
            known[id(part.material)] = _resolved(writer, part.material, notes)
        return known[id(part.material)]

    for mesh in {s.mesh: None for s in shown}:
        if mesh not in parts:
            continue
        if any(max(p.material.get("emissiveFactor", [0])) > 0 for p in parts[mesh]):
            shining.add(mesh)
        slots = mesh.slots[mesh.faces]
        rows = [(number, mesh.triangles[slots == p.slot], uvs, colours, p.is_back)
                for p in parts[mesh] for number, uvs, colours in [material_of(p)]]
        number = meshes.write(writer, mesh, rows)
        if number is not None:
            numbers[mesh] = number
    return numbers, shining


def _resolved(writer, material, notes):
    """Adds a material. Returns its number, the names of the two sets of UVs that lull has, and that of its colours or None."""
    sets = list(dict.fromkeys(t.uv for t in _textures(material)))
    if len(sets) > 2:
        notes.add("without the third of its sets of UVs", material["name"], "materials")

    def said(value):
        if isinstance(value, materials.Texture):
            made = {"index": writer.texture(value.picture, value.wrap)}
            if at := min(sets.index(value.uv), 1):
                made["texCoord"] = at
            if value.scale != 1:
                made["scale"] = value.scale
            if value.moves:
                made["extensions"] = {"KHR_texture_transform": value.moves}
            return made
        if isinstance(value, dict):
            return {name: said(v) for name, v in value.items() if name != "colours" and v != {}}
        return value

    return writer.add("materials", said(material)), sets[:2], material.get("colours")


def _textures(value):
    if isinstance(value, materials.Texture):
        yield value
    elif isinstance(value, dict):
        for v in value.values():
            yield from _textures(v)


def make_sheets(shown, parts, notes):
    """Replaces slabs of clear glass by sheets."""
    sheets = {}
    for s in shown:
        if s.is_shadowless or s.mesh not in parts:  # light passes it as it is
            continue
        mesh = s.mesh
        if mesh not in sheets:
            sheets[mesh] = solids.sheet(mesh, np.array(s.matrix), parts[mesh])
        if sheets[mesh] is not None:
            s.mesh, material = sheets[mesh]
            parts[s.mesh] = [Part(material, 0)]
            notes.add("made a sheet instead of a slab of glass, so that light passes", s.name)
