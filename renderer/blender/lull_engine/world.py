"""The world as an image, whatever its nodes are."""
import math

import bpy

_SMALLEST, _LARGEST = 16, 4096  # pixels across: of a plain colour, and of any world
_USUAL = 1024
_SPP = 4  # over a pixel each, so that no light is lost between pixels


def write(scene, path, notes):
    """Renders the world with Cycles, as it is seen in all directions. Returns the image's path, None
    for a black world."""
    world = scene.world
    if world is None or _is_black(world):
        return None
    if world.use_nodes and any(link.to_socket.name == 'Volume' for link in world.node_tree.links
                               if link.to_node.type == 'OUTPUT_WORLD'):
        notes.say(f"the volume of world '{world.name}' is left out")
    if not world.cycles_visibility.camera:
        notes.say(f"the world '{world.name}' is seen by the camera")
    if world.use_nodes and any(n.type == 'LIGHT_PATH' for n in world.node_tree.nodes):
        notes.say(f"the world '{world.name}' lights the scene as the camera sees it, whatever its light paths say")
    room = bpy.data.scenes.new('lull world')
    room.world = world
    data = bpy.data.cameras.new('lull world')
    data.type = 'PANO'
    settings = data if hasattr(data, "panorama_type") else data.cycles  # from Blender 4; until then
    settings.panorama_type = 'EQUIRECTANGULAR'
    camera = bpy.data.objects.new('lull world', data)
    camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)
    room.collection.objects.link(camera)
    room.camera = camera
    width = _width(world)
    r, c = room.render, room.cycles
    r.engine = 'CYCLES'
    r.resolution_x, r.resolution_y, r.resolution_percentage = width, width // 2, 100
    r.image_settings.file_format, r.image_settings.color_depth = 'OPEN_EXR', '32'
    r.image_settings.exr_codec = 'ZIP'
    r.filepath, r.use_file_extension = path, False
    r.film_transparent = False
    world.cycles_visibility.camera = True
    c.samples, c.use_denoising, c.use_adaptive_sampling = _SPP, False, False
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
