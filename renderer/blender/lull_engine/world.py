"""The world as an image, whatever its nodes are."""
import math
import os
import tempfile

import bpy
import numpy as np

import groups
import scenes
import sun
import surfaces
from versions import panorama

_RAYS = "diffuse", "glossy", "transmission"
_SMALLEST, _LARGEST = 16, 4096  # pixels across: of a plain colour, and of any world
_USUAL = 1024
_SPP, _FINE_SPP = 4, 64  # over a pixel each, so that no light is lost between pixels; with depth of field or the sun


def write(scene, layer, camera, base, is_sharp, notes):
    """Renders the world with Cycles, as it lights the scene of a view layer from all directions, to BASE.world.exr.

    Returns: that path, None for a black world; BASE.backdrop.exr, where the camera sees another world, or one that `is_sharp`
    wants finer than all directions, else None; and the suns of its skies, lights and their matrices, which the image lacks.
    """
    world = scene.world
    if world is None or _is_black(world) or not layer.use_sky:
        return None, None, []
    if world.use_nodes and any(link.to_socket.name == 'Volume' for link in world.node_tree.links
                               if link.to_node.type == 'OUTPUT_WORLD'):
        notes.say(f"the volume of world '{world.name}' is left out")
    light = world.copy()
    if light.use_nodes:
        groups.inline(light.node_tree)
    asks = light.use_nodes and _answer_rays(light, notes)
    unseen = [name for name in _RAYS if not getattr(world.cycles_visibility, name)]
    lights = len(unseen) < len(_RAYS)
    if unseen and lights:
        notes.say(f"the world '{world.name}' lights all rays but those of the camera, whatever its visibility")
    if world.cycles.max_bounces < 12 and lights:
        notes.say(f"the world '{world.name}' lights after any number of bounces")
    backdrop = None
    is_sharp = is_sharp and world.use_nodes and not _background(world)
    if not scene.render.film_transparent and (asks or not lights or not world.cycles_visibility.camera or is_sharp):
        backdrop = _photograph(scene, world, camera, base + ".backdrop.exr")
    if not lights:
        return None, backdrop, []
    if _is_of_a_picture(light):
        notes.say(f"the world '{world.name}' lights by coordinates of another camera")
    light.cycles_visibility.camera = True
    suns = sun.take(light, lambda seen, size: _pixels(scene, light, seen, size), notes)
    return _surround(scene, light, base + ".world.exr"), backdrop, suns


def _answer_rays(world, notes):
    """Lets nodes that ask for the kind of a ray know that of diffuse light. Returns whether there are any."""
    tree = world.node_tree
    askers = [n for n in tree.nodes if n.type == 'LIGHT_PATH']
    for node in askers:
        for output in node.outputs:
            if not output.links:
                continue
            if output.name not in ('Is Camera Ray', 'Is Diffuse Ray'):
                notes.say(f"the world '{world.name}' lights mirrors and glass as it lights diffuse surfaces")
            answer = tree.nodes.new('ShaderNodeValue').outputs[0]
            answer.default_value = 1 if output.name in ('Is Diffuse Ray', 'Is Reflection Ray', 'Ray Depth', 'Diffuse Depth') else 0
            for link in list(output.links):
                tree.links.new(answer, link.to_socket)
    for mix in [n for n in tree.nodes if n.type == 'MIX_SHADER']:  # what other rays see is no part of the light
        answer = mix.inputs[0].links[0].from_node if mix.inputs[0].links else None
        if answer is not None and answer.type == 'VALUE' and answer.outputs[0].default_value in (0, 1):
            seen = mix.inputs[1 + int(answer.outputs[0].default_value)]
            if seen.links:
                groups.replace(tree, mix.outputs[0], seen)
    return bool(askers)


def _is_of_a_picture(world):
    """Returns whether the light of a world depends on the camera's picture."""
    output = world.node_tree.get_output_node('CYCLES') if world.use_nodes else None
    nodes = surfaces.upstream(output.inputs['Surface'].links[0].from_socket) if output and output.inputs['Surface'].links else ()
    return any(n.type == 'TEX_COORD' and (n.outputs['Window'].links or n.outputs['Camera'].links) for n in nodes)


def _photograph(scene, world, camera, path):
    """Renders the world alone, as the background of a camera."""
    room = scenes.made_at('lull backdrop', scene)
    room.camera = camera.copy()
    room.collection.objects.link(room.camera)
    for name in "resolution_x", "resolution_y", "resolution_percentage", "pixel_aspect_x", "pixel_aspect_y":
        setattr(room.render, name, getattr(scene.render, name))
    return _render(room, world, path, _FINE_SPP if room.camera.data.dof.use_dof or sun.discs(world) else _SPP)


def _pixels(scene, world, camera, size):
    """Returns the R, G, B of a square photograph."""
    room = scenes.made_at('lull sun', scene)
    room.camera = camera
    room.collection.objects.link(camera)
    room.render.resolution_x = room.render.resolution_y = size
    pixels = np.empty(size * size * 4, np.float32)
    with tempfile.TemporaryDirectory(prefix="lull-") as folder:
        image = bpy.data.images.load(_render(room, world, os.path.join(folder, "sun.exr"), _SPP))
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
    return pixels.reshape(size, size, 4)[:, :, :3].astype(float)


def _surround(scene, world, path):
    room = scenes.made_at('lull world', scene)
    data = bpy.data.cameras.new('lull world')
    data.type = 'PANO'
    panorama(data).panorama_type = 'EQUIRECTANGULAR'
    camera = bpy.data.objects.new('lull world', data)
    camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)
    room.collection.objects.link(camera)
    room.camera = camera
    width = _width(world)
    r = room.render
    r.resolution_x, r.resolution_y, r.resolution_percentage = width, width // 2, 100
    return _render(room, world, path, _SPP)


def _render(room, world, path, spp):
    room.world = world
    r, c = room.render, room.cycles
    r.engine = 'CYCLES'
    r.image_settings.file_format, r.image_settings.color_depth = 'OPEN_EXR', '32'
    r.image_settings.exr_codec = 'ZIP'
    r.filepath, r.use_file_extension = path, False
    r.film_transparent = False
    c.samples, c.use_denoising, c.use_adaptive_sampling = spp, False, False
    c.pixel_filter_type, c.filter_width = 'BOX', 1
    bpy.ops.render.render(write_still=True, scene=room.name)
    bpy.data.scenes.remove(room)
    return path


def _background(world):
    """Returns the only node of a plain world, and None for others."""
    nodes = [n for n in world.node_tree.nodes if n.type != 'OUTPUT_WORLD']
    plain = len(nodes) == 1 and nodes[0].type == 'BACKGROUND'
    return nodes[0] if plain else None


def _is_black(world):
    if not world.use_nodes:
        return max(world.color) == 0
    node = _background(world)
    if node is None:
        return False
    return max(node.inputs['Color'].default_value[:3]) * node.inputs['Strength'].default_value == 0


def _width(world):
    if not world.use_nodes or _background(world):
        return _SMALLEST
    widths = [n.image.size[0] for n in world.node_tree.nodes
              if n.type == 'TEX_ENVIRONMENT' and n.image]
    # Twice as fine as images, which may be turned.
    return min(_LARGEST, max(2 * max(widths), _SMALLEST)) if widths else _USUAL
