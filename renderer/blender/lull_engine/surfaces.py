"""Converts materials to nodes that Blender's exporter supports."""
import bpy

# Nodes through which the exporter finds a Principled BSDF.
_KNOWN = {'OUTPUT_MATERIAL', 'BSDF_PRINCIPLED', 'EMISSION', 'TEX_IMAGE', 'MAPPING', 'UVMAP', 'NORMAL_MAP',
          'SEPRGB', 'SEPARATE_COLOR', 'COMBRGB', 'COMBINE_COLOR', 'VERTEX_COLOR', 'RGB', 'VALUE',
          'REROUTE', 'TEX_COORD', 'ATTRIBUTE'}
# With a plain value or a texture glTF knows; with others it does not.
_UNSAID = ('Subsurface', 'Subsurface Weight', 'Anisotropic', 'Sheen', 'Sheen Weight', 'Specular Tint',
           'Transmission Roughness', 'Coat Normal', 'Thin Film Thickness')


def prepare(objects, warn):
    """Rewrites materials for the exporter, with a warning for each unsupported node."""
    _fill_slots(objects)
    materials = {slot.material for o in objects for slot in o.material_slots if slot.material}
    for material in sorted(materials, key=lambda m: m.name):
        if not material.use_nodes:
            continue
        output = material.node_tree.get_output_node('CYCLES')
        if output is None:
            continue
        _rewrite(material.node_tree, output)
        _warn_of(material, output, warn)
        # The exporter asks the blend mode of EEVEE, Cycles does not.
        if hasattr(material, "blend_method"):
            material.blend_method = 'BLEND' if _has_alpha(output) else 'OPAQUE'
        # The exporter takes the first output that it finds.
        for node in list(material.node_tree.nodes):
            if node.type == 'OUTPUT_MATERIAL' and node != output:
                material.node_tree.nodes.remove(node)


def _plain():
    """Returns Blender's default material; that of glTF is a metal."""
    material = bpy.data.materials.new("plain")
    material.use_nodes = True
    tree = material.node_tree
    output = tree.get_output_node('CYCLES')
    tree.links.new(tree.nodes.new('ShaderNodeBsdfDiffuse').outputs[0], output.inputs['Surface'])
    return material


def _fill_slots(objects):
    plain = None
    for o in objects:
        if not hasattr(o.data, "materials"):
            continue
        empty = [slot for slot in o.material_slots if not slot.material]
        if o.material_slots and not empty:
            continue
        plain = plain or _plain()
        if not o.material_slots:
            o.data.materials.append(plain)
        for slot in empty:
            slot.material = plain


def _source(socket):
    while socket.links:
        node = socket.links[0].from_node
        if node.type != 'REROUTE':
            return node
        socket = node.inputs[0]
    return None


def _rewrite(tree, output):
    """Puts a Principled BSDF in place of a surface of one simpler node."""
    old = _source(output.inputs['Surface'])
    made = {'BSDF_DIFFUSE': {'Roughness': 1.0, 'Specular': 0.0, 'Specular IOR Level': 0.0},
            'BSDF_GLOSSY': {'Metallic': 1.0},
            'BSDF_GLASS': {'Transmission': 1.0, 'Transmission Weight': 1.0}}.get(old and old.type)
    if made is None:
        return
    new = tree.nodes.new('ShaderNodeBsdfPrincipled')
    taken = {'Color': 'Base Color', 'IOR': 'IOR', 'Normal': 'Normal'}
    if old.type != 'BSDF_DIFFUSE':
        taken['Roughness'] = 'Roughness'
    for name, value in made.items():
        if name in new.inputs:
            new.inputs[name].default_value = value
    for name, target in taken.items():
        if name not in old.inputs:
            continue
        for link in old.inputs[name].links:
            tree.links.new(link.from_socket, new.inputs[target])
        if name != 'Normal':
            new.inputs[target].default_value = old.inputs[name].default_value
    if getattr(old, "distribution", '') == 'SHARP':
        new.inputs['Roughness'].default_value = 0
    tree.links.new(new.outputs[0], output.inputs['Surface'])


def _upstream(node):
    """Returns a node and all that it depends on."""
    found, todo = [], [node]
    while todo:
        node = todo.pop()
        if node not in found:
            found.append(node)
            todo += [link.from_node for socket in node.inputs for link in socket.links]
    return found


def _has_alpha(output):
    for node in _upstream(output):
        alpha = node.inputs.get('Alpha') if node.type == 'BSDF_PRINCIPLED' else None
        if node.type == 'BSDF_TRANSPARENT' or (alpha and (alpha.links or alpha.default_value < 1)):
            return True
    return False


def _warn_of(material, output, warn):
    for socket in 'Volume', 'Displacement':
        if output.inputs[socket].links:
            warn(f"material '{material.name}': its {socket.lower()} is left out")
            for link in list(output.inputs[socket].links):
                material.node_tree.links.remove(link)
    nodes = _upstream(output)
    transparent = any(n.type == 'BSDF_TRANSPARENT' for n in nodes)
    for node in nodes:
        # A mix with a transparent surface is how the exporter knows alpha, a product with vertex
        # colours is how it knows factors.
        if node.type in ('MIX_SHADER', 'BSDF_TRANSPARENT') and transparent:
            continue
        if node.type in ('MIX', 'MIX_RGB') and getattr(node, "blend_type", '') == 'MULTIPLY':
            continue
        if node.type == 'GROUP' and node.node_tree and node.node_tree.name.startswith('glTF'):
            continue
        if node.type == 'BSDF_PRINCIPLED':
            _warn_of_inputs(material, node, warn)
        elif node.type not in _KNOWN:
            warn(f"material '{material.name}': glTF cannot express its node '{node.name}'")
        if node.type == 'TEX_IMAGE' and node.projection != 'FLAT':
            warn(f"material '{material.name}': its image '{node.name}' is mapped by UVs")


def _warn_of_inputs(material, node, warn):
    for name in _UNSAID:
        socket = node.inputs.get(name)
        if socket is None or socket.type != 'VALUE':
            continue
        if socket.links or socket.default_value > 0:
            warn(f"material '{material.name}': glTF leaves out its {name.lower()}")
