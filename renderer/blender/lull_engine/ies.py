"""Reads photometric profiles of lamps (IESNA LM-63, type C), and paints them as images of all directions."""
import math
import re

import bpy
import numpy as np

from .versions import IS_PROFILE_OPEN

# By which Cycles makes the strength of a lamp of candela: 4 pi over 177.83 lm/W.
_STRENGTH_PER_CANDELA = 4 * math.pi / 177.83
_ROWS = 720


class Unreadable(Exception):
    """A profile that is no LM-63 file of type C."""


def parse(text):
    """Returns vertical angles, horizontal angles that end at 360, in degrees, and the candela at (horizontal, vertical)."""
    head = re.search(r"^TILT *= *(\S+)[^\n]*\n", text, re.M)
    if head is None or head.group(1).upper() != "NONE":
        raise Unreadable
    try:
        numbers = [float(n) for n in re.split(r"[\s,]+", text[head.end():].strip())]
        rows, columns, kind = (int(n) for n in numbers[3:6])
        scale = numbers[2] * numbers[10] * numbers[11]
        vertical, rest = np.array(numbers[13:13 + rows]), numbers[13 + rows:]
        horizontal = np.array(rest[:columns])
        candela = np.array(rest[columns:columns + rows * columns]).reshape(columns, rows) * scale
    except (ValueError, IndexError, OverflowError) as e:
        raise Unreadable from e
    if kind != 1 or rows < 2 or columns < 1 or not np.isfinite(candela).all() or (np.diff(vertical) <= 0).any() \
            or (np.diff(horizontal) <= 0).any():
        raise Unreadable
    return vertical, *_all_around(horizontal - horizontal[0], candela)


def _all_around(horizontal, candela):
    """Completes a quarter or a half of the horizontal angles by its mirror image, and a single one to all."""
    if len(horizontal) == 1:
        return np.array([0., 360]), np.concatenate([candela, candela])
    while horizontal[-1] in (90, 180):
        horizontal = np.concatenate([horizontal, 2 * horizontal[-1] - horizontal[-2::-1]])
        candela = np.concatenate([candela, candela[-2::-1]])
    if horizontal[-1] != 360:
        raise Unreadable
    return horizontal, candela


def _between(angles, wanted):
    """Returns for each wanted angle the number of that below it, and how far on it is to the next."""
    below = np.clip(np.searchsorted(angles, wanted, 'right') - 1, 0, len(angles) - 2)
    return below, (wanted - angles[below]) / (angles[below + 1] - angles[below])


def _catmull_rom(a, b, c, d, x):
    return b + x / 2 * (c - a + x * (2 * a - 5 * b + 4 * c - d + x * (3 * (b - c) + d - a)))


def strengths(text):
    """Returns the strength of Cycles' lamp by direction: rows from its -z axis to z, columns from x by y. The candela are
    interpolated by cubics, as there."""
    vertical, horizontal, candela = parse(text)
    down = (np.arange(_ROWS) + .5) * 180 / _ROWS
    columns = 2 if len(horizontal) == 2 and not IS_PROFILE_OPEN else 2 * _ROWS
    around = (np.arange(columns) + .5) * 360 / columns
    turned = (270 - around) % 360  # the profile begins at -y, and turns to -x
    row, x = _between(vertical, down)
    last = len(vertical) - 1
    rows = [candela[:, np.where(row == 0, 1, row - 1)], candela[:, row], candela[:, row + 1],
            np.where(IS_PROFILE_OPEN & (row + 2 > last), 0, candela[:, np.minimum(row + 2, last)])]
    by_row = np.where((vertical[0] <= down) & (down <= vertical[-1]), _catmull_rom(*rows, x), 0)
    column, x = _between(horizontal, turned)
    last = len(horizontal) - 1  # the same as the first
    before, behind = by_row[np.where(column == 0, last - 1, column - 1)], by_row[np.where(column + 2 > last, 1, column + 2)]
    if IS_PROFILE_OPEN:
        before[column == 0] = behind[column + 2 > last] = 0
    made = _catmull_rom(before, by_row[column], by_row[column + 1], behind, x[:, None])
    return np.maximum(made.T, 0) * _STRENGTH_PER_CANDELA


def text_of(node):
    """Returns the file of an IES node."""
    if node.mode == 'INTERNAL':
        if node.ies is None:
            raise Unreadable
        return node.ies.as_string()
    try:
        with open(bpy.path.abspath(node.filepath), encoding="latin-1") as f:
            return f.read()
    except OSError as e:
        raise Unreadable from e
