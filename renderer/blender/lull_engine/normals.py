"""Normals: maps, whose strength is as Cycles has it, and how far normals lean."""
import numpy as np

# The fraction of a white sky's light that Cycles, unlike lull, takes from diffuse surfaces whose normals lean by these degrees.
_LEANS, _DIMMED = (0, 5, 10, 15, 20, 27, 35, 45, 60), (0, 0.013, 0.035, 0.057, 0.077, 0.101, 0.121, 0.133, 0.125)
MOST = 0.02
_FAR, _SHARE, _MOST_FACES = 40, 0.05, 100_000  # degrees; of the area; of meshes that are looked at


def lean_from_faces(mesh):
    """Returns whether normals of a mesh lean so far from its faces that Cycles, which moves the origins of shadow rays to a smooth
    surface, lights them otherwise."""
    if len(mesh.starts) > _MOST_FACES or not len(mesh.triangles):
        return False
    a, b, c = (mesh.points[mesh.corners[mesh.triangles[:, i]]] for i in range(3))
    across = np.cross(b - a, c - a)
    areas = np.linalg.norm(across, axis=1)
    cosines = (mesh.normals[mesh.triangles] * (across / np.maximum(areas, 1e-20)[:, None])[:, None]).sum(2)
    means = np.degrees(np.arccos(np.clip(cosines, -1, 1))).mean(1)
    return areas[means > _FAR].sum() > _SHARE * areas.sum()


def dimmed(pixels, strength=1):
    """Returns the share of a white sky's light that Cycles takes from a diffuse surface with the normals of these pixels."""
    x, y, z = _vectors(pixels, strength)
    return float(np.interp(np.degrees(np.arctan2(np.hypot(x, y), z)), _LEANS, _DIMMED).mean())


def weakened(pixels, strength):
    """Returns the pixels of a normal map of strength 1: Cycles raises z where the strength is below 1, glTF does not."""
    vectors = np.stack(_vectors(pixels, strength), -1)
    return 0.5 + 0.5 * vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)


def _vectors(pixels, strength):
    x, y, z = (2 * pixels[..., i].astype(float) - 1 for i in range(3))
    return x * strength, y * strength, 1 + (z - 1) * min(max(strength, 0), 1)
