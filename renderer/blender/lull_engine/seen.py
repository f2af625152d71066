"""What nodes ask of the camera, as nodes of our own that make it of the place: in Cycles, too, it is the same for all rays."""
from .nodes import Made


def replaced(node, name, view):
    """Returns another output for one of this name that depends on the camera; see nodes.Tree. `view` is a camera.View."""
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


def _math(operation, a, b):
    return Made('Math', 'MATH', a, b, operation=operation).output()


def _vector(*parts):
    return Made('CombineXYZ', 'COMBXYZ', *parts).output(0, 'VECTOR')


def _vectors(operation, *values):
    is_number = operation in ('LENGTH', 'DOT_PRODUCT')
    return Made('VectorMath', 'VECT_MATH', *values, operation=operation).output(int(is_number), 'VALUE' if is_number else 'VECTOR')


def _turned(vector, view, is_point):
    """Returns the three coordinates along the axes of the camera, the last one forwards."""
    rows = view.matrix.normalized().inverted()
    return [_math('ADD', _vectors('DOT_PRODUCT', vector, tuple(sign * v for v in row[:3])), sign * row[3] * is_point)
            for sign, row in zip((1, 1, -1), rows)]


def _in_frame(at, view):
    """Returns where in the picture, from its lower left corner to its upper right one."""
    apart = [a if view.data.type == 'ORTHO' else _math('DIVIDE', a, at[2]) for a in at[:2]]
    return _vector(*(_math('ADD', _math('DIVIDE', a, size), 0.5 - shift)
                     for a, size, shift in zip(apart, view.extent(), view.shift())), 0.)
