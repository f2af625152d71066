"""Makes nodes in another Blender from the result of nodes.described()."""
import bpy
from mathutils import Matrix

_OF_THE_TREE = {"rna_type", "type", "inputs", "outputs", "internal_links", "dimensions", "bl_idname", "bl_label", "bl_description",
                "bl_icon", "bl_static_type", "bl_width_default", "bl_width_min", "bl_width_max", "bl_height_default",
                "bl_height_min", "bl_height_max", "parent", "location", "select", "name", "mute"}


def built(tree, described):
    """Adds the nodes to a tree. Returns the output that was described."""
    made = []
    for item in described["nodes"]:
        if "make" in item:
            node = tree.nodes.new(item["make"])
        else:
            node = _copy(_found(item["copy"]), tree)
        for name, value in item["set"].items():
            setattr(node, name, value)
        if rows := item.get("object"):  # which the session may have moved
            node.object = bpy.data.objects.new("lull place", None)
            node.object.matrix_world = Matrix(rows)
        for socket, value in zip(node.inputs, item["inputs"]):
            if "from" in value:
                tree.links.new(_output(made, *value["from"]), socket)
            elif value["value"] is not None and hasattr(socket, "default_value"):
                try:
                    socket.default_value = value["value"]
                except (TypeError, ValueError, AttributeError):
                    pass
        made.append((node, _told_of_alpha(tree, node) if item.get("alpha") else {}))
    return _output(made, described["node"], described["output"])


def _output(made, number, index):
    node, others = made[number]
    return others.get(index) or node.outputs[index]


def _found(path):
    """Returns a node by the kind and the name of its data-block, and the names of groups."""
    kind, block, *groups, name = path
    owner = next(b for b in getattr(bpy.data, kind) if b.name_full == block)
    tree = owner.node_tree
    for group in groups:
        tree = tree.nodes[group].node_tree
    return tree.nodes[name]


def _told_of_alpha(tree, node):
    """Lets Cycles divide the colour of an image by its alpha, as it does where nodes ask for both. Returns the colour by its index."""
    little, both = tree.nodes.new('ShaderNodeMath'), tree.nodes.new('ShaderNodeVectorMath')
    little.operation, little.inputs[1].default_value = 'MULTIPLY', 1e-20
    tree.links.new(node.outputs['Alpha'], little.inputs[0])
    tree.links.new(node.outputs['Color'], both.inputs[0])
    tree.links.new(little.outputs[0], both.inputs[1])
    return {0: both.outputs[0]}


def _copy(node, tree):
    made = tree.nodes.new(node.bl_idname)
    for p in node.bl_rna.properties:
        if p.identifier in _OF_THE_TREE:
            continue
        if p.is_readonly:
            _copy_parts(getattr(node, p.identifier), getattr(made, p.identifier))
            continue
        try:
            setattr(made, p.identifier, getattr(node, p.identifier))
        except (AttributeError, TypeError):
            pass
    for mine, other in zip(made.outputs, node.outputs):
        if hasattr(other, "default_value"):  # of values and colours, which have it there
            mine.default_value = other.default_value
    return made


def _copy_parts(old, new):
    """Copies ramps and curves, which are part of a node."""
    kind = type(old).__name__
    if kind == 'ColorRamp':
        for name in "color_mode", "interpolation", "hue_interpolation":
            setattr(new, name, getattr(old, name))
        while len(new.elements) < len(old.elements):
            new.elements.new(0.5)
        for mine, other in zip(new.elements, old.elements):
            mine.position, mine.color = other.position, other.color
    elif kind == 'CurveMapping':
        for mine, other in zip(new.curves, old.curves):
            while len(mine.points) < len(other.points):
                mine.points.new(0.5, 0.5)
            for a, b in zip(mine.points, other.points):
                a.location, a.handle_type = b.location, b.handle_type
        new.update()
    elif kind in ('TexMapping', 'ColorMapping', 'ImageUser'):
        for p in old.bl_rna.properties:
            if not p.is_readonly:
                try:
                    setattr(new, p.identifier, getattr(old, p.identifier))
                except (AttributeError, TypeError):
                    pass
