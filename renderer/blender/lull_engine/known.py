"""Values of parameters that glTF has without a bake: images over UVs, perhaps moved or multiplied, and colours of meshes."""
import math

from . import values
from .strands import STRANDS

_COLOURS = 'Base Color', 'Radiance'


def is_known(name, value, pictures):
    """Returns whether glTF has an image, or the colours of a mesh, as a parameter. `pictures` is an images.Images."""
    if name in _COLOURS:
        if value.node.type == 'VERTEX_COLOR':
            return name == 'Base Color' and value.name == 'Color'
        node, factor = tinted(value)
        if node is not value.node:
            if name == 'Base Color' and max(factor) > 1:
                return False
            value = next(i.source for i in value.node.inputs if i.source is not None)
    is_number = name in ('Metallic', 'Roughness')
    if is_number and value.node.type in ('SEPRGB', 'SEPARATE_COLOR') and getattr(value.node, "mode", 'RGB') == 'RGB':
        value, is_number = value.node.inputs[0].source, False
        if value is None:
            return False
    node = value.node
    if node.type != 'TEX_IMAGE' or name not in (*_COLOURS, 'Metallic', 'Roughness', 'Alpha', 'Normal') or not _is_plain(node) or \
            node.image.is_float or (name == 'Alpha') != (value.name == 'Alpha') or not _is_known_place(node.inputs['Vector']):
        return False
    space = node.image.colorspace_settings
    is_encoded = space.name == 'sRGB' if name in _COLOURS else space.is_data
    return name == 'Alpha' or is_encoded and not (is_number and not pictures.is_grey(node.image))


def is_known_normal(value, pictures):
    node = value.node
    if node.type != 'NORMAL_MAP' or node.space != 'TANGENT' or node.inputs['Strength'].source is not None:
        return False
    source = node.inputs['Color'].source
    return source is not None and source.node.type == 'TEX_IMAGE' and is_known('Normal', source, pictures)


def tinted(value):
    """Returns the node of an image that a value is, perhaps times a colour, and that colour; else the node of the value and white."""
    node = value.node
    if node.type in ('MIX', 'MIX_RGB') and node.blend_type == 'MULTIPLY' and (node.type == 'MIX_RGB' or node.data_type == 'RGBA'):
        first, *sides = (node.inputs[i] for i in ((0, 6, 7) if node.type == 'MIX' else (0, 1, 2)))
        linked = [s.source.node for s in sides if s.source is not None]
        if first.source is None and abs(first.default_value - 1) < 1e-6 and len(linked) == 1 and linked[0].type == 'TEX_IMAGE':
            factor = next(tuple(s.default_value)[:3] for s in sides if s.source is None)
            if min(factor) >= 0:
                return linked[0], factor
    return node, (1, 1, 1)


def _is_plain(node):
    """Returns whether glTF's samplers read an image as its node does."""
    return (node.image is not None and node.image.size[0] > 0 and node.projection == 'FLAT' and not values.has_own_mapping(node) and
            node.extension in ('REPEAT', 'EXTEND') and node.image.source in ('FILE', 'GENERATED'))


def _is_known_place(socket):
    """Returns whether an image has UVs, moved by one Mapping at most."""
    source = socket.source
    if source is not None and source.node.type == 'MAPPING' and _is_known_mapping(source.node):
        source = source.node.inputs['Vector'].source
        if source is None:  # all of it the same
            return False
    return source is None or not (source.node.type == 'TEX_COORD' and source.node.from_instancer) and (
        source.node.type == 'UVMAP' and source.node.uv_map != STRANDS or source.node.type == 'TEX_COORD' and source.name == 'UV')


def _is_known_mapping(node):
    turn, scale = node.inputs['Rotation'].default_value, node.inputs['Scale'].default_value
    # Of a texture that is moved, glTF has no scale after the rotation.
    is_known = node.vector_type == 'POINT' or node.vector_type == 'TEXTURE' and (turn[2] == 0 or scale[0] == scale[1]) and min(
        map(abs, scale[:2])) > 1e-5
    return is_known and abs(turn[0]) + abs(turn[1]) < 1e-6 and not any(i.source is not None for i in node.inputs[1:])


def moved(node):
    """Returns the KHR_texture_transform of a Mapping."""
    (x, y), turn, (width, height) = (node.inputs['Location'].default_value[:2], node.inputs['Rotation'].default_value[2],
                                     node.inputs['Scale'].default_value[:2])
    if node.vector_type == 'TEXTURE':
        turn, width, height = -turn, 1 / width, 1 / height
        x, y = -(math.cos(turn) * x - math.sin(turn) * y) * width, -(math.sin(turn) * x + math.cos(turn) * y) * height
    return {"offset": [x - height * math.sin(turn), 1 - y - height * math.cos(turn)], "rotation": turn, "scale": [width, height]}
