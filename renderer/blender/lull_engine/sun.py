"""The sun's disc of a Sky Texture as a light: in an image of all directions it would cover less than two pixels."""
import math

import bpy
import numpy as np
from mathutils import Vector

_ACROSS = 128  # pixels of a photograph of the disc
_AROUND = 1.5  # of the disc's width, that is photographed


def take(world, photograph):
    """Removes the discs of the suns from the nodes of a world. `photograph(world, camera, size)` returns the pixels of a world as a
    camera sees it.

    Returns: what Lights need: their energy, colour, angle and direction.
    """
    found = []
    for node in discs(world):
        vector = node.inputs.get('Vector')  # until 3.6
        if vector is not None and vector.links:  # which may turn or repeat it
            continue
        camera, toward = _aim(node)
        with_disc = photograph(world, camera, _ACROSS)
        node.sun_disc = False
        disc = with_disc - photograph(world, camera, _ACROSS)
        if disc.max() > 0:
            found.append(_light(node, disc, camera, toward))
    return found


def discs(world):
    """Returns the nodes of skies with the sun."""
    return [n for n in (world.node_tree.nodes if world.use_nodes else ())
            if n.type == 'TEX_SKY' and n.sky_type == 'NISHITA' and n.sun_disc and n.outputs[0].links]


def _aim(node):
    """Returns a camera that has the disc in the middle, and its axes, of which the last points away from the sun."""
    height, turn = node.sun_elevation, node.sun_rotation
    away = -Vector((math.cos(height) * math.sin(turn), math.cos(height) * math.cos(turn), math.sin(height)))
    camera = bpy.data.objects.new('lull sun', bpy.data.cameras.new('lull sun'))
    camera.data.angle = _AROUND * node.sun_size
    axes = away.to_track_quat('Z', 'Y').to_matrix()
    camera.matrix_world = axes.to_4x4()
    return camera, axes


def _light(node, disc, camera, axes):
    """Returns the disc's irradiance and direction, also where the horizon cuts it."""
    half = math.tan(camera.data.angle / 2)
    at = ((np.arange(_ACROSS) + 0.5) / _ACROSS * 2 - 1) * half
    x, y = np.meshgrid(at, at)
    solid_angles = (2 * half / _ACROSS) ** 2 / (1 + x * x + y * y) ** 1.5
    irradiance = (disc * solid_angles[..., None]).sum((0, 1))
    weights = disc.sum(2) * solid_angles / (disc.sum(2) * solid_angles).sum()
    middle = axes @ Vector(((x * weights).sum(), (y * weights).sum(), -1))
    angle = min(node.sun_size, 2 * math.sqrt(solid_angles[disc.sum(2) > 0].sum() / math.pi))
    return {"energy": float(irradiance.max()), "color": [float(c) for c in irradiance / irradiance.max()], "angle": float(angle),
            "matrix": [v for row in middle.to_track_quat('Z', 'Y').to_matrix().to_4x4() for v in row]}
