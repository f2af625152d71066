"""UV maps that materials ask for and meshes lack."""
import numpy as np

import groups

STRANDS = "lull strand"  # U: a random number, V: the way along a strand; 0, 0 on other surfaces
_OF_THE_RENDER = ""


def complete(mesh):
    """Adds the UV maps that a flattened mesh lacks: attributes of the name, else zeros, as in Cycles. glTF would read other maps."""
    for name in sorted({n for m in mesh.materials if m and m.use_nodes for n in _asked_for(m.node_tree)}):
        if name in mesh.uv_layers or name == _OF_THE_RENDER and mesh.uv_layers:
            continue
        values = _of_attribute(mesh, name)
        if values is not None:
            mesh.attributes.remove(mesh.attributes[name])
        layer = mesh.uv_layers.new(name=name or "UVMap")
        if layer is None:  # there are eight
            return
        layer.data.foreach_set("uv", np.zeros(2 * len(mesh.loops)) if values is None else values.ravel())


def _asked_for(tree):
    """Yields names of UV maps."""
    for node in tree.nodes:
        if node.type == 'GROUP' and node.node_tree:
            yield from _asked_for(node.node_tree)
        elif node.type in ('UVMAP', 'NORMAL_MAP'):
            yield node.uv_map
        elif node.type == 'HAIR_INFO':
            yield STRANDS
        elif node.type == 'TEX_COORD' and node.outputs['UV'].links or node.type == 'TEX_IMAGE' and not node.inputs['Vector'].links:
            yield _OF_THE_RENDER


def asks_strands(material):
    return material is not None and material.use_nodes and STRANDS in _asked_for(material.node_tree)


def tell_strands(tree):
    """Replaces the nodes of a material that ask for the strand. Returns whether they ask for more than is known."""
    is_lacking = False
    for node in [n for n in tree.nodes if n.type == 'HAIR_INFO']:
        place, parts, found = (tree.nodes.new('ShaderNode' + k) for k in ('UVMap', 'SeparateXYZ', 'Math'))
        place.uv_map, found.operation = STRANDS, 'GREATER_THAN'
        found.inputs[1].default_value = 0
        tree.links.new(place.outputs[0], parts.inputs[0])
        tree.links.new(parts.outputs['X'], found.inputs[0])
        known = {'Is Strand': found.outputs[0], 'Intercept': parts.outputs['Y'], 'Random': parts.outputs['X']}
        for output in node.outputs:
            if output.name in known:
                groups.replace(tree, output, known[output.name])
            is_lacking |= bool(output.links)
    return is_lacking


def _of_attribute(mesh, name):
    """Returns the U and V of an attribute at each corner; None without one of vectors, such as geometry nodes store."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.data_type not in ('FLOAT_VECTOR', 'FLOAT2') or attribute.domain not in ('POINT', 'CORNER'):
        return None
    width = 3 if attribute.data_type == 'FLOAT_VECTOR' else 2
    values = np.empty(width * len(attribute.data), np.float32)
    attribute.data.foreach_get("vector", values)
    values = values.reshape(-1, width)[:, :2]
    if attribute.domain == 'CORNER':
        return values
    vertices = np.empty(len(mesh.loops), int)
    mesh.loops.foreach_get("vertex_index", vertices)
    return values[vertices]
