"""Tells bodies that have an inside worth seeing from sheets and slabs. Panes that are modelled as slabs of glass become sheets, which
light sampling passes."""
import numpy as np

from .meshes import Mesh

_LEAST_WIDTHS = 20  # of the thickness, that a slab has both ways
_SMOOTH = 0.03  # roughness of clear glass


def has_solid(mesh, matrix, slots):
    """Returns whether the faces of material slots form a closed body, other than a slab."""
    points = mesh.points @ np.array(matrix.to_3x3()).T
    faces = [mesh.face_corners(i) for i in np.flatnonzero(np.isin(mesh.slots, slots))]
    return any(_is_closed(part) and not _is_flat(points, part) for part in _parts(faces))


def _is_closed(faces):
    """Returns whether each edge of faces, arrays of vertices, has two."""
    edges = np.concatenate([np.stack([f, np.roll(f, -1)], 1) for f in faces])
    return bool((np.unique(np.sort(edges, 1), axis=0, return_counts=True)[1] == 2).all())


def _parts(faces):
    """Returns the lists of faces that vertices connect."""
    above = {}

    def root(vertex):
        while above.setdefault(vertex, vertex) != vertex:
            above[vertex] = above[above[vertex]]
            vertex = above[vertex]
        return vertex

    for first, *others in faces:
        for vertex in others:
            above[root(vertex)] = root(first)
    parts = {}
    for face in faces:
        parts.setdefault(root(face[0]), []).append(face)
    return parts.values()


def _is_flat(points, faces):
    part = points[np.unique(np.concatenate(faces))]
    part = part - part.mean(0)
    sides = np.sort(np.ptp(part @ np.linalg.eigh(part.T @ part)[1], axis=0))
    return sides[1] >= _LEAST_WIDTHS * sides[0]


def sheet(mesh, matrix, parts):
    """Returns the middle of a closed slab of clear glass, and its material; None for other meshes and `parts` (see dress.Part)."""
    if len(mesh.materials) != 1 or len(parts) != 1 or not _is_clear_glass(parts[0].material):
        return None
    points = mesh.points.astype(float)
    low, high = points.min(0), points.max(0)
    sides = (high - low) * np.linalg.norm(matrix[:3, :3], axis=0)
    axis = int(np.argmin(sides))
    thick = high[axis] - low[axis]
    is_slab = thick > 0 and np.delete(sides, axis).min() >= _LEAST_WIDTHS * sides[axis]
    top = points[:, axis] > high[axis] - 0.01 * thick
    bottom = points[:, axis] < low[axis] + 0.01 * thick
    faces = [mesh.face_corners(i) for i in range(len(mesh.starts))] if is_slab and (top | bottom).all() else ()
    if not len(faces) or not _is_closed(faces):
        return None
    points[:, axis] = (low[axis] + high[axis]) / 2
    kept = [f for f in faces if top[f].all()]
    if not kept:
        return None
    used, corners = np.unique(np.concatenate(kept), return_inverse=True)
    totals = np.array([len(f) for f in kept])
    made = Mesh(mesh.name + " sheet", points[used].astype(np.float32), corners.ravel().astype(np.int32),
                (np.cumsum(totals) - totals).astype(np.int32))
    made.cut()
    return made, _thin(parts[0].material)


def _is_clear_glass(material):
    pbr, extensions, own = (material.get(n, {}) for n in ("pbrMetallicRoughness", "extensions", "extras"))
    volume = extensions.get("KHR_materials_volume")
    return (volume is not None and "attenuationColor" not in volume and not own.get("lull", {}).get("castsNoShadow") and
            extensions["KHR_materials_transmission"]["transmissionFactor"] > 0.99 and "metallicRoughnessTexture" not in pbr and
            pbr["roughnessFactor"] <= _SMOOTH and "baseColorTexture" not in pbr and "alphaMode" not in material and
            "normalTexture" not in material)


def _thin(material):
    """Returns glass without thickness, which light passes once: the colour of both sides of the slab."""
    *colour, alpha = material["pbrMetallicRoughness"]["baseColorFactor"]
    return {**material, "pbrMetallicRoughness": {**material["pbrMetallicRoughness"], "baseColorFactor": [*(c * c for c in colour), alpha]},
            "extensions": {n: e for n, e in material["extensions"].items() if n != "KHR_materials_volume"}}
