"""Normal maps: their strength as Cycles has it, and how far their normals lean."""
import numpy as np

import images

# Of the light of a white sky, what Cycles takes from diffuse surfaces whose normals lean by so many degrees, and lull does not.
_LEANS, _DIMMED = (0, 5, 10, 15, 20, 27, 35, 45, 60), (0, 0.013, 0.035, 0.057, 0.077, 0.101, 0.121, 0.133, 0.125)
MOST = 0.02
_FAR, _SHARE, _MOST_FACES = 40, 0.05, 100_000  # degrees; of the area; of meshes that are looked at


def lean_from_faces(mesh):
    """Returns whether normals of a mesh lean so far from its faces that Cycles, which moves the origins of shadow rays to a smooth
    surface, lights them otherwise."""
    count = len(mesh.polygons)
    if not 0 < count <= _MOST_FACES or not any(p.use_smooth for p in mesh.polygons):
        return False
    mesh.calc_normals_split()
    corners, faces = np.empty(3 * len(mesh.loops), np.float32), np.empty(3 * count, np.float32)
    areas, totals = np.empty(count, np.float32), np.empty(count, np.int32)
    mesh.loops.foreach_get("normal", corners)
    for name, values in ("normal", faces), ("area", areas), ("loop_total", totals):
        mesh.polygons.foreach_get(name, values)
    cosines = (corners.reshape(-1, 3) * np.repeat(faces.reshape(-1, 3), totals, 0)).sum(1)
    leaning = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
    means = np.add.reduceat(leaning, np.cumsum(totals) - totals) / totals
    return areas[means > _FAR].sum() > _SHARE * areas.sum()


def dimmed(pixels, strength=1):
    """Returns the share of a white sky's light that Cycles takes from a diffuse surface with the normals of these pixels."""
    x, y, z = _vectors(pixels, strength)
    return float(np.interp(np.degrees(np.arctan2(np.hypot(x, y), z)), _LEANS, _DIMMED).mean())


def weakened(pixels, name, strength):
    """Returns the image of a normal map of strength 1: Cycles raises z where the strength is below 1, glTF does not."""
    values, vectors = pixels.copy(), np.stack(_vectors(pixels, strength), -1)
    values[:, :, :3] = 0.5 + 0.5 * vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)
    return images.made_of(values, name, 'Non-Color')


def _vectors(pixels, strength):
    x, y, z = (2 * pixels[..., i].astype(float) - 1 for i in range(3))
    return x * strength, y * strength, 1 + (z - 1) * min(max(strength, 0), 1)
