"""Makes sheets of panes that are modelled as slabs of glass: light sampling passes a sheet, and no solid."""
import numpy as np

from . import solids
from .meshes import Mesh

_SMOOTH = 0.03  # roughness


def sheet(mesh, matrix, parts):
    """Returns the middle of a closed slab of clear glass, and its material; None for other meshes and `parts` (see dress.Part)."""
    if len(mesh.materials) != 1 or len(parts) != 1 or not _is_clear_glass(parts[0].material):
        return None
    points = mesh.points.astype(float)
    low, high = points.min(0), points.max(0)
    sides = (high - low) * np.linalg.norm(matrix[:3, :3], axis=0)
    axis = int(np.argmin(sides))
    thick = high[axis] - low[axis]
    is_slab = thick > 0 and np.delete(sides, axis).min() >= solids.LEAST_WIDTHS * sides[axis]
    top = points[:, axis] > high[axis] - 0.01 * thick
    bottom = points[:, axis] < low[axis] + 0.01 * thick
    faces = [mesh.face_corners(i) for i in range(len(mesh.starts))] if is_slab and (top | bottom).all() else ()
    if not len(faces) or not solids.is_closed(faces):
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
