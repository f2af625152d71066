"""Renders worlds with Cycles, in another Blender (see second.py). The sun's disc of a Sky Texture becomes a light: in an image of all
directions it would cover less than two pixels."""
import math
import os
import tempfile

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .rebuild import built
from .versions import panorama

_SPP, _FINE_SPP = 4, 64  # over a pixel each, so that no light is lost between pixels; with depth of field or the sun
_ACROSS = 128  # pixels of a photograph of the disc
_AROUND = 1.5  # of the disc's width, that is photographed


def write(what, frame, subframe):
    """Renders `what["light"]` as it lights the scene from all directions, and `what["backdrop"]` as the camera sees it, if they are
    described, to the files of their names. Returns the suns of the light's skies, which the image lacks."""
    room = _Room(what, frame, subframe)
    suns = []
    if what["backdrop"]:
        world = _made(what["backdrop"])
        camera = room.camera()
        is_fine = camera.data.dof.use_dof or _discs(world)
        room.render(world, camera, what["resolution"], what["backdrop"]["file"], _FINE_SPP if is_fine else _SPP, what["aspect"])
    if what["light"]:
        world = _made(what["light"])
        suns = _take_suns(world, room.pixels)
        room.render(world, _all_around(), (what["width"], what["width"] // 2), what["light"]["file"], _SPP)
    return suns


def _made(what):
    world = bpy.data.worlds.new(what["name"])
    world.use_nodes = True
    world.node_tree.nodes.clear()
    output = world.node_tree.nodes.new('ShaderNodeOutputWorld')
    for described, name in zip(what["nodes"], ('Surface', 'Volume')):
        if described:
            world.node_tree.links.new(built(world.node_tree, described), output.inputs[name])
    return world


def _all_around():
    data = bpy.data.cameras.new('lull world')
    data.type = 'PANO'
    panorama(data).panorama_type = 'EQUIRECTANGULAR'
    camera = bpy.data.objects.new('lull world', data)
    camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)
    return camera


class _Room:
    """Empty scenes at a frame."""

    def __init__(self, what, frame, subframe):
        self._what, self._frame, self._subframe = what, frame, subframe

    def camera(self):
        data = next(c for c in bpy.data.cameras if c.name_full == self._what["camera"])
        camera = bpy.data.objects.new('lull backdrop', data)
        focus = self._what["focus"]
        if focus is not None:
            data.dof.focus_object, data.dof.focus_distance = None, focus
        camera.matrix_world = Matrix(self._what["matrix"])
        return camera

    def pixels(self, world, camera, size):
        """Returns the R, G, B of a square photograph."""
        pixels = np.empty(size * size * 4, np.float32)
        with tempfile.TemporaryDirectory(prefix="lull-") as folder:
            path = os.path.join(folder, "sun.exr")
            self.render(world, camera, (size, size), path, _SPP)
            image = bpy.data.images.load(path)
            image.pixels.foreach_get(pixels)
            bpy.data.images.remove(image)
        return pixels.reshape(size, size, 4)[:, :, :3].astype(float)

    def render(self, world, camera, resolution, path, spp, aspect=(1, 1)):
        scene = bpy.data.scenes.new('lull room')
        scene.frame_set(self._frame, subframe=self._subframe)
        scene.collection.objects.link(camera)
        scene.camera, scene.world = camera, world
        r, c = scene.render, scene.cycles
        r.resolution_x, r.resolution_y, r.resolution_percentage = *resolution, 100
        r.pixel_aspect_x, r.pixel_aspect_y = aspect
        r.engine = 'CYCLES'
        r.image_settings.file_format, r.image_settings.color_depth = 'OPEN_EXR', '32'
        r.image_settings.exr_codec = 'ZIP'
        r.filepath, r.use_file_extension = path, False
        r.film_transparent = False
        c.device, c.samples, c.use_denoising, c.use_adaptive_sampling = 'CPU', spp, False, False
        c.pixel_filter_type, c.filter_width = 'BOX', 1
        bpy.ops.render.render(write_still=True, scene=scene.name)
        bpy.data.scenes.remove(scene)


def _take_suns(world, photograph):
    """Removes the discs of the suns from the nodes of a world. `photograph(world, camera, size)` returns the pixels of a world as a
    camera sees it.

    Returns: the energy, colour, angle and matrix of each, for Lights.
    """
    found = []
    for node in _discs(world):
        vector = node.inputs.get('Vector')  # until 3.6
        if vector is not None and vector.links:  # which may turn or repeat it
            continue
        camera, toward = _aimed(node)
        with_disc = photograph(world, camera, _ACROSS)
        node.sun_disc = False
        disc = with_disc - photograph(world, camera, _ACROSS)
        if disc.max() > 0:
            found.append(_sun(node, disc, camera, toward))
    return found


def _discs(world):
    """Returns the nodes of skies with the sun."""
    return [n for n in (world.node_tree.nodes if world.use_nodes else ())
            if n.type == 'TEX_SKY' and n.sky_type == 'NISHITA' and n.sun_disc and n.outputs[0].links]


def _aimed(node):
    """Returns a camera that has the disc in the middle, and its axes, of which the last points away from the sun."""
    height, turn = node.sun_elevation, node.sun_rotation
    away = -Vector((math.cos(height) * math.sin(turn), math.cos(height) * math.cos(turn), math.sin(height)))
    camera = bpy.data.objects.new('lull sun', bpy.data.cameras.new('lull sun'))
    camera.data.angle = _AROUND * node.sun_size
    axes = away.to_track_quat('Z', 'Y').to_matrix()
    camera.matrix_world = axes.to_4x4()
    return camera, axes


def _sun(node, disc, camera, axes):
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
            "matrix": [list(row) for row in middle.to_track_quat('Z', 'Y').to_matrix().to_4x4()]}
