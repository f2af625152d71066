"""Values of surfaces' parameters: numbers, colours as three numbers, and outputs of nodes. Operations on outputs make nodes of our own."""
from .nodes import Made, computed, is_output, upstream
from .strands import STRANDS

# Nodes that depend on the direction from which a surface is seen, or on the kind of ray.
_BY_VIEW = {'FRESNEL', 'LAYER_WEIGHT', 'LIGHT_PATH', 'CAMERA', 'LIGHT_FALLOFF', 'TEX_IES'}
_OUTPUTS_BY_VIEW = {'NEW_GEOMETRY': {'Backfacing', 'Incoming'}, 'TEX_COORD': {'Camera', 'Window', 'Reflection'}}
_BY_OBJECT = {'OBJECT_INFO', 'ATTRIBUTE'}  # the latter of objects alone
_BY_PLACE = {'NEW_GEOMETRY', 'OBJECT_INFO', 'PARTICLE_INFO', 'HAIR_INFO', 'POINT_INFO', 'TANGENT', 'AMBIENT_OCCLUSION', 'BEVEL',
             'WIREFRAME', 'VERTEX_COLOR', 'ATTRIBUTE', 'TEX_NOISE', 'TEX_MUSGRAVE', 'TEX_VORONOI', 'TEX_WAVE', 'TEX_MAGIC',
             'TEX_CHECKER', 'TEX_BRICK', 'TEX_GRADIENT', 'TEX_WHITE_NOISE', 'TEX_ENVIRONMENT', 'TEX_SKY', 'TEX_POINTDENSITY',
             'TEX_GABOR', 'BUMP', 'NORMAL', 'NORMAL_MAP', 'VECT_TRANSFORM', 'SCRIPT'}


def triple(value):
    return value if isinstance(value, tuple) else (value, value, value)


def _blend(kind, factor, a, b):
    values = (v if is_output(v) else (*triple(v), 1.0) for v in (a, b))
    return Made('MixRGB', 'MIX_RGB', factor, *values, blend_type=kind).output(0, 'RGBA')


def _operate(kind, plain, a, b):
    if is_output(a) or is_output(b):
        return _blend(kind, 1.0, a, b)
    if isinstance(a, tuple) or isinstance(b, tuple):
        return tuple(plain(x, y) for x, y in zip(triple(a), triple(b)))
    return plain(a, b)


def times(a, b):
    if not is_output(a) and triple(a) == (1, 1, 1):
        return b
    if not is_output(b) and triple(b) == (1, 1, 1):
        return a
    if not is_output(a) and not any(triple(a)):
        return a
    return _operate('MULTIPLY', lambda x, y: x * y, a, b)


def plus(a, b):
    for one, other in (a, b), (b, a):
        if not is_output(one) and not any(triple(one)):
            return other
    return _operate('ADD', lambda x, y: x + y, a, b)


def minus(factor):
    """Returns 1 less a factor."""
    return _operate('SUBTRACT', lambda x, y: x - y, 1, factor)


def mix(factor, a, b):
    is_plain = not is_output(a) and not is_output(b)
    if a is b or is_plain and max(abs(x - y) for x, y in zip(triple(a), triple(b))) < 1e-6:  # in single precision
        return a
    if any(is_output(v) for v in (factor, a, b)):
        return _blend('MIX', factor, a, b)
    mixed = tuple(x + factor * (y - x) for x, y in zip(triple(a), triple(b)))
    return mixed if isinstance(a, tuple) else mixed[0]


def clamped(factor):
    """Returns a factor as a Mix Shader has it: a number from 0 to 1."""
    if not is_output(factor):
        return min(max(factor, 0), 1)
    if factor.node.type in ('TEX_IMAGE', 'FRESNEL', 'LAYER_WEIGHT', 'LIGHT_PATH', 'NEW_GEOMETRY'):
        return factor
    return Made('Clamp', 'CLAMP', factor, 0.0, 1.0).output()


def number(value):
    """Returns the number that nodes make of an output of a colour or vector."""
    return computed('ADD', value, 0.0)


def strand(node, name):
    """Replaces an output that depends on the strand by its UV map; see nodes.Tree."""
    if node.type != 'HAIR_INFO' or name not in ('Is Strand', 'Intercept', 'Random'):
        return None
    parts = Made('SeparateXYZ', 'SEPXYZ', Made('UVMap', 'UVMAP', uv_map=STRANDS).output(0, 'VECTOR'))
    if name == 'Is Strand':
        return computed('GREATER_THAN', parts.output(0), 0.0)
    return parts.output(1 if name == 'Intercept' else 0)


def of_camera(node, name, view):
    """Replaces an output that depends on the camera (camera.View) by nodes of the place; see nodes.Tree. In Cycles, too, it is the same for
    all rays."""
    if node.type == 'TEX_COORD' and name in ('Camera', 'Window') or node.type == 'CAMERA':
        at = _turned(Made('NewGeometry', 'NEW_GEOMETRY').output(0, 'VECTOR', "Position"), view, 1)
        if name == 'Window':
            return _in_frame(at, view)
        if name == 'View Z Depth':
            return at[2]
        made = _vector(*at)
        if node.type == 'TEX_COORD':
            return made
        return _vectors('NORMALIZE' if name == 'View Vector' else 'LENGTH', made)
    if node.type == 'VECT_TRANSFORM' and node.convert_to == 'CAMERA' != node.convert_from:
        source = node.inputs[0].source or node.inputs[0].default_value
        in_world = Made('VectorTransform', 'VECT_TRANSFORM', source, vector_type=node.vector_type, convert_from=node.convert_from,
                        convert_to='WORLD').output(0, 'VECTOR')
        made = _vector(*_turned(in_world, view, node.vector_type == 'POINT'))
        return _vectors('NORMALIZE', made) if node.vector_type == 'NORMAL' else made
    return None


def _vector(*parts):
    return Made('CombineXYZ', 'COMBXYZ', *parts).output(0, 'VECTOR')


def _vectors(operation, *values):
    is_number = operation in ('LENGTH', 'DOT_PRODUCT')
    return Made('VectorMath', 'VECT_MATH', *values, operation=operation).output(int(is_number), 'VALUE' if is_number else 'VECTOR')


def _turned(vector, view, is_point):
    """Returns the three coordinates along the axes of the camera, the last one forwards."""
    rows = view.matrix.normalized().inverted()
    return [computed('ADD', _vectors('DOT_PRODUCT', vector, tuple(sign * v for v in row[:3])), sign * row[3] * is_point)
            for sign, row in zip((1, 1, -1), rows)]


def _in_frame(at, view):
    """Returns where in the picture, from its lower left corner to its upper right one."""
    apart = [a if view.data.type == 'ORTHO' else computed('DIVIDE', a, at[2]) for a in at[:2]]
    return _vector(*(computed('ADD', computed('DIVIDE', a, size), 0.5 - shift)
                     for a, size, shift in zip(apart, view.extent(), view.shift())), 0.)


def is_even(output):
    """Returns whether an output is the same everywhere, from all sides and for all rays."""
    return not is_by_view(output) and place_of(output) == 'all'


def is_by_view(output):
    """Returns whether an output depends on the direction from which a surface is seen, or on the kind of ray."""
    return any(n.type in _BY_VIEW or used & _OUTPUTS_BY_VIEW.get(n.type, set()) or
               n.type == 'VECT_TRANSFORM' and 'CAMERA' in (n.convert_from, n.convert_to) for n, used in upstream(output).items())


def place_of(output):
    """Returns 'all' for a value that is the same everywhere, 'object' for one of each object, 'uv' for images over UVs, which repeat,
    else 'mesh'."""
    nodes, place = upstream(output), 'all'
    if all(n.type not in _BY_PLACE | {'TEX_COORD', 'TEX_IMAGE', 'UVMAP'} or n.type in _BY_OBJECT and
                            getattr(n, "attribute_type", 'OBJECT') == 'OBJECT' for n in nodes):
        return 'object' if any(n.type in _BY_OBJECT for n in nodes) else 'all'
    for node, used in nodes.items():
        if node.type in _BY_PLACE or node.type == 'TEX_COORD' and (used != {'UV'} or node.from_instancer):
            return 'mesh'
        if node.type == 'TEX_IMAGE':
            if node.projection != 'FLAT' or node.extension != 'REPEAT' or node.image and node.image.source == 'TILED' or \
                    has_own_mapping(node):
                return 'mesh'
            place = 'uv'
        if node.type == 'MAPPING' and _moves(node):
            return 'mesh'
        if node.type in ('UVMAP', 'TEX_COORD'):
            place = 'uv'
    is_bare = any(n.type == 'TEX_COORD' or n.type == 'UVMAP' and n.uv_map != STRANDS for n in _above_images(output))
    return 'mesh' if is_bare else place


def _moves(node):
    """Returns whether a Mapping makes an image repeat otherwise than UVs do."""
    scale, turn = node.inputs.get('Scale'), node.inputs['Rotation']
    return bool(scale.source or turn.source or max(abs(v) for v in turn.default_value) > 1e-6 or
                not all(abs(v - round(v)) < 1e-6 for v in scale.default_value[:2]))


def _above_images(output):
    """Yields the nodes on which a value depends, without the nodes that place images."""
    seen, todo = set(), [output.node]
    while todo:
        node = todo.pop()
        if node in seen:
            continue
        seen.add(node)
        yield node
        if node.type != 'TEX_IMAGE':
            todo += [i.source.node for i in node.inputs if i.source is not None]


def layers_of(output):
    """Returns the names of the UV maps that an output depends on; "" is that of the render."""
    nodes = upstream(output)
    return {n.uv_map for n in nodes if n.type == 'UVMAP'} | {
        "" for n in nodes if n.type == 'TEX_COORD' or n.type == 'TEX_IMAGE' and n.inputs['Vector'].source is None}


def has_own_mapping(node):
    """Returns whether the node of a texture has a mapping of its own, as files of old versions have."""
    own = node.texture_mapping
    return (own.mapping, own.mapping_x, own.mapping_y, own.mapping_z) != ('FLAT', 'X', 'Y', 'Z') or own.use_min or own.use_max or \
        any(tuple(v) != (plain,) * 3 for v, plain in ((own.translation, 0), (own.rotation, 0), (own.scale, 1)))
