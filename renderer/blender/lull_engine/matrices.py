"""Matrices as lists of numbers, as properties of objects are."""
from mathutils import Matrix


def packed(*matrices):
    return [v for matrix in matrices for row in matrix for v in row]


def unpacked(values):
    """Returns the matrices of a list."""
    return [Matrix([values[i:i + 4] for i in range(first, first + 16, 4)]) for first in range(0, len(values), 16)]
