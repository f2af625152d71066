"""Moves the vertices of meshes as the displacement of their materials does."""
import numpy as np

from .nodes import Made, Tree
from .versions import displacement_method

RAISED = 10  # metres, since negative light might not be baked


def moves(material):
    """Returns whether a material moves vertices; others only change normals."""
    return displacement_method(material) != 'BUMP'


def source(material):
    """Returns the output of a material's displacement, raised; None for one that moves nothing."""
    if material is None or not material.use_nodes or not moves(material):
        return None
    output = Tree(material).output
    found = output.inputs['Displacement'].source if output is not None else None
    return found and Made('VectorMath', 'VECT_MATH', found, (RAISED,) * 3, operation='ADD').output(0, 'VECTOR')


def moved(points, corners, starts, slots, matrix, vectors):
    """Returns the vertices that `vectors` of corners, by slots, move in the world; `matrix` is that of the object."""
    sums, counts = np.zeros((len(points), 3)), np.zeros(len(points))
    of_corners = np.repeat(slots, np.diff(starts, append=len(corners)))
    for slot, values in vectors.items():
        here = of_corners == slot
        np.add.at(sums, corners[here], values[here])
        np.add.at(counts, corners[here], 1)
    return points + sums / np.maximum(counts, 1)[:, None] @ np.linalg.pinv(matrix[:3, :3]).T


def sampled(pixels, uvs):
    """Returns the bilinear values at UVs."""
    size = len(pixels)
    at = np.clip(uvs * size - 0.5, 0, size - 1.001)
    x, y = at.astype(int).T
    u, v = (at - at.astype(int)).T[..., None]
    return ((1 - u) * (1 - v) * pixels[y, x] + u * (1 - v) * pixels[y, x + 1] +
            (1 - u) * v * pixels[y + 1, x] + u * v * pixels[y + 1, x + 1])
