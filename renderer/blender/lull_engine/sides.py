"""Surfaces that nodes show on one side alone, or with another one on the other side: a Mix Shader by Backfacing."""
from typing import NamedTuple

import bmesh


class Pair(NamedTuple):
    """What both sides become; None is nothing."""
    front: object
    back: object

    def of(self, mesh):
        return Pair(*(found[mesh] if isinstance(found, dict) else found for found in self))


def are_of(node, source_of):
    """Returns whether a node mixes the sides; `source_of(socket)` returns the output that its factor comes from."""
    factor = source_of(node.inputs[0]) if node.type == 'MIX_SHADER' else None
    return factor is not None and factor.node.type == 'NEW_GEOMETRY' and factor.name == 'Backfacing'


def open_behind(found):
    """Lets rays from behind pass a converted material, or those of meshes. Returns it."""
    for material in found.values() if isinstance(found, dict) else [found]:
        if material is not None:
            material["lull_sided"] = True
            material.use_backface_culling = True
    return found


def divide(mesh, pairs):
    """Gives faces the materials of their sides, by the numbers of their slots: those of the back are turned, or copied and turned."""
    for slot, pair in pairs.items():
        mesh.materials[slot] = pair.front or pair.back
    edited = bmesh.new()
    edited.from_mesh(mesh)
    for slot, (front, back) in pairs.items():
        faces = [f for f in edited.faces if f.material_index == slot]
        if front and back:
            made = bmesh.ops.duplicate(edited, geom=faces)["geom"]
            faces = [f for f in made if isinstance(f, bmesh.types.BMFace)]
            for face in faces:
                face.material_index = len(mesh.materials)
            mesh.materials.append(back)
        if back:
            bmesh.ops.reverse_faces(edited, faces=faces)
        elif not front:
            bmesh.ops.delete(edited, geom=faces, context='FACES')
    edited.to_mesh(mesh)
    edited.free()
