"""Values and images that only Cycles can evaluate: asked of a second Blender, all at once, in which second.py runs.

A Baker is asked twice: what it does not know yet is zero, and noted as wanted; run() finds it out.
"""
import json
import math
import os

import bpy
import numpy as np

from .images import numbers_of
from .nodes import described
from .process import Failure, ended as how_ended, run

_SECOND = os.path.join(os.path.dirname(os.path.abspath(__file__)), "second.py")
_USED = 0.6  # of an image, by the faces of an unwrapped mesh
_FINE, _LEAST, _AROUND = 4, 128, 16  # pixels of an image across one of the view, of an image, and across a face: at least
_PER_PIXEL, _PER_FACE, _PER_IMAGE = 1e-6, 1.5e-5, 0.1  # seconds that bakes take, roughly
_SHORT = 1e-6  # of the longest edge
_NOTHING = np.zeros((4, 4, 3))


class Baker:
    """`size` is the largest of images that have no size of their own, in pixels; `view` tells the camera's (see camera.View)."""

    def __init__(self, size, view, notes):
        self.size, self.view, self._notes = size, view, notes
        self._known, self._bakes, self._bodies, self._blocks, self._nearest = {}, {}, {}, {}, {}
        self.world, self.suns = None, []
        self.is_lacking = False  # set where something is not known; for others to reset

    def see(self, shown):
        """Takes the places of meshes (shown.Shown), whose images are as fine as the view asks for where they are nearest."""
        eye = self.view.matrix.translation
        for s in shown:
            known = self._nearest.get(s.mesh)
            if known is None or (s.matrix.translation - eye).length < (known.translation - eye).length:
                self._nearest[s.mesh] = s.matrix

    def plain(self, place, output, shown=None):
        """Returns the R, G, B of an output that is the same everywhere, or all over an object, of the tree of a data-block."""
        return self._ask((output, shown), place, output, {"over": 'all', "object": shown and _object(shown)}, np.zeros(3))

    def over_uvs(self, place, output, names, size):
        """Returns the pixels over a square, whose UV layers have these names."""
        return self._ask((output, 'uv', size), place, output, {"over": 'uv', "names": names, "size": size or self.size}, _NOTHING)

    def over_mesh(self, place, output, mesh, shown, slots, kind='EMIT'):
        """Returns the pixels over the UV layer `lull` of a mesh, which it adds, where the mesh has the material of these slots."""
        body = self._body(mesh, shown)
        return self._ask((output, mesh, kind), place, output,
                         {"over": 'mesh', "body": body, "size": self._size_of(mesh), "slots": slots, "kind": kind}, _NOTHING)

    def displace(self, place, output, mesh, shown, slot):
        """Lets run() displace a mesh."""
        self._bodies[self._body(mesh, shown)][2].append((slot, described(output, _path(place))))
        self._keep(place)

    def is_coarse(self, mesh):
        """Returns whether pixels over a mesh are wider than two pixels of the view, where it is nearest."""
        return self._across(mesh) > 2 * self.size

    def _size_of(self, mesh):
        wanted = max(_LEAST, _FINE * self._across(mesh))
        if mesh.slots.max(initial=0) > 0:  # where materials meet, pixels have none
            wanted = max(wanted, _AROUND * math.sqrt(len(mesh.starts) / _USED))
        return self.size if wanted > self.size else min(self.size, 2 ** math.ceil(math.log2(wanted)))

    def _across(self, mesh):
        """Returns the pixels of the view across an unwrapped mesh."""
        matrix = self._nearest[mesh]
        a, b, c = ((mesh.points @ np.array(matrix.to_3x3()).T)[mesh.corners[mesh.triangles[:, i]]] for i in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
        eye = np.array(matrix.inverted_safe() @ self.view.matrix.translation)
        near = np.array(matrix.to_3x3()) @ (np.clip(eye, mesh.points.min(0), mesh.points.max(0)) - eye)
        return np.sqrt(area / _USED) / max(self.view.pixel_width(np.linalg.norm(near)), 1e-9)

    def _body(self, mesh, shown):
        for number, (known, _, _) in self._bodies.items():
            if known is mesh:
                return number
        if _has_short_edges(mesh):  # which would be unwrapped to a line
            mesh.as_triangles()
        self._bodies[len(self._bodies)] = mesh, shown, []
        return len(self._bodies) - 1

    def _ask(self, key, place, output, what, otherwise):
        if key in self._known:
            return self._known[key]
        self.is_lacking = True
        if key not in self._bakes:
            self._bakes[key] = dict(what, nodes=described(output, _path(place)), number=len(self._known) + len(self._bakes))
            self._keep(place)
        return otherwise

    def _keep(self, place):
        original = place.original
        self._blocks[original.name_full] = original

    def ask_world(self, what, *blocks):
        """Lets run() render a world; see world.write()."""
        self.world = what
        self._blocks.update({b.original.name_full + " of the world": b.original for b in blocks})

    @property
    def is_asked(self):
        return bool(self._bakes or self.world or any(moves for _, _, moves in self._bodies.values()))

    def run(self, scene, folder, stopped, heard):
        """Answers all questions. Returns false if `stopped` has returned true. Raises: Failure."""
        if not self.is_asked:
            return True
        blocks = set(self._blocks.values())
        blend = os.path.join(folder, "nodes.blend")
        bpy.data.libraries.write(blend, {scene.original} if any(b.library for b in blocks) else blocks, path_remap='ABSOLUTE')
        used = {bake.get("body") for bake in self._bakes.values()}
        bodies = {n: self._written(n, *body, folder) for n, body in self._bodies.items() if n in used or body[2]}
        what = {"blend": blend, "frame": scene.frame_current, "subframe": scene.frame_subframe, "bakes": list(self._bakes.values()),
                "bodies": bodies, "world": self.world, "images": _changed(folder)}
        request = os.path.join(folder, "request.json")
        with open(request, "w", encoding="utf-8") as f:
            json.dump(what, f)
        heard(f"lull: {self._forecast()}\n")
        code, output, ended = run(
            [bpy.app.binary_path, "-b", "--factory-startup", "-noaudio", "--enable-autoexec" if
             bpy.context.preferences.filepaths.use_scripts_auto_execute else "--disable-autoexec", "--python-exit-code", "1",
             "--python", _SECOND, "--", request], stopped, heard)
        if ended:
            return False
        said = os.path.join(folder, "said.json")
        if code != 0 or not os.path.exists(said):
            lines = [line for line in output.splitlines() if line.strip() and not line.startswith(("Blender quit", "Error: script failed"))]
            raise Failure("The scene cannot be exported: " + (lines[-1] if lines else "the second Blender " + how_ended(code)))
        self._read(folder, bodies)
        with open(said, encoding="utf-8") as f:
            told = json.load(f)
        self.suns += told["suns"]
        for name, error in told["failed"]:
            self._notes.add(f"black in parts, after an error ({error})", name, "materials")
        os.remove(said)
        return True

    def _forecast(self):
        """Returns the number of bakes and their approximate time, as text."""
        sizes = [b["size"] for b in self._bakes.values() if "size" in b]
        faces = sum(len(body[0].starts) for body in self._bodies.values())
        seconds = _PER_IMAGE * len(self._bakes) + _PER_PIXEL * sum(s * s for s in sizes) + _PER_FACE * faces
        told = [f"{len(sizes)} images of up to {max(sizes)} pixels across"] if sizes else []
        told += [f"{len(self._bakes) - len(sizes)} values"] if len(self._bakes) > len(sizes) else []
        told += ["the world"] if self.world else []
        return f"baking {', '.join(told) or 'displacement'}, about {math.ceil(seconds)} s"

    def _written(self, number, mesh, shown, moves, folder):
        arrays = {n: getattr(mesh, n) for n in ("points", "corners", "starts", "slots", "normals", "smooth")}
        # Without any UVs, nodes would read the UVs of the bake.
        arrays.update({f"uv {n}": v for n, v in (mesh.uvs or {"none": mesh.uv("")}).items() if n != "lull"})
        arrays.update({f"colour {n}": v for n, v in mesh.colours.items()})
        arrays.update({f"{domain} {n}": v for n, (domain, v) in mesh.attributes.items()})
        if mesh.generated is not None:
            arrays["generated"] = mesh.generated
        np.savez(os.path.join(folder, f"body{number}.npz"), **arrays)
        return {"arrays": f"body{number}.npz", **_object(shown), "uv": mesh.uv_of_render or "none", "colour": mesh.colour_of_render,
                "box": [list(map(float, v)) for v in mesh.box] if mesh.box else _box(mesh), "size": self.size, "moves": moves}

    def _read(self, folder, bodies):
        for key, bake in self._bakes.items():
            self._known[key] = np.load(os.path.join(folder, f"bake{bake['number']}.npy"))
        self._bakes = {}
        for number, body in bodies.items():
            mesh = self._bodies[number][0]
            mesh.uvs["lull"] = np.load(os.path.join(folder, f"uv{number}.npy"))
            if body["moves"]:
                mesh.points, mesh.normals = (np.load(os.path.join(folder, f"{n}{number}.npy")) for n in ("points", "normals"))
                self._bodies[number][2].clear()
        self.world = None


def _changed(folder):
    """Writes the pixels of images that are new or changed in the session. Returns the files by name."""
    found = {}
    for image in bpy.data.images:
        if image.is_dirty and image.users and image.source in ('FILE', 'GENERATED') and image.type in ('IMAGE', 'UV_TEST'):
            found[image.name_full] = f"image{len(found)}.npy"
            np.save(os.path.join(folder, found[image.name_full]), numbers_of(image))
    return found


def _object(shown):
    """Returns the properties of an object that materials may read."""
    o = shown.original
    plain = {n: v for n, v in o.items() if isinstance(v, (int, float, str)) or hasattr(v, "to_list")}
    return {"name": o.name, "matrix": [list(row) for row in shown.matrix], "color": list(o.color), "pass_index": o.pass_index,
            "properties": {n: v.to_list() if hasattr(v, "to_list") else v for n, v in plain.items()}}


def _path(place):
    kind = {"Material": "materials", "World": "worlds"}.get(type(place).__name__, "lights")
    return [kind, place.original.name_full]


def _box(mesh):
    low, high = mesh.points.min(0), mesh.points.max(0)
    return [[float(v) for v in values] for values in ((low + high) / 2, np.maximum((high - low) / 2, 1e-6))]


def _has_short_edges(mesh):
    ends = np.roll(mesh.corners, -1)
    ends[mesh.starts + mesh.totals - 1] = mesh.corners[mesh.starts]
    lengths = np.linalg.norm(mesh.points[ends] - mesh.points[mesh.corners], axis=1)
    return lengths.min(initial=np.inf) < _SHORT * lengths.max(initial=0)
