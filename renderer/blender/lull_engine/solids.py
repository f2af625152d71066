"""Tells bodies that have an inside worth seeing from sheets and slabs."""
import numpy as np

LEAST_WIDTHS = 20  # of the thickness, that a slab has both ways


def has_solid(mesh, matrix, slots):
    """Returns whether the faces of material slots form a closed body, other than a slab."""
    points = mesh.points @ np.array(matrix.to_3x3()).T
    faces = [mesh.face_corners(i) for i in np.flatnonzero(np.isin(mesh.slots, slots))]
    return any(is_closed(part) and not _is_flat(points, part) for part in _parts(faces))


def is_closed(faces):
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
    return sides[1] >= LEAST_WIDTHS * sides[0]
