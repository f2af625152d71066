"""Tells bodies that have an inside worth seeing from sheets and slabs."""
import numpy as np

LEAST_WIDTHS = 20  # of the thickness, that a slab has both ways


def has_solid(o, slot):
    """Returns whether the faces of a material slot form a closed body, other than a slab."""
    mesh = o.data
    points = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3) @ np.array(o.matrix_world.to_3x3()).T
    faces = [p for p in mesh.polygons if p.material_index == slot]
    return any(is_closed(part) and not _is_flat(points, part) for part in _parts(faces))


def is_closed(faces):
    counts = {}
    for face in faces:
        for key in face.edge_keys:
            counts[key] = counts.get(key, 0) + 1
    return all(n == 2 for n in counts.values())


def _parts(faces):
    """Returns the lists of faces that vertices connect."""
    above = {}

    def root(vertex):
        while above.setdefault(vertex, vertex) != vertex:
            above[vertex] = above[above[vertex]]
            vertex = above[vertex]
        return vertex

    for face in faces:
        first, *others = face.vertices
        for vertex in others:
            above[root(vertex)] = root(first)
    parts = {}
    for face in faces:
        parts.setdefault(root(face.vertices[0]), []).append(face)
    return parts.values()


def _is_flat(points, faces):
    part = points[sorted({v for face in faces for v in face.vertices})]
    part = part - part.mean(0)
    sides = np.sort(np.ptp(part @ np.linalg.eigh(part.T @ part)[1], axis=0))
    return sides[1] >= LEAST_WIDTHS * sides[0]
